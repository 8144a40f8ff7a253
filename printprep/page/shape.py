"""The solids that a page shows: a part taken apart by what its material and its holes are for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.channel import placed
from printprep.drainage.plugs import plug_in_place
from printprep.mesh.measure import innermost, shells

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.grid.distance import DepthField
    from printprep.output.figures import Figures
    from printprep.pipeline.check import Checked
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.types import Drain, Plane

# A channel is closed by a solid that is wider than it by this share.
_WIDER = 1.02
# The wall of a written part is taken this much thicker, so that what is found beside its cavities
# does not end on almost the same surface.
_APART_MM = 0.06
# A difference with less volume is what rounding leaves.
_LEAST_MM3 = 1e-3


@dataclass(frozen=True, eq=False)
class Shape:
    """What a page shows, all in mm on the bed.

    part : the whole part, as it is written;  outside : its outer surface;  cavities : its voids.
    base, vaults, ballast, infill : material by its purpose, None where there is none.  The solids
    may reach out of the part.
    deep : all deeper than the wall, None where that is not known;  slack_mm : how far its surface
    may lie from that of the cavities.
    drains : holes from a cavity to the outside;  plugs : what closes them, one for each.
    """

    part: Manifold
    outside: Manifold
    cavities: tuple[Manifold, ...]
    base: Manifold | None = None
    vaults: Manifold | None = None
    ballast: Manifold | None = None
    infill: Manifold | None = None
    deep: Manifold | None = None
    drains: tuple[Drain, ...] = ()
    plugs: tuple[Manifold, ...] = ()
    slack_mm: float = 0.0


def shape_of_result(result: HollowResult) -> Shape:
    """The solids of a part that was just hollowed."""
    part, profile = result.part, result.profile
    workings = result.workings
    deep, hollowable = None, None
    if workings is not None:
        deep, hollowable = workings.deep, workings.hollowable
        if result.infill is not None:
            deep = _deep(result.solid.manifold, workings.depths.field, profile.wall_mm)
    drains = () if result.drainage is None else result.drainage.drains
    base = None if part.base is None else part.base.manifold - result.solid.manifold
    if result.infill is not None:
        ballast = _filled(None if deep is None else _union(result.infill.ballast) ^ deep)
        infill = deep if deep is None or ballast is None else deep - ballast
        vaults = None
    else:
        vaults = None if deep is None or hollowable is None else deep - hollowable
        ballast = None if hollowable is None else hollowable - _union(part.cavities)
        infill = None
    return Shape(
        part.manifold,
        part.outside,
        part.cavities,
        base=_filled(base),
        vaults=_filled(vaults),
        ballast=_filled(ballast),
        infill=_filled(infill),
        deep=_filled(deep),
        drains=drains,
        plugs=_plugs(drains, part.outside),
    )


def shape_of_part(part: Manifold, figures: Figures, profile: Profile) -> Shape:
    """The solids of a written part, found again in its mesh and its figures.

    Drain holes are closed to find the cavities.  Vaults are the material above the planes where the
    wall allows a cavity, ballast that below them; the base is what lies below its seat.

    part : at the place that its figures tell.
    """
    drains = () if figures.drains is None else figures.drains.items
    closed = _union([part, *(_stopper(drain) for drain in drains)])
    solids, voids = shells(closed)
    outside = _united_shells(closed, solids, voids, figures.cavities.count)
    cavities = _filled(outside - closed)
    deep = _deep_of(outside, figures, profile)
    vaults = ballast = infill = base = None
    if deep is not None:
        low = _below(deep, figures.planes)
        if figures.infill is not None:
            ballast, infill = low, deep if low is None else deep - low
        else:
            material = deep if cavities is None else deep - cavities
            ballast = None if low is None else material ^ low
            vaults = material if low is None else material - low
            if figures.supports is None:
                ballast, vaults = material, None
    if figures.base is not None and figures.base.seat_mm > 0:
        base = outside.trim_by_plane((0.0, 0.0, -1.0), -figures.base.seat_mm)
    return Shape(
        part,
        outside,
        () if cavities is None else (cavities,),
        base=_filled(base),
        vaults=_filled(vaults),
        ballast=_filled(ballast),
        infill=_filled(infill),
        deep=_filled(deep),
        drains=drains,
        plugs=_plugs(drains, outside),
        slack_mm=_APART_MM,
    )


def shape_of_checked(found: Checked) -> Shape:
    """The solids of a file as it came: its outside and its voids."""
    context = found.context
    return Shape(context.part, context.outside, context.cavities)


def _united_shells(
    closed: Manifold, solids: Sequence[Manifold], voids: Sequence[Manifold], cavities: int
) -> Manifold:
    """The part without its cavities: the largest voids are filled, as many as it has cavities."""
    kept = sorted(voids, key=lambda void: -float(void.volume()))[cavities:]
    if len(kept) == len(voids):
        return closed
    inner = [solid for solid in solids if innermost(solid, voids) is not None]
    outer = _union([solid for solid in solids if not any(solid is other for other in inner)])
    for void in kept:
        outer = outer - void
    return outer


def _deep_of(outside: Manifold, figures: Figures, profile: Profile) -> Manifold | None:
    """All of a written part that lies deeper than its wall; None where nothing is."""
    from printprep.grid.depth import measure_depths
    from printprep.types import Repair, Solid

    if not figures.cavities.count and figures.infill is None:
        return None
    solid = Solid(outside, figures.model, Repair("as-is"), np.eye(4))
    depths = measure_depths(
        solid, resolution=64, wall_mm=profile.wall_mm, min_feature_mm=profile.min_feature_mm
    )
    return _deep(outside, depths.field, profile.wall_mm + _APART_MM)


def _deep(outside: Manifold, field: DepthField | None, wall_mm: float) -> Manifold | None:
    from printprep.cavity.surface import cavity_surface

    return _filled(cavity_surface(outside, field, wall_mm))


def _below(deep: Manifold, planes: Sequence[Plane | None] | None) -> Manifold | None:
    """What lies below the planes of its bodies; None where nothing is filled."""
    found = [plane for plane in planes or () if plane is not None]
    if not found:
        return None
    lows = [deep.trim_by_plane([-n for n in plane.normal], -plane.offset_mm) for plane in found]
    return _filled(_union(lows))


def _stopper(drain: Drain) -> Manifold:
    """A solid that closes a drain hole's channel, from its mouth to beyond its inner rim."""
    radius = drain.diameter_mm / 2 * _WIDER
    inner = -drain.length_mm - drain.diameter_mm
    profile = np.array([[0.0, inner], [radius, inner], [radius, 0.0], [0.0, 0.0]])
    return placed(profile, np.array(drain.centre_mm), np.array(drain.axis))


def _plugs(drains: Sequence[Drain], outside: Manifold) -> tuple[Manifold, ...]:
    return tuple(plug_in_place(drain, outside) for drain in drains)


def _union(solids: Sequence[Manifold]) -> Manifold:
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(list(solids), OpType.Add) if solids else Manifold()


def _filled(solid: Manifold | None) -> Manifold | None:
    """The solid, None where nothing is there."""
    if solid is None or solid.is_empty() or solid.volume() < _LEAST_MM3:
        return None
    return solid
