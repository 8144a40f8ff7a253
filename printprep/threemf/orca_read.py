"""Reads a file in the layout of OrcaSlicer and BambuStudio back as the items it was written from.

Unlike :func:`printprep.threemf.read.read_3mf` it keeps the volumes apart, modifiers too.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.threemf.archive import Archive
from printprep.threemf.item import Item, Volume
from printprep.threemf.package import MODEL_PART, ORCA_CONFIG_PART
from printprep.threemf.parse import ParsedModel, parse_model
from printprep.threemf.project import Purpose, read_project

if TYPE_CHECKING:
    from printprep.threemf.item import VolumeKind
    from printprep.threemf.parse import ObjectReference
    from printprep.threemf.project import VolumeRole

_KINDS: Mapping[Purpose, VolumeKind] = {
    "part": "ModelPart",
    "negative": "NegativeVolume",
    "modifier": "ParameterModifier",
    "blocker": "SupportBlocker",
    "enforcer": "SupportEnforcer",
}
_ONLY_OURS = "Make the part with `printprep hollow MODEL -o PART.3mf --for orca`."


def read_orca(path: Path) -> list[Item] | None:
    """The items of a file that :mod:`printprep.threemf.orca` wrote, without settings and paint.

    None for a file without that layout's config.
    Raises InputError where the file is broken, or another program has written it anew.
    """
    with Archive(path) as archive:
        if ORCA_CONFIG_PART not in archive:
            return None
        project = read_project(archive)
        with archive.open(MODEL_PART) as stream:
            model = parse_model(stream, archive.name)
    items = []
    for placed in model.items:
        held = model.objects.get(placed.object_id)
        if held is None or not held.components or (placed.transform != _IDENTITY).any():
            raise _changed(path)
        first = held.components[0].transform
        volumes = []
        for component in held.components:
            role = project.components.get((placed.object_id, component.object_id))
            if role is None or (component.transform != first).any():
                raise _changed(path)
            volumes.append(_volume(path, model, component, role))
        x, y, z = first[3].tolist()
        items.append(Item(held.name, volumes, translation_mm=(x, y, z)))
    return items


_IDENTITY = np.vstack([np.eye(3), np.zeros(3)])


def _volume(path: Path, model: ParsedModel, component: ObjectReference, role: VolumeRole) -> Volume:
    found = model.objects.get(component.object_id)
    moved = component.part is not None or (component.transform[:3] != np.eye(3)).any()
    if found is None or moved or not found.indices:
        raise _changed(path)
    vertices = np.array(found.coordinates, dtype=np.float64).reshape(-1, 3)
    faces = np.array(found.indices, dtype=np.int64).reshape(-1, 3)
    return Volume(role.name or found.name, vertices, faces, _KINDS[role.purpose])


def _changed(path: Path) -> InputError:
    return InputError(f"{path.name} is not laid out as printprep wrote it.", _ONLY_OURS)
