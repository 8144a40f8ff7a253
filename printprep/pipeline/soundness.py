"""Checks a part before it is handed on: its outside is the model's, and nothing in it is loose.

What fails here is a defect of printprep, not of the model.  It is better to write nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import PrintprepError
from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.measure import arrays, distance_to_mesh_mm
from printprep.mesh.quantize import quantized_arrays
from printprep.mesh.shell_figures import joined, shell_figures

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float
    from printprep.types import Drain, Part

# Points of the written mesh lie this close to the surfaces that they come from.
OFF_MM = 0.01
# Mean thickness, over the whole surface, of what the part may lack or have too much.
SKIN_MM = 2e-4
# Points that are measured, evenly spread over the list of vertices.
MOST_POINTS = 20_000
# Beyond this share of its diameter from its axis, a drain hole changes nothing.
BESIDE_DRAIN = 0.6
_HINT = "Nothing is written. A slightly different size (--size) may avoid it; please report it."


def check_sound(part: Part, drains: tuple[Drain, ...]) -> None:
    """Check that a part is its outside without its cavities, and no more, and in one piece.

    Raises
    ------
    PrintprepError : it is not (a defect of printprep).
    """
    _check_loose(part)
    _check_volume(part, drains)
    _check_surface(part, drains)


def _check_loose(part: Part) -> None:
    vertices, faces = quantized_arrays(part.manifold)
    figures = shell_figures(vertices, faces)
    solids = np.flatnonzero(figures.volume_mm3 > 0).tolist()
    if len(solids) <= 1:
        return
    outside = arrays(part.outside)
    for number in solids:
        points = vertices[np.unique(faces[figures.label == number])]
        if float(distance_to_mesh_mm(points, *outside).min()) > OFF_MM:
            x, y, z = (figures.low_mm[number] + figures.high_mm[number]).tolist()
            raise PrintprepError(
                f"{part.name}: a body of {figures.volume_mm3[number]:.3g} mm³ would lie loose in a "
                f"cavity, at ({x / 2:.1f}, {y / 2:.1f}, {z / 2:.1f}) mm.",
                _HINT,
            )


def _check_volume(part: Part, drains: tuple[Drain, ...]) -> None:
    void_mm3 = float(sum(cavity.volume() for cavity in part.cavities))
    expected = float(part.outside.volume()) - void_mm3
    slack = SKIN_MM * float(part.outside.surface_area() + part.manifold.surface_area())
    bores = sum(np.pi / 4 * d.diameter_mm**2 * (d.length_mm + 2 * d.diameter_mm) for d in drains)
    missing = expected - float(part.manifold.volume())
    if not -slack <= missing <= slack + float(bores):
        raise PrintprepError(
            f"{part.name}: the part differs by {missing:.3g} mm³ from its outside without its "
            "cavities.",
            _HINT,
        )


def _check_surface(part: Part, drains: tuple[Drain, ...]) -> None:
    # In the form in which the rules ask for them: their search trees are built once.
    outside, written = (tree_of(*quantized_arrays(each)) for each in (part.outside, part.manifold))
    points = _some(outside.vertices)
    _refuse_far(part, points, written.nearest(points)[0], drains, "does not reach")
    points = _some(written.vertices)
    off = outside.nearest(points)[0]
    if part.cavities:
        cavity = tree_of(*arrays(joined(part.cavities)))
        off = np.minimum(off, cavity.nearest(points)[0])
    _refuse_far(part, points, off, drains, "leaves")


def _refuse_far(
    part: Part, points: Float, off_mm: Float, drains: tuple[Drain, ...], verb: str
) -> None:
    """Refuse points (n, 3) mm that are ``off_mm`` (n,) from where they belong, beside drains."""
    off_mm = np.where(_beside_drains(points, drains), 0.0, off_mm)
    if not len(off_mm) or float(off_mm.max()) <= OFF_MM:
        return
    worst = int(off_mm.argmax())
    x, y, z = points[worst].tolist()
    raise PrintprepError(
        f"{part.name}: the part {verb} the surface of the model by {off_mm[worst]:.3g} mm, at "
        f"({x:.1f}, {y:.1f}, {z:.1f}) mm.",
        _HINT,
    )


def _beside_drains(points: Float, drains: tuple[Drain, ...]) -> Bool:
    """(n,) whether points (n, 3) mm lie in or around a drain hole.

    Inward a hole has no end here: it may graze the floor of its cavity far from its mouth.
    """
    near = np.zeros(len(points), dtype=bool)
    for drain in drains:
        away = points - np.array(drain.centre_mm)
        along = away @ np.array(drain.axis)
        across = np.linalg.norm(away - along[:, None] * np.array(drain.axis), axis=1)
        reach = drain.length_mm + 2 * drain.diameter_mm
        near |= (across <= BESIDE_DRAIN * drain.diameter_mm) & (along <= reach)
    return near


def _some(vertices: Float) -> Float:
    """(k, 3) some of vertices (n, 3), always the same ones."""
    return vertices[:: max(1, len(vertices) // MOST_POINTS)]
