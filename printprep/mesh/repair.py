"""From triangles to a solid: a ladder that stops at the first rung that holds.

Rungs, gentlest first: the mesh as it is; its shells turned and united (no vertex moves); MeshLab's
filters; a new surface by winding number.  A rung holds when it yields a manifold without error, of
positive volume, that encloses what the model encloses (reference.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.mesh.measure import distance_mm
from printprep.mesh.meshlab import mended
from printprep.mesh.orient import right_side_out
from printprep.mesh.reference import Reference
from printprep.mesh.remesh import remeshed
from printprep.mesh.shells import Candidate, Refusal, united
from printprep.mesh.winding_columns import winding_at
from printprep.types import Model, Repair, Rung, Solid

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

_SAMPLES = 10_000
_SEED = 20140801
_FLAT = 1e-9  # smallest extent over largest below which a model is a sheet of paper


def repair(model: Model) -> Solid:
    """The solid a model means, on the bed, with what it took.

    Raises
    ------
    GeometryError : the model is flat, encloses nothing, is more hole than surface, or no rung
        gives a solid that agrees with it.
    """
    _refuse_flat(model)
    faces, turned = right_side_out(model.vertices, model.faces)
    reference = Reference.of(model.vertices, faces)
    _refuse_empty(model, reference)
    skipped: list[str] = []
    reasons: list[str] = []
    for rung, offer in _ladder(model.vertices, faces):
        if isinstance(offer, Refusal):
            reasons.append(f"{rung}: {offer.reason}")
            if offer.skipped:
                skipped.append(f"Skipped a step: {offer.reason}.")
            continue
        fault = _fault(offer, reference)
        if fault is None:
            return _solid(model, faces, rung, offer, (*turned, *skipped))
        reasons.append(f"{rung}: {fault}")
    raise GeometryError(
        f"{model.name} cannot be made a solid ({'; '.join(reasons)}).",
        "Repair it in a modelling program: close its holes and make its walls thick.",
    )


def _ladder(vertices: Float, faces: Int) -> Iterator[tuple[Rung, Candidate | Refusal]]:
    yield "union", united(vertices, faces)
    for offer in mended(vertices, faces):
        yield "meshlab", offer
    yield "remesh", remeshed(vertices, faces)


def _fault(offer: Candidate, reference: Reference) -> str | None:
    if not offer.manifold.volume() > 0:
        return "its volume is not positive"
    return reference.disagreement(offer.manifold, offer.slack_mm3)


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
            "Give them a thickness in a modelling program (solidify).",
        )
    if reference.undecided_mm3 > reference.volume_mm3:
        raise GeometryError(
            f"{model.name} is an open sheet, not the surface of a solid: "
            f"{reference.undecided_mm3:.4g} mm³ are neither clearly inside nor outside, "
            f"{reference.volume_mm3:.4g} mm³ are inside.",
            "Close its holes, or give the sheet a thickness, in a modelling program.",
        )


def _solid(
    model: Model, faces: Int, rung: Rung, offer: Candidate, before: tuple[str, ...]
) -> Solid:
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


def _seated(manifold: Manifold, placement: Float) -> tuple[Manifold, Float]:
    """Back on the bed, when what was left out or made anew moved the lowest point."""
    lowest = float(manifold.bounding_box()[2])
    if lowest == 0:
        return manifold, placement
    step = np.eye(4)
    step[2, 3] = -lowest
    return manifold.translate((0.0, 0.0, -lowest)), step @ placement


def _moved(vertices: Float, faces: Int, manifold: Manifold) -> Float:
    """Distances in mm from points on the model's surface to the solid's, never empty.

    Points are drawn evenly by area, always the same ones.  Only those where the surface parts
    inside from outside count: what another shell swallows has not moved.
    """
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    rng = np.random.default_rng(_SEED)
    cumulative = np.cumsum(doubled)
    index = np.searchsorted(cumulative, rng.random(_SAMPLES) * cumulative[-1], side="right")
    index = np.minimum(index, len(faces) - 1)
    u, v = np.sqrt(rng.random(_SAMPLES)), rng.random(_SAMPLES)
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points = np.einsum("nk,nkj->nj", weights, corners[index])
    step = 1e-4 * float(np.ptp(vertices, axis=0).max())
    outward = step * normals[index] / np.maximum(doubled[index], 1e-300)[:, None]
    bounds = (winding_at(points - outward, vertices, faces) > 0.5) & (
        winding_at(points + outward, vertices, faces) <= 0.5
    )
    return distance_mm(points[bounds] if bounds.any() else points, manifold)
