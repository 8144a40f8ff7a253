"""A part's file as PrusaSlicer reads it.

PrusaSlicer takes the components of a file for OrcaSlicer for objects of their own, and would print
a support blocker.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.threemf.item import Item
    from printprep.verify.part_3mf import ComputedPart


def file_for_prusa(part: ComputedPart, folder: Path) -> Path:
    """The part's own file, or for one in OrcaSlicer's layout a copy of it in ``folder``.

    Raises InputError if the file is broken, or another program has written it anew.
    """
    from printprep.threemf.orca_read import read_orca
    from printprep.threemf.write import write_3mf

    items = read_orca(part.file)
    if items is None:
        return part.file
    copy = folder / "part.3mf"
    copy.write_bytes(write_3mf([_with_settings(item, part) for item in items]))
    return copy


def _with_settings(item: Item, part: ComputedPart) -> Item:
    from printprep.output.prusa_keys import DENSE, object_keys

    if not any(volume.kind == "ParameterModifier" for volume in item.volumes):
        return replace(item, settings=part.profile.object_settings)
    volumes = [
        replace(volume, settings=DENSE) if volume.kind == "ParameterModifier" else volume
        for volume in item.volumes
    ]
    return replace(item, volumes=volumes, settings=object_keys(part.profile))
