"""What the rules look at: a part, whoever made it, taken apart into outside and cavities."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from printprep.check.walls import Wall, united, wall_min_mm
from printprep.mesh.measure import innermost, shells
from printprep.types import Advice, Drainage, Lean, Model, Repair, Stability

if TYPE_CHECKING:
    from collections.abc import Callable

    from manifold3d import Manifold

    from printprep.drainage.trapped import Cup, Pocket
    from printprep.mesh.self_intersections import SelfIntersections
    from printprep.thickness import Thin

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class CheckContext:
    """A part under examination, on the bed, z up, in mm.

    part : the whole part as it is or will be written (float32 coordinates, ``quantized``).
    outside : what walls are measured to: for a part of ours the model with its base and the voids
    it already had, for a file its outer shells.
    cavities : positive solids, disjoint from the material.
    stability : how it stands;  lean : what it is asked to stand.
    repair : what it took to make a solid of the file.
    hollowed : True for a part of ours, False for a file as it came.
    infilled : True for a part of ours whose inside is the slicer's infill, and has no cavity.
    reachable_deg : the largest lean any filling reaches, None where the lean asked for is feasible.
    advice : what would make it feasible, with ``reachable_deg``.
    drainage : how it drains, None where no drains were asked for.
    raw : a file's own triangles, as they were read and placed; None for a part of ours.

    What several rules ask for is measured once.
    """

    part: Manifold
    outside: Manifold
    cavities: tuple[Manifold, ...]
    stability: Stability
    lean: Lean
    repair: Repair
    hollowed: bool
    infilled: bool = False
    reachable_deg: float | None = None
    advice: Advice | None = None
    drainage: Drainage | None = None
    raw: Model | None = None

    @property
    def size_mm(self) -> tuple[float, float, float]:
        """Extents along x, y, z."""
        x0, y0, z0, x1, y1, z1 = self.part.bounding_box()
        return x1 - x0, y1 - y0, z1 - z0

    @cached_property
    def wall(self) -> Wall | None:
        """The thinnest wall between cavities and outside, None without a cavity; measured once."""
        return wall_min_mm(self)

    @cached_property
    def self_intersections(self) -> SelfIntersections | None:
        """Where the file's own triangles pass through each other, None where they do not."""
        from printprep.mesh.self_intersections import self_intersections

        found = None if self.raw is None else self_intersections(self.raw.vertices, self.raw.faces)
        return found if found is not None and len(found.edge) else None

    def thin_below(self, limit_mm: float) -> Thin:
        """Where its material is thinner than a limit."""
        from printprep.thickness import thin_places

        return self._kept("thin", limit_mm, lambda: thin_places(self.part, limit_mm))

    def narrow_below(self, limit_mm: float) -> Thin:
        """Where the space outside its material is narrower than a limit."""
        from printprep.thickness import gap_places

        return self._kept("narrow", limit_mm, lambda: gap_places(self.outside, limit_mm))

    def pockets(self, diameter_mm: float) -> tuple[Pocket, ...]:
        """What a ball of this diameter cannot leave."""
        from printprep.drainage.trapped import trapped

        return self._kept("pockets", diameter_mm, lambda: trapped(self.part, diameter_mm))

    @cached_property
    def cups(self) -> tuple[Cup, ...]:
        """What is shut toward the plate while it prints."""
        from printprep.drainage.trapped import suction_cups

        return suction_cups(self.part)

    def _kept(self, what: str, limit_mm: float, measure: Callable[[], T]) -> T:
        key = (what, limit_mm)
        if key not in self._measured:
            self._measured[key] = measure()
        kept: T = self._measured[key]
        return kept

    @cached_property
    def _measured(self) -> dict[tuple[str, float], Any]:
        return {}


def context_of_solid(
    part: Manifold, stability: Stability, lean: Lean, repair: Repair, raw: Model | None = None
) -> CheckContext:
    """Any solid as a subject: its shells of negative volume bound cavities, the rest is outside.

    A loose piece inside a cavity is part of neither: it takes room from the cavity it lies in.
    """
    solids, voids = shells(part)
    outer, rest = [], list(voids)
    for solid in solids:
        around = innermost(solid, voids)
        if around is None:
            outer.append(solid)
        else:
            rest[around] = rest[around] - solid
    return CheckContext(
        part=part,
        outside=united(outer),
        cavities=tuple(rest),
        stability=stability,
        lean=lean,
        repair=repair,
        hollowed=False,
        raw=raw,
    )
