"""Drain the cavities of a part: outlets, vents, and filling where neither drains.

The part stands upright on its plate, as it prints.  Every pool that holds enough gets an outlet at
the lowest place that the hole's own ball reaches.  What no outlet drains is filled, with floors
that fall toward an outlet.  So no layer closes off a region from the air: nothing stays trapped,
and nothing sucks at the vat.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.cavity.carve import ball_mm3, cavities_of
from printprep.drainage.channel import Channel, bored
from printprep.drainage.driller import Driller, Hole
from printprep.drainage.voxelized_part import VoxelizedPart, voxelize, with_cavities

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.drainage.hole_candidates import Role


@dataclass(frozen=True, eq=False)
class Drained:
    """Drained cavities, and the holes that open them.

    cavities : positive solids, largest first;  holes : outlets first, cavity by cavity.
    filled_mm3 : volume filled in the cavities that are left.
    closed_mm3 : volumes of the cavities that no hole of this size opens; they are filled whole.
    """

    cavities: tuple[Manifold, ...]
    holes: tuple[Hole, ...]
    filled_mm3: float
    closed_mm3: tuple[float, ...]


def drain_cavities(
    outside: Manifold,
    cavities: Sequence[Manifold],
    *,
    diameter_mm: float,
    count_of: Callable[[float], int],
    wall_mm: float,
    min_feature_mm: float,
    crumb_mm3: float = 0.0,
    known: Sequence[Hole] = (),
    kept: Sequence[Manifold] = (),
    voxelized: VoxelizedPart | None = None,
) -> Drained:
    """Drain the cavities of a part.

    Parameters
    ----------
    outside : the part without its cavities, on the plate.
    diameter_mm : of the holes;  count_of : least number of holes for a cavity of so many mm³.  Of
        two or more, at least one is a vent; every pool gets an outlet of its own.
    crumb_mm3 : dents that hold less than this are not filled.
    known : holes of a similar part, kept where they still fit.
    kept : those of the cavities that stay, sealed, where no hole drains them.
    voxelized : the outside on a grid, where it is at hand (see `voxelized_part.voxelize`).
    """
    from manifold3d import Manifold, OpType

    if not cavities:
        return Drained((), (), 0.0, ())
    void = Manifold.batch_boolean(list(cavities), OpType.Add)
    voxelized = voxelize(outside, diameter_mm) if voxelized is None else voxelized
    driller = Driller(with_cavities(voxelized, void), outside, void, diameter_mm, wall_mm)
    driller.keep(known)
    driller.drill_outlets()
    driller.drill_vents(count_of)
    left = driller.left_of(void, ball_mm3(min_feature_mm), crumb_mm3)
    return _assigned(driller.drilled, cavities_of(left, min_feature_mm), cavities, kept)


def _assigned(
    drilled: Sequence[tuple[Role, Channel]],
    pieces: Sequence[Manifold],
    before: Sequence[Manifold],
    staying: Sequence[Manifold],
) -> Drained:
    """Keep the pieces that an outlet opens, with their holes.

    before : the cavities before anything was filled;  staying : those of them that are not filled
    even where no hole opens them.
    """
    solids = [bored(channel) for _, channel in drilled]
    kept: list[Manifold] = []
    holes: list[Hole] = []
    used: set[int] = set()
    for piece in pieces:
        opening = [
            k for k, solid in enumerate(solids) if k not in used and (solid ^ piece).volume() > 0
        ]
        if not any(drilled[k][0] == "outlet" for k in opening):
            continue
        used.update(opening)
        holes += [Hole(*drilled[k], len(kept)) for k in opening]
        kept.append(piece)
    kept += [void for void in staying if not any((void ^ piece).volume() > 0 for piece in kept)]
    closed = [
        float(cavity.volume())
        for cavity in before
        if not any((cavity ^ piece).volume() > 0 for piece in kept)
    ]
    total = sum(cavity.volume() for cavity in before)
    filled = total - sum(closed) - sum(piece.volume() for piece in kept)
    return Drained(tuple(kept), tuple(holes), float(filled), tuple(closed))
