"""Repairs triangles into a solid: a ladder of methods that stops at the first one that works.

Cracks are sewn first.  Rungs, gentlest first: the mesh as it is; its shells turned and united (no
vertex moves); MeshLab's filters; a new surface by winding number.  A rung works where it gives a
manifold without error, of positive volume, that encloses the same space as the model
(reference.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.mesh.measure import distance_mm
from printprep.mesh.meshlab import mended
from printprep.mesh.orient import right_side_out
from printprep.mesh.reference import Reference
from printprep.mesh.remesh import remeshed
from printprep.mesh.sample import points_on_surface
from printprep.mesh.sew import sewn
from printprep.mesh.shell_figures import closed_shells, shell_figures
from printprep.mesh.shells import DUST_MM3, Candidate, Refusal, united
from printprep.mesh.weld import compact
from printprep.mesh.winding_columns import winding_at
from printprep.types import Model, Repair, Rung, Solid
from printprep.wording import counted

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

_SAMPLES = 10_000
_SEED = 20140801
# Shells are compared in pairs.
MOST_SHELLS = 5000
_FLAT = 1e-9  # smallest extent over largest, below which a model is flat


def repair(model: Model, crumb_mm3: float = DUST_MM3) -> Solid:
    """The solid that a model describes, on the bed, with a record of the repair.

    crumb_mm3 : bodies and voids of less volume are left out, unless the whole model is that small.

    Raises
    ------
    GeometryError : the model is flat, encloses no volume, is mostly open, or no rung gives a solid
        that agrees with it.
    """
    _refuse_flat(model)
    seams = sewn(model)
    model = seams.model
    model, crumbs = without_crumb_shells(model, crumb_mm3)
    faces, turned = right_side_out(model.vertices, model.faces)
    reference = Reference.of(model.vertices, faces)
    _refuse_empty(model, reference)
    skipped: list[str] = []
    reasons: list[str] = []
    for rung, offer in _ladder(model.vertices, faces, crumb_mm3):
        if isinstance(offer, Refusal):
            reasons.append(f"{rung}: {offer.reason}")
            if offer.skipped:
                skipped.append(f"Skipped a step: {offer.reason}.")
            continue
        fault = _fault(offer, reference)
        if fault is None:
            before = (*seams.actions, *crumbs, *turned, *skipped)
            solid = _solid(model, faces, rung, offer, before)
            return replace(solid, repair=_moved_more(solid.repair, seams.moved_mm))
        reasons.append(f"{rung}: {fault}")
    raise GeometryError(
        f"{model.name} cannot be made a solid ({'; '.join(reasons)}).",
        "Repair it in a modelling program: close its holes and give its walls a thickness.",
    )


def _ladder(
    vertices: Float, faces: Int, crumb_mm3: float
) -> Iterator[tuple[Rung, Candidate | Refusal]]:
    """What each rung gives, gentlest first; vertices : (n, 3) mm, faces : (m, 3)."""
    yield "union", united(vertices, faces, crumb_mm3)
    for offer in mended(vertices, faces, crumb_mm3):
        yield "meshlab", offer
    yield "remesh", remeshed(vertices, faces)


def _fault(offer: Candidate, reference: Reference) -> str | None:
    """Why a rung's solid is refused, or None where it is good."""
    if not offer.manifold.volume() > 0:
        return "its volume is not positive"
    return reference.disagreement(offer.manifold, offer.slack_mm3)


def without_crumb_shells(
    model: Model, crumb_mm3: float, most_shells: float = MOST_SHELLS
) -> tuple[Model, tuple[str, ...]]:
    """The model without closed shells that are too small to print, and a sentence on them.

    most_shells : infinite for a model whose cracks are not sewn yet.

    Raises GeometryError where nothing else is left, or more shells than can be sorted.
    """
    figures = shell_figures(model.vertices, model.faces)
    closed = closed_shells(model.faces, figures)
    crumbs = closed & figures.crumbs(crumb_mm3)
    count = len(crumbs) - int(crumbs.sum())
    if not count:
        raise GeometryError(
            f"{model.name} consists of {len(crumbs)} bodies, each of less than {crumb_mm3:.3g} "
            "mm³: none of them prints.",
            "Unite them in the program that made the model, or scale it up (--size).",
        )
    if count > most_shells:
        raise GeometryError(
            f"{model.name} consists of {count} separate pieces of surface; {most_shells:g} is "
            "the most that is repaired.",
            "Unite them in the program that made the model.",
        )
    if not crumbs.any():
        return model, ()
    stays = ~crumbs[figures.label]
    vertices, faces = compact(model.vertices, model.faces[stays])
    paint = model.paint
    if paint is not None:
        paint = replace(paint, labels=paint.labels[stays])
    sentence = f"Left out {counted(int(crumbs.sum()), 'shell')} too small to print."
    return replace(model, vertices=vertices, faces=faces, paint=paint), (sentence,)


def _refuse_flat(model: Model) -> None:
    extents = model.vertices.max(axis=0) - model.vertices.min(axis=0)
    if extents.min() <= _FLAT * extents.max():
        axis = "xyz"[int(extents.argmin())]
        raise GeometryError(
            f"{model.name} is flat: it has no extent along {axis}.",
            "Give it a thickness in a modelling program (extrude or solidify).",
        )


def _refuse_empty(model: Model, reference: Reference) -> None:
    if reference.volume_mm3 <= 0:
        raise GeometryError(
            f"{model.name} encloses no volume: its surfaces have no inside.",
            "Give the surfaces a thickness in a modelling program (solidify).",
        )
    if reference.undecided_mm3 > reference.volume_mm3:
        raise GeometryError(
            f"{model.name} is an open sheet, not the surface of a solid: "
            f"{reference.undecided_mm3:.4g} mm³ are neither clearly inside nor clearly outside, "
            f"only {reference.volume_mm3:.4g} mm³ are inside.",
            "Close its holes, or give the sheet a thickness, in a modelling program.",
        )


def _solid(
    model: Model, faces: Int, rung: Rung, offer: Candidate, before: tuple[str, ...]
) -> Solid:
    """A rung's solid on the bed; faces : (m, 3) turned;  before : actions before that rung."""
    actions = (*before, *offer.actions)
    if rung == "union" and not actions:
        rung = "as-is"
    moved = _moved(model.vertices, faces, offer.manifold) if actions else np.zeros(1)
    manifold, placement = _seated(offer.manifold, model.placement)
    return Solid(
        manifold=manifold,
        name=model.name,
        repair=Repair(
            rung=rung,
            actions=actions,
            moved_max_mm=float(moved.max()),
            moved_mean_mm=float(moved.mean()),
            resolution_mm=offer.resolution_mm,
        ),
        placement=placement,
    )


def _moved_more(repair: Repair, before_mm: float) -> Repair:
    """A repair after a step that moved the surface by up to ``before_mm``."""
    return replace(repair, moved_max_mm=repair.moved_max_mm + before_mm)


def _seated(manifold: Manifold, placement: Float) -> tuple[Manifold, Float]:
    """The solid on the bed, where the repair changed the lowest point, and its (4, 4) placement."""
    lowest = float(manifold.bounding_box()[2])
    if lowest == 0:
        return manifold, placement
    step = np.eye(4)
    step[2, 3] = -lowest
    return manifold.translate((0.0, 0.0, -lowest)), step @ placement


def _moved(vertices: Float, faces: Int, manifold: Manifold) -> Float:
    """(k,) mm, distances from points on the model's surface to the solid's, k ≥ 1.

    vertices : (n, 3) mm;  faces : (m, 3).  Points lie evenly over the area, always the same ones.
    Only those that have inside on one side and outside on the other count: a shell inside another
    one disappears in the union, but nothing moves.
    """
    rng = np.random.default_rng(_SEED)
    found = points_on_surface(vertices, faces, rng.random(_SAMPLES), rng)
    points, normals = found.points, found.area_normals
    step = 1e-4 * float(np.ptp(vertices, axis=0).max())
    outward = step * normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    bounds = (winding_at(points - outward, vertices, faces) > 0.5) & (
        winding_at(points + outward, vertices, faces) <= 0.5
    )
    return distance_mm(points[bounds] if bounds.any() else points, manifold)
