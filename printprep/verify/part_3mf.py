"""Reads a part that printprep wrote as a 3MF: its mesh and the figures in the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.types import Lean

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.output.figures import Figures
    from printprep.profiles import Profile


_HOLLOW_IT = "Make the part with `printprep hollow MODEL -o PART.3mf`."


@dataclass(frozen=True, eq=False)
class ComputedPart:
    """A part that printprep wrote, read back with its figures, in the coordinates of the bed.

    From the figures in the file:
    mass_g, lean, profile, contact_area_mm2;  centre_mm : (3,) centre of mass;  tilt_deg : toward
    the lean's azimuth if it has one, None without contact;  contact_polygon_mm : (k, 2), empty
    without contact;  size_mm, middle_mm : (3,) of the bounding box;  placement : (4, 4), model's
    file → bed.

    From the mesh:
    sure_polygon_mm : (k, 2) hull of the contact where it is at least a line wide, which a slicer
    never leaves out; empty if no contact is that wide.
    cavities : sealed voids;  bodies : those that do not touch each other.
    """

    file: Path
    mass_g: float
    centre_mm: Float
    tilt_deg: float | None
    lean: Lean
    contact_polygon_mm: Float
    contact_area_mm2: float
    sure_polygon_mm: Float
    bodies: tuple[Manifold, ...]
    size_mm: Float
    middle_mm: Float
    placement: Float
    cavities: tuple[Manifold, ...]
    profile: Profile


def computed_part(path: str | Path) -> ComputedPart:
    """Read PART.3mf.  Raises InputError if printprep did not write it, or if it is broken."""
    from printprep.mesh.measure import bodies, shells, try_manifold
    from printprep.mesh.weld import weld
    from printprep.threemf.read import read_3mf

    path = Path(path)
    if path.is_file() and path.suffix.lower() != ".3mf":
        raise InputError(f"{path.name} is not a 3MF, so it carries no figures.", _HOLLOW_IT)
    content = read_3mf(path)
    figures, profile = _figures(path, content.attachments)
    manifold, status = try_manifold(*weld(content.vertices, content.faces))
    if manifold.is_empty():
        raise InputError(
            f"{path.name}: the mesh is not the solid that printprep wrote ({status}).", _HOLLOW_IT
        )
    low, high = np.array(figures.bounds_mm)
    shift = np.array([*manifold.bounding_box()[:3]]) - low
    contact = figures.contact
    polygon_mm = np.zeros((0, 2)) if contact is None else np.array(contact.polygon_mm)
    moved = np.eye(4)
    moved[:3, 3] = shift
    return ComputedPart(
        file=path,
        mass_g=figures.mass_g,
        centre_mm=np.array(figures.centre_of_mass_mm) + shift,
        tilt_deg=figures.tilt_deg,
        lean=Lean(figures.lean_deg, figures.lean_azimuth_deg),
        contact_polygon_mm=polygon_mm + shift[:2],
        contact_area_mm2=0.0 if contact is None else contact.area_mm2,
        sure_polygon_mm=_sure_polygon(manifold, profile),
        bodies=bodies(manifold),
        size_mm=high - low,
        middle_mm=(low + high) / 2 + shift,
        placement=moved @ np.array(figures.placement),
        cavities=shells(manifold)[1],
        profile=profile,
    )


def _figures(path: Path, attachments: Mapping[str, bytes]) -> tuple[Figures, Profile]:
    """The figures in a 3MF, and their profile."""
    from printprep.output.figures import Figures
    from printprep.profiles import Profile
    from printprep.threemf.read import ATTACHMENT

    if ATTACHMENT not in attachments:
        raise InputError(f"{path.name} carries no figures: it has no {ATTACHMENT}.", _HOLLOW_IT)
    try:
        figures = Figures.from_json(attachments[ATTACHMENT])
        profile = Profile.model_validate({**figures.settings, "name": figures.profile})
    except (ValueError, RecursionError) as error:  # pydantic's errors are among them
        first = str(error).splitlines()[0]
        raise InputError(
            f"{path.name}: this version of printprep cannot read its figures: {first}.", _HOLLOW_IT
        ) from error
    return figures, profile


def _sure_polygon(manifold: Manifold, profile: Profile) -> Float:
    """(k, 2) mm, the hull of the first layer's section after an opening by a line's width."""
    from manifold3d import JoinType

    from printprep.stand.contact import contact_of, section_at_bed

    bed_mm = manifold.bounding_box()[2]
    section = section_at_bed(manifold.translate((0, 0, -bed_mm)), profile.printer.first_layer_mm)
    half = (profile.printer.line_width_mm or 0.0) / 2
    opened = contact_of(section.offset(-half, JoinType.Round).offset(half, JoinType.Round))
    return np.zeros((0, 2)) if opened is None else opened.polygon_mm
