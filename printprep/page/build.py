"""The pages: of a part just hollowed, of a written part, and of a file as it came."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.files import reason_of
from printprep.mesh.measure import from_arrays, volume_and_centre
from printprep.page import facts
from printprep.page.content import Curve, Form, Group, Page, PoseRow, Source
from printprep.page.encode import encode
from printprep.page.meshes import Meshes, meshes_of
from printprep.page.shape import shape_of_checked, shape_of_part, shape_of_result
from printprep.page.view import view_of
from printprep.page.words import tilt
from printprep.stand.contact import contact_of, section_at_bed
from printprep.stand.stability import balanced, stability

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.output.figures import Figures
    from printprep.page.shape import Shape
    from printprep.pipeline.check import Checked
    from printprep.pipeline.explore import Point
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.stand.poses import Pose
    from printprep.types import Finding, Lean, Stability
    from printprep.verify.run import Verified

_STILL_PIXELS = 420


def source_of(path: Path, command: str | None = None) -> Source:
    """The file that a page is about.  Raises InputError where it cannot be read."""
    if not path.is_file():
        raise InputError(f"{path} does not exist.", "Check the name and the folder.")
    try:
        return Source(path.name, hashlib.sha256(path.read_bytes()).hexdigest(), command)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {reason_of(error)}.") from error


@dataclass(frozen=True, eq=False)
class Picture:
    """A shape ready for a page: its meshes for a browser, and a still picture of it."""

    shape: Shape
    meshes: Meshes
    still: str

    @classmethod
    def of(cls, shape: Shape, wall_mm: float) -> Picture:
        from printprep.render.thumbnail import thumbnail_png

        meshes = meshes_of(shape, wall_mm)
        part = meshes.meshes[0]
        png = thumbnail_png(part.vertices, part.faces, _STILL_PIXELS)
        return cls(shape, meshes, base64.b64encode(png).decode("ascii"))


def page_of_result(
    result: HollowResult,
    findings: Sequence[Finding],
    source: Source,
    *,
    verified: Verified | None = None,
    form: Form | None = None,
) -> Page:
    """The page of a part that was just hollowed.

    findings : those of the part and of its print.
    """
    from printprep.pipeline.curve import mass_over_lean

    figures = result.figures()
    curve = None
    if result.workings is not None:
        points = mass_over_lean(result.workings.program, result.part.base, result.lean.azimuth_deg)
        note = "on this base" if result.part.base is not None else "without a base"
        curve = facts.curve(
            points,
            result.lean,
            (result.tilt_deg, result.mass_g),
            (result.tilt_solid_deg, result.solid_mass_g),
            f"The least mass at every lean, {note}.",
        )
    return _page_of_hollowed(
        figures,
        result.profile,
        Picture.of(shape_of_result(result), result.profile.wall_mm),
        source,
        findings=findings,
        lean=result.lean,
        stability=result.stability,
        centre_before_mm=result.stability_solid.centre_of_mass_mm,
        groups=facts.groups(figures, result.profile, result.simulation),
        verified=verified,
        curve=curve,
        form=form,
    )


def page_of_part(path: Path, source: Source, verified: Verified | None = None) -> Page:
    """The page of a 3MF that printprep wrote, from its mesh and its figures.

    Raises InputError if printprep did not write it, or if it is broken.
    """
    from printprep.check import sorted_findings
    from printprep.mesh.weld import weld
    from printprep.threemf.read import read_3mf
    from printprep.types import Lean
    from printprep.verify.part_3mf import figures_of

    content = read_3mf(path)
    figures, profile = figures_of(path, content.attachments)
    vertices, faces = weld(content.vertices, content.faces)
    if not len(faces):
        raise InputError(f"{path.name} has no triangles.")
    part = from_arrays(vertices + np.array(figures.bounds_mm[0]) - vertices.min(axis=0), faces)
    picture = Picture.of(shape_of_part(part, figures, profile), profile.wall_mm)
    extra = () if verified is None else verified.findings
    return _page_of_hollowed(
        figures,
        profile,
        picture,
        source,
        findings=sorted_findings([*figures.findings, *extra]),
        lean=Lean(figures.lean_deg, figures.lean_azimuth_deg),
        stability=_stability(
            part,
            figures.centre_of_mass_mm,
            profile.printer.first_layer_mm,
            infilled=figures.infill is not None,
        ),
        centre_before_mm=volume_and_centre(picture.shape.outside)[1],
        groups=facts.groups(figures, profile),
        verified=verified,
        curve=None,
        form=None,
    )


def _page_of_hollowed(
    figures: Figures,
    profile: Profile,
    picture: Picture,
    source: Source,
    *,
    findings: Sequence[Finding],
    lean: Lean,
    stability: Stability,
    centre_before_mm: tuple[float, float, float],
    groups: tuple[Group, ...],
    verified: Verified | None,
    curve: Curve | None,
    form: Form | None,
) -> Page:
    """The page of a hollowed part, from its figures and its picture.

    centre_before_mm : centre of mass (x, y, z) of the solid;  groups : of figures, without those of
    the print.
    """
    encoded = encode(picture.meshes.meshes)
    tone, words, lead = facts.verdict(findings, figures.tilt_deg, str(lean), lean.angle_deg)
    return Page(
        name=figures.model,
        kicker=f"Hollowed for {profile.material.name}, {profile.name}",
        tone=tone,
        verdict=words,
        lead=lead,
        cards=facts.cards(figures, profile),
        groups=_with_print(groups, verified),
        findings=facts.finding_rows(findings),
        poses=(),
        curve=curve,
        origin=facts.origin(source, profile, picture.meshes),
        geometry=encoded.base64,
        still=picture.still,
        view=view_of(
            picture.shape,
            encoded,
            wall_mm=profile.wall_mm,
            stability=stability,
            centre_mm=figures.centre_of_mass_mm,
            centre_before_mm=centre_before_mm,
            lean=lean,
            findings=findings,
        ),
        form=form,
    )


def page_of_checked(
    found: Checked,
    source: Source,
    *,
    name: str,
    poses: Sequence[Pose],
    points: Sequence[Point],
    form: Form | None = None,
) -> Page:
    """The page of a file as it came: what `check` finds, its poses, and what leans would cost."""
    context, profile = found.context, found.profile
    picture = Picture.of(shape_of_checked(found), profile.wall_mm)
    encoded = encode(picture.meshes.meshes)
    lean, tilt_deg = context.lean, context.stability.tilt_deg
    tone, words, lead = facts.verdict(found.findings, tilt_deg, str(lean), lean.angle_deg)
    curve: Curve | None = facts.curve(
        points,
        lean,
        None,
        (tilt_deg, found.mass_g),
        "The least mass that hollowing reaches at every lean.",
    )
    rows = tuple(
        PoseRow(number, tilt(pose.tilt_deg), pose.tilt_deg >= lean.angle_deg)
        for number, pose in enumerate(poses, 1)
    )
    centre = volume_and_centre(context.part)[1]
    return Page(
        name=name,
        kicker=f"As it is, checked for {profile.material.name}, {profile.name}",
        tone=tone,
        verdict=words,
        lead=lead,
        cards=facts.check_cards(found),
        groups=facts.check_groups(found),
        findings=facts.finding_rows(found.findings),
        poses=rows,
        curve=curve,
        origin=facts.origin(source, profile, picture.meshes),
        geometry=encoded.base64,
        still=picture.still,
        view=view_of(
            picture.shape,
            encoded,
            wall_mm=profile.wall_mm,
            stability=context.stability,
            centre_mm=centre,
            centre_before_mm=None,
            lean=lean,
            findings=found.findings,
            poses=poses,
        ),
        form=form,
    )


def _with_print(groups: tuple[Group, ...], verified: Verified | None) -> tuple[Group, ...]:
    return groups if verified is None else (*groups, facts.printed_group(verified))


def _stability(
    part: Manifold, centre_mm: tuple[float, float, float], first_layer_mm: float, *, infilled: bool
) -> Stability:
    """How a written part stands; a print with infill has another centre of mass than its mesh."""
    if infilled:
        return balanced(contact_of(section_at_bed(part, first_layer_mm)), centre_mm)
    return stability(part, first_layer_mm)
