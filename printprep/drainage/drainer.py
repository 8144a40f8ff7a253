"""The drainer: drains the parts that ``hollow`` makes, one solve after another."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from printprep.drainage.channel import bored
from printprep.drainage.drain_cavities import Drained, drain_cavities
from printprep.drainage.driller import Hole
from printprep.drainage.voxelized_part import voxelize
from printprep.types import Drain, Drainage

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.drainage.voxelized_part import VoxelizedPart
    from printprep.profiles import Profile
    from printprep.types import Base, Part


class Drainer:
    """Drains one part after another of the same solid, and keeps the holes that still fit.

    bores : the solids that the holes of the last part remove;  filled : the filling of its
    cavities.
    """

    def __init__(self, profile: Profile) -> None:
        from manifold3d import Manifold

        assert profile.drain.diameter_mm is not None
        self.diameter_mm = profile.drain.diameter_mm
        self.profile = profile
        self.bores = Manifold()
        self.filled = Manifold()
        self._holes: tuple[Hole, ...] = ()
        self._space: tuple[Base | None, VoxelizedPart] | None = None

    @property
    def taken_mm3(self) -> float:
        """Volume of the last part's holes and filling."""
        return float(self.bores.volume() + self.filled.volume())

    def drain(self, part: Part) -> tuple[Part, Drainage]:
        """Drain the cavities of a part; the drained part is not yet finished."""
        from manifold3d import Manifold, OpType

        found = drain_cavities(
            part.outside,
            part.cavities,
            diameter_mm=self.diameter_mm,
            count_of=self.profile.drain.holes_of,
            wall_mm=self.profile.wall_mm,
            min_feature_mm=self.profile.min_feature_mm,
            crumb_mm3=self.profile.crumb_mm3,
            kept=part.kept,
            known=self._holes,
            voxelized=self._around(part),
        )
        self._holes = found.holes
        self.bores = _united([bored(hole.channel) for hole in found.holes])
        self.filled = _united(part.cavities) - _united(found.cavities)
        whole = Manifold.batch_boolean([part.outside, *found.cavities, self.bores], OpType.Subtract)
        return replace(part, manifold=whole, cavities=found.cavities), _drainage(found)

    def _around(self, part: Part) -> VoxelizedPart:
        """The part's outside on a grid; it changes only with the base."""
        if self._space is None or self._space[0] is not part.base:
            self._space = part.base, voxelize(part.outside, self.diameter_mm)
        return self._space[1]


def _united(solids: Sequence[Manifold]) -> Manifold:
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(list(solids), OpType.Add) if solids else Manifold()


def _drainage(found: Drained) -> Drainage:
    return Drainage(tuple(map(_drain, found.holes)), found.filled_mm3, found.closed_mm3)


def _drain(hole: Hole) -> Drain:
    channel = hole.channel
    return Drain(
        role=hole.role,
        cavity=hole.cavity,
        centre_mm=_place(channel.centre_mm),
        axis=_place(channel.axis),
        diameter_mm=channel.diameter_mm,
        length_mm=channel.length_mm,
    )


def _place(point: Float) -> tuple[float, float, float]:
    """A point (3,) as plain numbers."""
    x, y, z = (float(value) for value in point)
    return x, y, z
