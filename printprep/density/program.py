"""The density of a whole part: the base that makes it lightest, and one plane for each body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from printprep.cavity.base import Feet, base_of, feet_of
from printprep.density.fillings import Fillings
from printprep.density.lean import LeanSolution, solve_lean
from printprep.grid.domain import reweighed
from printprep.mesh.measure import bodies, mass_properties
from printprep.stand.contact import contact_of, section_at_bed
from printprep.types import Base, Lean

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Float
    from printprep.grid.domain import Interior
    from printprep.profiles import Profile


BasePolicy = Literal["auto", "never", "always"]

# Growth is tried in steps of this, then at half steps around the best: mass is flat there.
GROWTH_STEP_MM = 0.5
# Beyond this a base is a plinth to design, not one to grow.
MOST_GROWTH_MM = 30.0
# Two bases within this share of the mass tie, and the simpler one wins.
TIE = 1e-6


@dataclass(frozen=True, eq=False)
class BodySolution:
    """One body: which cells it has, what was solved, and its (4,) moments at unit density."""

    cells: tuple[int, ...]
    voxels: NDArray[np.intp]
    solution: LeanSolution | None
    moments: Float

    @property
    def reached(self) -> float:
        """Largest lean reached, +inf when the lean asked for is."""
        if self.solution is None:
            return -np.inf
        short = self.solution.reachable_deg
        return np.inf if short is None else short


@dataclass(frozen=True, eq=False)
class Choice:
    """A base with the lightest filling for it; volumes in mm³ at unit density."""

    base: Base | None
    parts: tuple[BodySolution, ...]
    volume_mm3: float
    bound_mm3: float

    @property
    def reached(self) -> float:
        """What its weakest body reaches, degrees; +inf when all stand as asked."""
        return min(part.reached for part in self.parts)


class Program:
    """The linear programs of one solid, for any base and any lean.

    moments : of each body, (4,), with all its voxels filled.
    """

    def __init__(self, solid: Manifold, interior: Interior, profile: Profile) -> None:
        self.solid = solid
        self.interior = interior
        self.profile = profile
        self.bodies = bodies(solid)
        self.moments = [_moments(body) for body in self.bodies]
        self._sections = [
            section_at_bed(body, profile.printer.first_layer_mm) for body in self.bodies
        ]
        self._body_of_voxel = interior.domain.body[interior.domain.free]
        self._pools: dict[tuple[int, ...], tuple[NDArray[np.intp], Fillings]] = {}
        self._feet: Feet | None = None

    def choose(self, policy: BasePolicy, lean: Lean) -> Choice:
        """The base of least total mass that reaches the lean; none on a tie.

        When no base reaches it, the one that reaches farthest.
        """
        margin = self.profile.stability.lean_margin_deg
        best: Choice | None = None
        if policy != "always":
            best = self.solve(None, lean, margin)
            if policy == "never" or self._cannot_be_beaten(best):
                return best
        for base in self._bases(policy):
            if best is not None and best.reached == np.inf and self._heavier(base, best):
                break
            best = _better(best, self.solve(base, lean, margin))
        if best is not None and best.base is not None and best.base.growth_mm > 0:
            for growth in self._around(best.base.growth_mm):
                nearby = base_of(self.feet, growth)
                best = _better(best, self.solve(nearby, lean, margin))
        # "always" on a solid whose feet are flat and cannot grow: there is nothing to add.
        return best if best is not None else self.solve(None, lean, margin)

    def solve(self, base: Base | None, lean: Lean, margin_deg: float) -> Choice:
        """The lightest filling of every body for one base."""
        volume, bound = 0.0, 0.0
        parts = []
        for cells, section, fixed in self.bodies_on_base(base):
            voxels, pool = self._pool(cells)
            fixed = fixed - pool.moments.sum(axis=1)
            contact = contact_of(section)
            if contact is None:
                parts.append(BodySolution(cells, voxels, None, fixed))
                volume, bound = volume + fixed[0], bound + fixed[0]
                continue
            footing = contact.footing.toward(lean.azimuth_deg)
            solution = solve_lean(pool, fixed, footing, lean.angle_deg, margin_deg)
            parts.append(BodySolution(cells, voxels, solution, solution.filling.moments))
            volume += float(solution.filling.moments[0])
            bound += solution.filling.bound
        return Choice(base, tuple(parts), volume, bound)

    def drilled(self, bores: Manifold, hollowable_volume: Manifold) -> Program:
        """The program of the same solid with holes in it.

        bores : what the holes take, of the solid and of the room;  room : what there is left of it
        for cavities.
        """
        interior = reweighed(self.interior, hollowable_volume - bores)
        return Program(self.solid - bores, interior, self.profile)

    def weighing(self, moments: Sequence[Float]) -> Program:
        """The same programs for bodies that, with all their voxels filled, weigh otherwise."""
        other = copy(self)
        other.moments = list(moments)
        return other

    def unfilled(self, base: Base | None) -> Float:
        """(k, 4) moments of what stands apart on a base, with none of its voxels filled."""
        return np.stack(
            [
                moments - self._pool(cells)[1].moments.sum(axis=1)
                for cells, _, moments in self.bodies_on_base(base)
            ]
        )

    def growth_that_reaches(self, lean: Lean) -> float | None:
        """Least growth, in steps of half a millimetre up to 30 mm, whose base reaches a lean."""
        steps = round(MOST_GROWTH_MM / GROWTH_STEP_MM)
        low, high = 0, steps + 1
        while high - low > 1:
            middle = steps if low == 0 and high > steps else (low + high) // 2
            base = base_of(self.feet, middle * GROWTH_STEP_MM)
            reached = self.solve(base, lean, 0.0).reached == np.inf
            low, high = (low, middle) if reached else (middle, high)
        return None if high > steps else high * GROWTH_STEP_MM

    @property
    def feet(self) -> Feet:
        """The feet, found when first asked for."""
        if self._feet is None:
            printer = self.profile.printer
            self._feet = feet_of(
                self.solid,
                self.profile.stability.base_seat_mm,
                printer.first_layer_mm,
                printer.layer_height_mm,
            )
        return self._feet

    def _bases(self, policy: BasePolicy) -> Iterator[Base]:
        limit = self.profile.stability.base_growth_max_mm
        for growth in np.arange(0.0, limit + 1e-9, GROWTH_STEP_MM):
            base = base_of(self.feet, float(growth))
            if base is not None:
                yield base

    def _heavier(self, base: Base, best: Choice) -> bool:
        """Whether the bare shell with this base, and so with any wider one, outweighs the best."""
        shell = sum(moments[0] for moments in self.moments) - self.interior.moments[0].sum()
        return bool(shell + (base.manifold - self.feet.slab).volume() > best.volume_mm3)

    def _around(self, growth_mm: float) -> Iterator[float]:
        for growth in (growth_mm - GROWTH_STEP_MM / 2, growth_mm + GROWTH_STEP_MM / 2):
            if 0 < growth <= self.profile.stability.base_growth_max_mm:
                yield growth

    def _cannot_be_beaten(self, choice: Choice) -> bool:
        """Standing with nothing filled: any base only adds to that."""
        return choice.reached == np.inf and all(
            part.solution is not None and part.solution.plane is None for part in choice.parts
        )

    def bodies_on_base(
        self, base: Base | None
    ) -> Iterator[tuple[tuple[int, ...], CrossSection, Float]]:
        """The bodies that stand apart with a base: which of the solid's, section, moments."""
        from manifold3d import CrossSection

        if base is None:
            for number, (section, moments) in enumerate(
                zip(self._sections, self.moments, strict=True)
            ):
                yield (number,), section, moments
            return
        first_layer = self.profile.printer.first_layer_mm
        for cells, pieces in _joined(self.bodies, base.manifold.decompose()):
            section = CrossSection()
            moments = np.zeros(4)
            for number in cells:
                section = section + self._sections[number]
                moments = moments + self.moments[number]
            for piece in pieces:
                section = section + section_at_bed(piece, first_layer)
                moments = moments + _moments(piece - self.feet.slab)
            yield cells, section, moments

    def _pool(self, cells: tuple[int, ...]) -> tuple[NDArray[np.intp], Fillings]:
        if cells not in self._pools:
            voxels = np.flatnonzero(np.isin(self._body_of_voxel, cells))
            self._pools[cells] = voxels, Fillings(self.interior.moments[:, voxels])
        return self._pools[cells]


def _better(first: Choice | None, second: Choice) -> Choice:
    """The lighter of two that stand, else the one that reaches farther; the first on a tie."""
    if first is None:
        return second
    if first.reached == second.reached:
        lighter = second.volume_mm3 < first.volume_mm3 * (1 - TIE)
        return second if lighter else first
    return second if second.reached > first.reached else first


def _moments(manifold: Manifold) -> Float:
    """(4,) volume in mm³ and first moments in mm⁴."""
    if manifold.is_empty():
        return np.zeros(4)
    properties = mass_properties(manifold)
    return properties.volume_mm3 * np.array([1.0, *properties.centre_mm])


def _joined(
    solids: Sequence[Manifold], pieces: Sequence[Manifold]
) -> Iterator[tuple[tuple[int, ...], list[Manifold]]]:
    """Groups of bodies that pieces of a base join, each with its pieces."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = len(solids)
    touching = [
        (i, count + j)
        for j, piece in enumerate(pieces)
        for i, solid in enumerate(solids)
        if count == 1 or (solid ^ piece).volume() > 0
    ]
    size = count + len(pieces)
    rows, columns = np.array(touching, dtype=int).reshape(-1, 2).T
    links = coo_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    groups, label = connected_components(links, directed=False)
    for group in range(groups):
        members = np.flatnonzero(label == group)
        cells = tuple(int(m) for m in members if m < count)
        if cells:
            yield cells, [pieces[int(m) - count] for m in members if m >= count]
