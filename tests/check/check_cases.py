"""Solids in closed form, and exactly what the rules must find in each: the sides of every limit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from closed_form_parts import box, hollow_box, roofed, roofed_cavity
from manifold3d import CrossSection, Manifold

from printprep.check import context_of_solid, run_rules
from printprep.mesh.measure import arrays
from printprep.mesh.repair import repair
from printprep.profiles import Profile, load_profile
from printprep.stand.stability import stability
from printprep.types import Finding, Lean, Model

PROFILES = {"fdm": "fdm-pla-0.4", "resin": "resin-standard", "powder": "sls-pa12"}
_MARK = {"i": "info", "w": "warning", "e": "error"}

Triangles = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Case:
    """A file and what must be said of it, no more and no less.

    expected : rules with their severities, as "rule:e" (error), ":w" (warning) or ":i" (info).
    blocker : where the file tells a slicer to make no supports.
    """

    name: str
    process: str
    build: Callable[[], Manifold | Triangles]
    expected: str = ""
    blocker: Callable[[], Manifold] | None = None

    @property
    def wanted(self) -> set[tuple[str, str]]:
        pairs = (item.split(":") for item in self.expected.split())
        return {(rule, _MARK[mark]) for rule, mark in pairs}


def found_in(case: Case) -> tuple[Finding, ...]:
    """What the rules say of a case's triangles, as of a file that holds them."""
    profile = profile_of(case.process)
    made = case.build()
    vertices, faces = arrays(made) if isinstance(made, Manifold) else made
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle = np.array([*(low + high)[:2] / 2, low[2]])
    model = Model(vertices - middle, faces, np.eye(4), case.name)
    solid = repair(model)
    standing = stability(solid.manifold, profile.printer.first_layer_mm)
    blocker = None if case.blocker is None else case.blocker()
    context = context_of_solid(solid.manifold, standing, Lean(10.0), solid.repair, model, blocker)
    return run_rules(context, profile)


@cache
def profile_of(process: str) -> Profile:
    return load_profile(PROFILES[process])


def at(part: Manifold, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Manifold:
    return part.translate((x, y, z))


def slab(x: float, y: float, z: float, up: float = 0.0) -> Manifold:
    """A box x by y by z, centred, its underside at ``up``."""
    return at(Manifold.cube((x, y, z)), -x / 2, -y / 2, up)


def rod(diameter: float, height: float, up: float = 0.0, sides: int = 64) -> Manifold:
    return at(Manifold.cylinder(height, diameter / 2, diameter / 2, sides), z=up)


def drill(diameter: float, z: float, x0: float = 5.0, x1: float = 30.0) -> Manifold:
    """A drill along +x at a height."""
    return at(rod(diameter, x1 - x0).rotate((0, 90, 0)), x0, 0, z)


def fin(thick: float, wide: float = 16.0, tall: float = 8.0) -> Manifold:
    return box(20) + slab(wide, thick, tall + 1, 19)


def wedge(deg: float) -> Manifold:
    """A wedge, its edge up, on a block."""
    half, tall = 10 * math.tan(math.radians(deg / 2)), 10.0
    outline = CrossSection([[(-half, 0), (half, 0), (0, tall)]])
    return slab(20, 20, 10) + at(outline.extrude(20).rotate((90, 0, 0)), 0, 10, 9.9)


def needle(deg: float, tall: float) -> Manifold:
    foot = tall * math.tan(math.radians(deg / 2))
    return box(20) + at(Manifold.cylinder(tall + 0.5, foot, 0, 96), z=19.5)


def slot(width: float, deep: float = 10.0) -> Manifold:
    return box(20) - slab(width, 40, 40, 20 - deep)


def groove(deg: float) -> Manifold:
    """A block with a groove that comes to a point."""
    half = 8 * math.tan(math.radians(deg / 2))
    outline = CrossSection([[(-half, 12), (0, 4), (half, 12)]])
    return slab(30, 20, 12) - at(outline.extrude(40).rotate((90, 0, 0)), 0, 20, 0)


def leaning(deg: float) -> Manifold:
    """A foot of 20 mm that widens upward by an angle from the vertical, under a slab."""
    out = 5 * math.tan(math.radians(deg))
    low = [(x, y, 0.0) for x in (-10, 10) for y in (-10, 10)]
    wide = (-10 - out, 10 + out)
    high = [(x, y, z) for x in wide for y in wide for z in (5.0, 9.0)]
    return Manifold.hull_points(np.array([*low, *high]))


def shelf(deep: float, wide: float) -> Manifold:
    return box(20) + at(Manifold.cube((deep + 1, wide, 4)), 9, -wide / 2, 10)


def table(leg: float, tall: float) -> Manifold:
    legs = [at(slab(leg, leg, tall), x, y) for x in (-8, 8) for y in (-8, 8)]
    return sum(legs[1:], legs[0]) + slab(20, 20, 3, tall - 3)


def rooms(neck: float, drain: float, neck_z: float = 3.8, drain_z: float = 3.8) -> Manifold:
    """A block with two rooms of 16 mm, floors at z = 2, a neck between and a drain from one."""
    space = at(box(16, z=2), -10) + at(box(16, z=2), 10)
    if neck:
        space = space + drill(neck, neck_z, -5, 5)
    return slab(40, 20, 20) - space - drill(drain, drain_z, 12)


def dish(side: float, deep: float) -> Manifold:
    return box(20) - box(side, 40, z=20 - deep)


def channels() -> Manifold:
    """A bottom like a raft: channels that open at its ends."""
    part = slab(24, 24, 10)
    for y in (-8, -4, 0, 4, 8):
        part = part - at(Manifold.cube((60, 2, 2)), -30, y - 1)
    return part


def without_one(part: Manifold) -> Triangles:
    vertices, faces = arrays(part)
    return vertices, faces[1:]


def one_turned(part: Manifold) -> Triangles:
    vertices, faces = arrays(part)
    faces = faces.copy()
    faces[0] = faces[0, ::-1]
    return vertices, faces


def all_turned(part: Manifold) -> Triangles:
    vertices, faces = arrays(part)
    return vertices, faces[:, ::-1].copy()


def shells(*parts: Manifold) -> Triangles:
    """Several bodies in one file, as they are; corners in one place are one."""
    every = [arrays(part) for part in parts]
    starts = np.cumsum([0, *(len(v) for v, _ in every)])
    points = np.concatenate([v for v, _ in every])
    faces = np.concatenate([f + s for (_, f), s in zip(every, starts, strict=False)])
    unique, index = np.unique(points.round(6), axis=0, return_inverse=True)
    return unique, index.ravel()[faces]


def pushed_through() -> Triangles:
    """A block whose one side is pushed out through the other."""
    vertices, faces = arrays(box(20).refine(4))
    vertices = vertices.copy()
    side = np.isclose(vertices, (10, 0, 10)).all(axis=1)
    vertices[side] = (-14, 0.7, 10.3)
    return vertices, faces


def with_a_needle() -> Triangles:
    """A block, one of whose edges has a corner in its middle, and a triangle along it."""
    vertices, faces = arrays(box(20))
    a, b = faces[0, 0], faces[0, 1]
    middle = len(vertices)
    vertices = np.vstack([vertices, (vertices[a] + vertices[b]) / 2])
    first = [(a, middle, faces[0, 2]), (middle, b, faces[0, 2]), (a, b, middle)]
    return vertices, np.vstack([np.array(first), faces[1:]])


_SHUT = "sealed-cavity:i unsupported-ceiling:w"

CASES: tuple[Case, ...] = (
    Case("a cube", "fdm", lambda: box(20)),
    Case("a cube in resin", "resin", lambda: box(20)),
    Case("a cube in powder", "powder", lambda: box(20)),
    Case("a turned cube", "fdm", lambda: box(20).rotate((0, 0, 33))),
    # walls around cavities
    Case(
        "a roof of 45° in a blocker",
        "fdm",
        lambda: roofed(45),
        "sealed-cavity:i",
        lambda: box(18, 10, 1),
    ),
    Case(
        "a roof of 45° in a blocker no larger than the cavity",
        "fdm",
        lambda: roofed(45),
        "sealed-cavity:i support-blocker:w",
        lambda: roofed_cavity(45),
    ),
    Case(
        "a roof of 45° in a blocker as large as the part",
        "fdm",
        lambda: roofed(45),
        "sealed-cavity:i support-blocker:w",
        lambda: box(20, 12),
    ),
    Case(
        "a flat ceiling in a blocker",
        "fdm",
        lambda: hollow_box(20, 2),
        "sealed-cavity:i unsupported-ceiling:w",
        lambda: box(18, 18, 1),
    ),
    Case("a cavity in a wall of 1.16 mm", "fdm", lambda: hollow_box(20, 1.16), _SHUT),
    Case(
        "a cavity in a wall of 1.14 mm",
        "fdm",
        lambda: hollow_box(20, 1.14),
        _SHUT + " wall-thickness:e",
    ),
    Case(
        "a cavity 0.9 mm from one side",
        "fdm",
        lambda: box(20) - at(box(15, z=2), 1.6),
        _SHUT + " wall-thickness:e",
    ),
    Case("a ceiling of 35°", "fdm", lambda: roofed(35), "sealed-cavity:i"),
    Case("a ceiling of 50°", "fdm", lambda: roofed(50), _SHUT),
    # walls and pins of the model
    Case("a fin of 1.09 mm", "fdm", lambda: fin(1.09)),
    Case("a fin of 1.07 mm", "fdm", lambda: fin(1.07), "wall-thickness:i"),
    Case("a fin of 0.55 mm", "fdm", lambda: fin(0.55), "wall-thickness:i"),
    Case("a fin of 0.53 mm", "fdm", lambda: fin(0.53), "wall-thickness:w"),
    Case("a fin of 1.5 by 1 mm", "fdm", lambda: fin(0.8, 1.5, 1)),
    Case("a fin of 4 by 1.5 mm", "fdm", lambda: fin(0.8, 4, 1.5), "wall-thickness:i"),
    Case("a fin of 1.82 mm in resin", "resin", lambda: fin(1.82)),
    Case("a fin of 1.78 mm in resin", "resin", lambda: fin(1.78), "wall-thickness:i"),
    Case("a fin of 0.91 mm in powder", "powder", lambda: fin(0.91)),
    Case("a fin of 0.89 mm in powder", "powder", lambda: fin(0.89), "wall-thickness:i"),
    Case("an edge of 60°", "fdm", lambda: wedge(60)),
    Case("an edge of 32°", "fdm", lambda: wedge(32)),
    Case("an edge of 28°", "fdm", lambda: wedge(28), "wall-thickness:w"),
    Case("a plate of 1 mm on the bed", "fdm", lambda: slab(30, 30, 1.0)),
    Case("a plate of 1.2 mm on the bed", "fdm", lambda: slab(30, 30, 1.2)),
    Case("a pin of 1.1 mm", "fdm", lambda: box(20) + rod(1.1, 10, 19)),
    Case("a pin of 1.06 mm", "fdm", lambda: box(20) + rod(1.06, 10, 19), "min-feature:w"),
    Case("a rib of 1 by 4 mm", "fdm", lambda: fin(1.0, 4, 8), "wall-thickness:i"),
    Case("a pin of 1.38 mm in resin", "resin", lambda: box(20) + rod(1.38, 10, 19)),
    Case(
        "a pin of 1.33 mm in resin", "resin", lambda: box(20) + rod(1.33, 10, 19), "min-feature:w"
    ),
    Case("a spike of 34°", "fdm", lambda: needle(34, 12)),
    Case("a needle of 8°", "fdm", lambda: needle(8, 25), "min-feature:w"),
    # gaps
    Case("a slot of 0.2 mm", "fdm", lambda: slot(0.2)),
    Case("a slot of 0.18 mm", "fdm", lambda: slot(0.18), "gap:i"),
    Case("a slot of 0.05 mm", "fdm", lambda: slot(0.05), "gap:i"),
    Case("a slot too small to matter", "fdm", lambda: slot(0.1, 0.08)),
    Case("a slot of 0.13 mm in resin", "resin", lambda: slot(0.13)),
    Case("a slot of 0.11 mm in resin", "resin", lambda: slot(0.11), "gap:i"),
    Case("a groove of 60°", "fdm", lambda: groove(60)),
    Case("a groove of 15°", "fdm", lambda: groove(15)),
    # overhangs and contact
    Case("sides that lean 44°", "fdm", lambda: leaning(44)),
    Case("sides that lean 46°", "fdm", lambda: leaning(46), "overhang-area:i"),
    Case("sides that lean 70° in resin", "resin", lambda: leaning(70)),
    Case("sides that lean 72° in resin", "resin", lambda: leaning(72), "overhang-area:i"),
    Case("sides that lean 72° in powder", "powder", lambda: leaning(72)),
    Case("a shelf of 9.5 mm²", "fdm", lambda: shelf(2.5, 3.8)),
    Case("a shelf of 10.5 mm²", "fdm", lambda: shelf(2.5, 4.2), "overhang-area:i"),
    Case("feet of 26 mm² in all", "fdm", lambda: table(2.55, 24), "overhang-area:i"),
    Case(
        "feet of 24 mm² in all",
        "fdm",
        lambda: table(2.45, 24),
        "contact-area:w overhang-area:i",
    ),
    Case("feet of 24 mm², not tall", "fdm", lambda: table(2.45, 19), "overhang-area:i"),
    Case("a floating cube", "fdm", lambda: box(20) + box(10, z=25), "no-contact:e overhang-area:i"),
    Case("a column that stands to 10.1°", "fdm", lambda: box(10, 10 / math.tan(0.17628))),
    Case("a column that tips at 9.9°", "fdm", lambda: box(10, 10 / math.tan(0.17279)), "tilt:e"),
    # size and facets
    Case("as long as the bed", "fdm", lambda: slab(250, 20, 20)),
    Case("longer than the bed", "fdm", lambda: slab(250.5, 20, 20), "fits-bed:e"),
    Case("as tall as the printer", "fdm", lambda: slab(60, 60, 210)),
    Case("taller than the printer", "fdm", lambda: slab(60, 60, 210.5), "fits-bed:e"),
    Case("a cube of 1 mm", "fdm", lambda: box(1), "min-feature:w"),
    Case("a cube of 0.99 mm", "fdm", lambda: box(0.99), "min-feature:w tiny-model:e"),
    Case("a round of 24 sides", "fdm", lambda: rod(40, 20, sides=24)),
    Case("a round of 22 sides", "fdm", lambda: rod(40, 20, sides=22), "coarse-facets:i"),
    Case("a hexagon", "fdm", lambda: rod(40, 20, sides=6)),
    Case("a fine round", "resin", lambda: rod(40, 20, sides=128)),
    # what runs out: resin
    Case("sealed", "resin", lambda: hollow_box(20, 2), "sealed-cavity:e suction-cup:w"),
    Case(
        "sealed, smaller than the ball", "resin", lambda: box(20) - box(2, z=9), "sealed-cavity:e"
    ),
    Case(
        "a low hole of 3.5 mm",
        "resin",
        lambda: hollow_box(20, 2) - drill(3.5, 3.8),
        "overhang-area:i no-vent:i",
    ),
    Case(
        "a low hole of 3.4 mm",
        "resin",
        lambda: hollow_box(20, 2) - drill(3.4, 3.75),
        "overhang-area:i no-vent:i drain-too-small:e",
    ),
    Case(
        "a hole 3 mm above the floor",
        "resin",
        lambda: hollow_box(20, 2) - drill(3.5, 6.75),
        "overhang-area:i no-vent:i suction-cup:w trapped-volume:w",
    ),
    Case(
        "a hole in the ceiling",
        "resin",
        lambda: hollow_box(20, 2) - rod(4, 10, 15),
        "overhang-area:i no-vent:i suction-cup:w trapped-volume:w",
    ),
    Case(
        "a hole that the plate shuts",
        "resin",
        lambda: hollow_box(20, 2) - rod(4, 10, -5),
        "overhang-area:i no-vent:i suction-cup:w",
    ),
    Case(
        "a hole below, a vent beside it",
        "resin",
        lambda: hollow_box(20, 2) - rod(4, 10, -5) - drill(3.5, 3.8),
        "overhang-area:i",
    ),
    Case("a mug", "resin", lambda: box(20) - box(16, 40, z=2), "suction-cup:w trapped-volume:i"),
    Case("a bell", "resin", lambda: box(20) - box(16, 18), "overhang-area:i suction-cup:w"),
    Case(
        "a bell with a vent at its foot",
        "resin",
        lambda: box(20) - box(16, 18) - drill(2, 1.2),
        "overhang-area:i",
    ),
    Case("a bottom like a raft", "resin", channels, "overhang-area:i"),
    Case("through a neighbour", "resin", lambda: rooms(3.5, 3.5), "overhang-area:i no-vent:i"),
    Case(
        "through a neighbour, neck of 3.3 mm",
        "resin",
        lambda: rooms(3.3, 3.5, 3.7),
        "overhang-area:i no-vent:i drain-too-small:e",
    ),
    Case(
        "both behind a drain of 3.3 mm",
        "resin",
        lambda: rooms(4, 3.3, 4, 3.7),
        "overhang-area:i no-vent:i drain-too-small:e",
    ),
    Case(
        "a neighbour behind a high neck",
        "resin",
        lambda: rooms(4, 3.5, 12),
        "overhang-area:i no-vent:i suction-cup:w trapped-volume:w",
    ),
    Case(
        "a neighbour without a neck",
        "resin",
        lambda: rooms(0, 3.5),
        "overhang-area:i sealed-cavity:e suction-cup:w",
    ),
    Case("a dish of 98 mm²", "resin", lambda: dish(9.9, 5), "trapped-volume:i"),
    Case("a dish of 102 mm²", "resin", lambda: dish(10.1, 5), "suction-cup:w trapped-volume:i"),
    Case("a dish 0.8 mm deep", "resin", lambda: dish(12, 0.8)),
    Case("a dish that holds 20 mm³", "resin", lambda: dish(3.0, 2.2)),
    # what runs out: powder, filament
    Case("sealed in powder", "powder", lambda: hollow_box(20, 2), "sealed-cavity:e"),
    Case("a hole anywhere, powder", "powder", lambda: hollow_box(20, 2) - rod(3.5, 10, 15)),
    Case(
        "a hole of 3.3 mm, powder",
        "powder",
        lambda: hollow_box(20, 2) - rod(3.3, 10, 15),
        "drain-too-small:e",
    ),
    Case("a mug in powder", "powder", lambda: box(20) - box(16, 40, z=2)),
    Case("sealed in filament", "fdm", lambda: roofed(30), "sealed-cavity:i"),
    # the file's own triangles
    Case("a hole in the surface", "fdm", lambda: without_one(box(20)), "open-surface:e repaired:w"),
    Case("one triangle turned", "fdm", lambda: one_turned(box(20)), "orientation:w repaired:i"),
    Case("inside out", "fdm", lambda: all_turned(box(20)), "orientation:w repaired:i"),
    Case("a void that is one", "fdm", lambda: arrays(roofed(30)), "sealed-cavity:i"),
    Case(
        "two bodies that overlap",
        "fdm",
        lambda: shells(box(20), at(box(20), 10.3, 0.7)),
        "overlapping-shells:i repaired:i",
    ),
    Case("two bodies apart", "fdm", lambda: shells(box(20), at(box(20), 25))),
    Case(
        "two bodies that share an edge",
        "fdm",
        lambda: shells(box(20), at(box(20), 20, 20)),
        "non-manifold-edges:w",
    ),
    Case("through itself", "fdm", pushed_through, "overhang-area:i self-intersection:w"),
    Case("a triangle without area", "fdm", with_a_needle, "degenerate-triangles:i"),
)
