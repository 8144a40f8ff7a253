"""What the rules look at: a part from any source, separated into outside and cavities."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from printprep.check.walls import Enclosed, Wall, united, wall_min_mm
from printprep.kept import Once
from printprep.mesh.measure import innermost, shells
from printprep.types import NO_VOIDS, Advice, Drainage, Lean, Model, ModelVoids, Repair, Stability

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.drainage.trapped import Chamber, Clearance, Cup, Pocket
    from printprep.mesh.self_intersections import SelfIntersections
    from printprep.thickness import Thin


@dataclass(frozen=True, eq=False)
class CheckContext:
    """The part to check, on the bed, z up, in mm.

    part : the whole part as it is or will be written (float32 coordinates, ``quantized``).
    outside : what the outermost shells enclose.
    cavities : positive solids that are sealed, disjoint from the material.
    stability : how the part stands;  lean : the lean at which it should stand.
    repair : how the file was made into a solid.
    hollowed : True for a part that printprep made, False for a file as it came.
    infilled : True for a part that printprep made for the slicer's infill: it has no cavity.
    reachable_deg : the largest lean any filling reaches, None where the requested lean is feasible.
    advice : what would make the lean feasible; it comes with ``reachable_deg``.
    drainage : how the part drains, None where no drains were requested.
    blocker : where the file forbids a slicer's supports, None if it does not.
    raw : the triangles of the file, as read and placed or as they will be written.
    voids : what became of the voids that the model brought.
    drained : cavities that printprep made and that drain holes open.
    walls : solids with cavities, between which the wall is measured; none for ``outside`` with
    ``cavities``.

    What several rules need is measured once.
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
    blocker: Manifold | None = None
    raw: Model | None = None
    voids: ModelVoids = NO_VOIDS
    drained: tuple[Manifold, ...] = ()
    walls: tuple[Enclosed, ...] = ()
    _measured: Once = field(default_factory=Once, init=False, repr=False)

    @property
    def size_mm(self) -> tuple[float, float, float]:
        """Extents along x, y, z in mm."""
        x0, y0, z0, x1, y1, z1 = self.part.bounding_box()
        return x1 - x0, y1 - y0, z1 - z0

    @property
    def solids(self) -> tuple[Manifold, ...]:
        """All solids that rules look at."""
        walled = [solid for pair in self.walls for solid in (pair.outside, *pair.cavities)]
        blocker = () if self.blocker is None else (self.blocker,)
        own = (self.part, self.outside, *self.cavities, *self.drained)
        return (*own, *blocker, *walled)

    @property
    def wall(self) -> Wall | None:
        """The thinnest wall between cavities and outside, None without a cavity."""
        return self._measured.get("wall", self._wall)

    def _wall(self) -> Wall | None:
        found = [wall_min_mm(pair) for pair in self.walls or (self,)]
        return min((wall for wall in found if wall is not None), default=None)

    @property
    def self_intersections(self) -> SelfIntersections | None:
        """Where the triangles of the file intersect each other, None if they do not."""
        return self._measured.get("self-intersections", self._self_intersections)

    def _self_intersections(self) -> SelfIntersections | None:
        from printprep.mesh.self_intersections import self_intersections
        from printprep.mesh.weld import in_order, unique_rows

        if self.raw is None:
            return None
        # In one order, whoever wrote the file: what barely touches is judged alike
        vertices, index = unique_rows(self.raw.vertices)
        found = self_intersections(vertices, in_order(index[self.raw.faces]))
        return found if len(found.edge) else None

    def thin_below(self, limit_mm: float) -> Thin:
        """Where the material is thinner than a limit."""
        from printprep.thickness import thin_places

        return self._measured.get(("thin", limit_mm), lambda: thin_places(self.part, limit_mm))

    def narrow_below(self, limit_mm: float) -> Thin:
        """Where the space outside the part is narrower than a limit."""
        from printprep.thickness import gap_places

        return self._measured.get(("narrow", limit_mm), lambda: gap_places(self.outside, limit_mm))

    def pockets(self, diameter_mm: float) -> tuple[Pocket, ...]:
        """The spaces that a ball of this diameter cannot leave."""
        from printprep.drainage.trapped import trapped

        return self._measured.get(
            ("pockets", diameter_mm),
            lambda: trapped(self.part, diameter_mm, space=self._clearance(diameter_mm)),
        )

    def chambers(self, diameter_mm: float) -> tuple[Chamber, ...]:
        """The enclosed spaces with ways out, on the grid for holes of this diameter."""
        from printprep.drainage.trapped import chambers

        return self._measured.get(
            ("chambers", diameter_mm),
            lambda: chambers(self.part, diameter_mm, space=self._clearance(diameter_mm)),
        )

    def _clearance(self, diameter_mm: float) -> Clearance | None:
        """Where a ball of this diameter may go; None for an empty part."""
        from printprep.drainage.trapped import pour_clearance

        if self.part.is_empty():
            return None
        return self._measured.get(
            ("clearance", diameter_mm), lambda: pour_clearance(self.part, diameter_mm)
        )

    @property
    def cups(self) -> tuple[Cup, ...]:
        """The suction cups that form while the part prints."""
        from printprep.drainage.trapped import suction_cups

        return self._measured.get("cups", lambda: suction_cups(self.part))


def separated(part: Manifold) -> tuple[Manifold, tuple[Manifold, ...]]:
    """The solid inside a part's outermost shells, and its sealed cavities.

    A loose body inside a cavity belongs to neither; its volume is subtracted from the cavity.
    """
    solids, voids = shells(part)
    if not voids:
        return part, ()
    outer, rest = [], list(voids)
    for solid in solids:
        around = innermost(solid, voids)
        if around is None:
            outer.append(solid)
        else:
            rest[around] = rest[around] - solid
    return united(outer), tuple(rest)


def context_of_solid(
    part: Manifold,
    stability: Stability,
    lean: Lean,
    repair: Repair,
    raw: Model | None = None,
    blocker: Manifold | None = None,
) -> CheckContext:
    """Any solid, ready to check: shells of negative volume bound cavities, the rest is outside."""
    outside, cavities = separated(part)
    return CheckContext(
        part=part,
        outside=outside,
        cavities=cavities,
        stability=stability,
        lean=lean,
        repair=repair,
        hollowed=False,
        raw=raw,
        blocker=blocker,
    )
