"""The trees of columns while they grow: places, what each leans on, how much is above it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

# Between points of an axis on which other columns may lean.
AXIS_STEP_MM = 0.5
# A column that stands on the shell falls at least so far.
LEAST_FALL_MM = 0.1


@dataclass(frozen=True, eq=False)
class Axes:
    """Points along the axes of all columns.

    place_mm : (n, 3) mm;  above_mm : (n,) mm, longest way up to a tip;  below_mm : (n,) mm, way
    down to the shell;  upper : (n,) number of the place at the column's upper end.
    """

    place_mm: Float
    above_mm: Float
    below_mm: Float
    upper: Int


@dataclass(eq=False)
class Forest:
    """Trees of columns between numbered places; its methods add columns.

    above_mm : longest way up from each place to a tip;  down : the place it leans on, −1 for none;
    stands : places that end on the shell.  A place is (3,) float64 mm.
    """

    _place: list[Float] = field(default_factory=list)
    above_mm: list[float] = field(default_factory=list)
    down: list[int] = field(default_factory=list)
    stands: list[int] = field(default_factory=list)
    _axes: list[Axes] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self._place)

    def place(self, index: int) -> Float:
        """(3,) mm, a place by its number."""
        return self._place[index]

    def places(self, indices: Int) -> Float:
        """(n, 3) mm, places by their numbers (n,)."""
        return np.array([self._place[index] for index in indices.tolist()]).reshape(-1, 3)

    def plant(self, place: Float) -> int:
        """Add a place (3,) mm that nothing leans on yet; returns its number."""
        self._place.append(np.asarray(place, dtype=np.float64))
        self.above_mm.append(0.0)
        self.down.append(-1)
        return len(self._place) - 1

    def stand(self, index: int, foot: Float) -> None:
        """Add a column from a place to its foot (3,) mm on the shell.

        A foot that is not lower than the place moves to just under it.
        """
        start = self._place[index]
        end = self.plant(foot if foot[2] < start[2] else start - [0.0, 0.0, LEAST_FALL_MM])
        self.stands.append(end)
        self.lean_on(index, end, 0.0)

    def lean_on(self, index: int, lower: int, below_mm: float) -> None:
        """Add a column between two places; ``below_mm`` is the lower one's way to the shell."""
        self.down[index] = lower
        start, end = self._place[index], self._place[lower]
        length = float(np.linalg.norm(end - start))
        steps = max(1, int(length / AXIS_STEP_MM))
        share = np.arange(steps + 1) / steps
        self._carry(lower, self.above_mm[index] + length)
        self._axes.append(
            Axes(
                start + share[:, None] * (end - start),
                self.above_mm[index] + share * length,
                below_mm + (1 - share) * length,
                np.full(steps + 1, index, dtype=np.int64),
            )
        )

    def join(self, index: int, point: int) -> None:
        """Add a column down to a point of an axis, numbered as in :meth:`axes`; the axis splits."""
        axes = self.axes()
        upper, where = int(axes.upper[point]), axes.place_mm[point]
        lower = self.down[upper]
        if np.array_equal(where, self._place[lower]):
            self.lean_on(index, lower, float(axes.below_mm[point]))
            return
        joint = self.plant(where)
        self.above_mm[joint] = float(axes.above_mm[point])
        self.down[upper], self.down[joint] = joint, lower
        under = (axes.upper == upper) & (axes.place_mm[:, 2] < where[2])
        axes.upper[under] = joint
        self.lean_on(index, joint, float(axes.below_mm[point]))

    def axes(self) -> Axes:
        """All points so far, in a fixed order."""
        if len(self._axes) != 1:
            parts = self._axes
            none = Axes(np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.int64))
            self._axes = [
                Axes(
                    *(
                        np.concatenate([getattr(none, name), *(getattr(p, name) for p in parts)])
                        for name in ("place_mm", "above_mm", "below_mm", "upper")
                    )
                )
            ]
        return self._axes[0]

    def _carry(self, index: int, above_mm: float) -> None:
        """Raise ``above_mm`` of a place, and of all places it leans on."""
        while index >= 0 and above_mm > self.above_mm[index]:
            self.above_mm[index] = above_mm
            lower = self.down[index]
            if lower >= 0:
                above_mm += float(np.linalg.norm(self._place[lower] - self._place[index]))
            index = lower

    def move(self, index: int, place: Float) -> None:
        """Move the end of a column to a place (3,) mm on its line."""
        self._place[index] = place
