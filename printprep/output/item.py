"""The part as an item of a 3MF: a solid mesh, and with infill a modifier for the ballast."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.quantize import quantized, quantized_arrays
from printprep.output.prusa_keys import DENSE, object_keys
from printprep.threemf.write import Item, Volume
from printprep.types import Paint

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.mesh.carry import Carried
    from printprep.profiles import Profile


def solid_item(
    part: Manifold,
    name: str,
    profile: Profile,
    at_mm: tuple[float, float] | None = None,
    *,
    blocker: Manifold | None = None,
    paint: Carried | None = None,
) -> Item:
    """A part that prints exactly as its mesh, cavities as inverted shells.

    part : quantized;  at_mm : place (x, y) of its origin, None for the middle of the bed.
    blocker : where the slicer makes no supports;  paint : of the part's ``quantized_arrays``.
    """
    vertices, faces = quantized_arrays(part)
    volumes = [_painted(Volume(name, vertices, faces), paint)]
    if blocker is not None and not blocker.is_empty():
        arrays = quantized_arrays(quantized(blocker))
        volumes.append(Volume("support blocker", *arrays, "SupportBlocker"))
    x, y = middle_of_bed(profile) if at_mm is None else at_mm
    return Item(
        name=name,
        volumes=volumes,
        settings=profile.object_settings,
        translation_mm=(x, y, 0.0 - float(vertices[:, 2].min())),
    )


def infill_item(
    part: Manifold,
    ballast: Sequence[Manifold],
    name: str,
    profile: Profile,
    paint: Carried | None = None,
) -> Item:
    """A part with the slicer's infill inside, in the middle of the bed.

    part : quantized;  ballast : solids, which may reach out of the part and may overlap;
    paint : of the part's ``quantized_arrays``.
    """
    vertices, faces = quantized_arrays(part)
    volumes = [_painted(Volume(name, vertices, faces), paint)]
    for number, solid in enumerate(ballast, 1):
        title = "ballast" if len(ballast) == 1 else f"ballast {number}"
        arrays = quantized_arrays(quantized(solid))
        volumes.append(Volume(title, *arrays, "ParameterModifier", DENSE))
    x, y = middle_of_bed(profile)
    return Item(
        name=name,
        volumes=volumes,
        settings=object_keys(profile),
        translation_mm=(x, y, 0.0 - float(vertices[:, 2].min())),
    )


def _painted(volume: Volume, paint: Carried | None) -> Volume:
    """A volume with its paint, each face turned to the corner that the code of its paint means."""
    if paint is None:
        return volume
    turned = (np.arange(3) + paint.turns[:, None]) % 3
    faces = np.take_along_axis(volume.faces, turned, axis=1)
    return replace(volume, faces=faces, paint=Paint(paint.styles, paint.labels))


def middle_of_bed(profile: Profile) -> tuple[float, float]:
    """The middle of the bed, (x, y) in mm."""
    width, depth, _ = profile.printer.bed_mm
    return width / 2, depth / 2
