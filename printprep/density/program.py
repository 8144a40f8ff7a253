"""Choose the base that makes a part lightest, and solve one plane for each of its bodies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from printprep.cavity.base import Feet, base_of, feet_of, slab_of
from printprep.density.fillings import Fillings
from printprep.density.lean import LeanSolution, solve_lean
from printprep.grid.domain import reweighed
from printprep.mesh.measure import bodies, volume_and_centre
from printprep.stand.contact import contact_of, section_at_bed
from printprep.types import Base, Lean

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Float
    from printprep.grid.domain import Interior
    from printprep.profiles import Profile


BasePolicy = Literal["auto", "never", "always"]

# The search tries growth in these steps, then half steps around the best: mass is flat there.
GROWTH_STEP_MM = 0.5
# A larger base is a plinth to design, not one to grow.
MOST_GROWTH_MM = 30.0
# Two bases tie within this share of the mass, and the simpler one wins.
TIE = 1e-6


@dataclass(frozen=True, eq=False)
class BodySolution:
    """The solution for what stands apart: one body of the solid, or several that a base joins.

    cells : indices of the solid's bodies;  voxels : (n,) indices among the free voxels;
    solution : None without contact with the bed;  moments : (4,) mm³ and mm⁴, at unit density.
    """

    cells: tuple[int, ...]
    voxels: NDArray[np.intp]
    solution: LeanSolution | None
    moments: Float

    @property
    def reached(self) -> float:
        """Largest lean it reaches, in degrees; +inf when it reaches the lean asked for."""
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
        """Largest lean its weakest body reaches, in degrees; +inf when all stand as asked."""
        return min(part.reached for part in self.parts)


class Program:
    """The linear programs of one solid, for any base and any lean.

    moments : for each body, (4,) mm³ and mm⁴, with all its voxels filled.
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
        self._known: dict[tuple[int, ...], tuple[NDArray[np.intp], Fillings]] = {}
        self._slab = slab_of(solid, profile.stability.base_seat_mm)
        self._feet: Feet | None = None

    def choose(self, policy: BasePolicy, lean: Lean) -> Choice:
        """Choose the base of least total mass that reaches the lean; no base on a tie.

        When no base reaches the lean, the one that reaches farthest.
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
        # "always" on a solid whose feet are flat and cannot grow adds nothing.
        return best if best is not None else self.solve(None, lean, margin)

    def solve(self, base: Base | None, lean: Lean, margin_deg: float) -> Choice:
        """Solve the lightest filling of every body for one base."""
        volume, bound = 0.0, 0.0
        parts = []
        for cells, section, fixed in self.bodies_on_base(base):
            voxels, fillings = self._fillings(cells)
            fixed = fixed - fillings.moments.sum(axis=1)
            contact = contact_of(section)
            if contact is None:
                parts.append(BodySolution(cells, voxels, None, fixed))
                volume, bound = volume + fixed[0], bound + fixed[0]
                continue
            footing = contact.footing.toward(lean.azimuth_deg)
            solution = solve_lean(fillings, fixed, footing, lean.angle_deg, margin_deg)
            parts.append(BodySolution(cells, voxels, solution, solution.filling.moments))
            volume += float(solution.filling.moments[0])
            bound += solution.filling.bound
        return Choice(base, tuple(parts), volume, bound)

    def drilled(self, bores: Manifold, hollowable_volume: Manifold) -> Program:
        """The program of the same solid with holes in it.

        bores : what the holes remove from the solid and from the hollowable volume.
        """
        interior = reweighed(self.interior, hollowable_volume - bores)
        return Program(self.solid - bores, interior, self.profile)

    def weighing(self, moments: Sequence[Float]) -> Program:
        """The same programs for bodies of other masses.

        moments : for each body, (4,) mm³ and mm⁴, with all its voxels filled.
        """
        other = copy(self)
        other.moments = list(moments)
        return other

    def unfilled(self, base: Base | None) -> Float:
        """(k, 4) mm³ and mm⁴, moments of the bodies on a base with none of their voxels filled."""
        return np.stack(
            [
                moments - self._fillings(cells)[1].moments.sum(axis=1)
                for cells, _, moments in self.bodies_on_base(base)
            ]
        )

    def growth_that_reaches(self, lean: Lean) -> float | None:
        """Least growth of the base that reaches a lean, in steps of 0.5 mm up to 30 mm, or None."""
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
        """The solid's feet, found at the first use."""
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
        """Whether the bare shell with this base, and so any wider base, outweighs the best."""
        shell = sum(moments[0] for moments in self.moments) - self.interior.moments[0].sum()
        return bool(shell + (base.manifold - self._slab).volume() > best.volume_mm3)

    def _around(self, growth_mm: float) -> Iterator[float]:
        for growth in (growth_mm - GROWTH_STEP_MM / 2, growth_mm + GROWTH_STEP_MM / 2):
            if 0 < growth <= self.profile.stability.base_growth_max_mm:
                yield growth

    def _cannot_be_beaten(self, choice: Choice) -> bool:
        """Whether the choice stands with nothing filled: any base only adds mass."""
        return choice.reached == np.inf and all(
            part.solution is not None and part.solution.plane is None for part in choice.parts
        )

    def bodies_on_base(
        self, base: Base | None
    ) -> Iterator[tuple[tuple[int, ...], CrossSection, Float]]:
        """What stands apart on a base: the solid's bodies in it, its section, its moments (4,)."""
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
                moments = moments + _moments(piece - self._slab)
            yield cells, section, moments

    def _fillings(self, numbers: tuple[int, ...]) -> tuple[NDArray[np.intp], Fillings]:
        """The free voxels (n,) of bodies, by index, and their fillings."""
        if numbers not in self._known:
            moments = self.interior.moments
            if len(numbers) == len(self.bodies):
                voxels = np.arange(moments.shape[1])
            else:
                voxels = np.flatnonzero(np.isin(self._body_of_voxel, numbers))
                moments = moments[:, voxels]
            self._known[numbers] = voxels, Fillings(moments)
        return self._known[numbers]


def _better(first: Choice | None, second: Choice) -> Choice:
    """The lighter of two choices that stand, else the one that reaches farther; first on a tie."""
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
    volume_mm3, centre_mm = volume_and_centre(manifold)
    return volume_mm3 * np.array([1.0, *centre_mm])


def _joined(
    solids: Sequence[Manifold], pieces: Sequence[Manifold]
) -> Iterator[tuple[tuple[int, ...], list[Manifold]]]:
    """Group the bodies that pieces of a base join; each group with its pieces."""
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
