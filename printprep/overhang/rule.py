"""The slicer's overhang rule, layer by layer, on voids inside a part or on a whole part.

Notation: M the material of a layer, V a void in it, M₋ and V₋ those of the layer below, all
closed first (material closed by c is void opened by c, V ∘ c); ⊕ and ⊖ grow and shrink.  The
overhang of a layer is the part of M beyond M₋ ⊕ off.  Inside a cavity, whose wall is thicker than
off, growing the material is shrinking the void, so the outside does not matter:

    flagged = (V₋ ∘ c ⊖ off) − V ∘ c.

An island is a piece of M, enclosed by V, with no material at all under it.

Only the surroundings of suspects (suspects.py) are sliced.  Most layers there pass without any
opening: V ∘ c contains V ⊖ c, and V₋ ∘ c lies in V₋, so what is flagged lies in
(V₋ ⊖ off) − (V ⊖ c), which is empty wherever tan θ ≤ (off − c) / h.  Most other layers pass by
(V₋ ⊖ off) − V ∘ c, where V₋ is not opened yet.  The rest is computed exactly, in a small window.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from printprep.overhang.polygons import (
    LEAST_AREA_MM2,
    cells,
    centroid,
    closed,
    grown,
    new_pieces,
    regions,
    windows,
)
from printprep.overhang.suspects import Suspects

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from manifold3d import CrossSection, Manifold

    from printprep.arrays import Float
    from printprep.overhang.limits import Acceptance

# Slices are simplified by this much: a hundredth of off.
SIMPLIFY_MM = 0.002
# The margin of a window around a suspect; off, the opening and its arcs reach less far.
AROUND_MM = 0.5


@dataclass(frozen=True, eq=False)
class Flagged:
    """One patch of a layer with too little material under it.

    z_mm : underside of the layer;  outline_mm : contours (k, 2), the outer one counter-clockwise;
    at_mm : its centroid (x, y, z);  island : no material at all lies under it.
    """

    z_mm: float
    outline_mm: tuple[Float, ...]
    area_mm2: float
    at_mm: tuple[float, float, float]
    island: bool


@dataclass(frozen=True, eq=False)
class Unsupported:
    """All patches that a slicer would support, from the bed upward."""

    patches: tuple[Flagged, ...]

    @property
    def area_mm2(self) -> float:
        """Area of the patches that are not islands, summed over the layers."""
        return float(sum(patch.area_mm2 for patch in self.patches if not patch.island))

    @property
    def islands(self) -> int:
        """Number of islands."""
        return sum(patch.island for patch in self.patches)

    @property
    def worst(self) -> Flagged | None:
        """The largest island, or the largest patch where there is no island."""
        return max(self.patches, key=lambda patch: (patch.island, patch.area_mm2), default=None)


def unsupported_ceilings(
    cavity: Manifold,
    rule: Acceptance,
    phases: Sequence[float] = (0.0,),
    suspects: Suspects | None = None,
) -> Unsupported:
    """Ceilings of a cavity, and islands inside it, that a slicer would support.

    Parameters
    ----------
    cavity : the void, in printing position; the material around it is thicker than
        ``rule.off_mm``.
    phases : shares of a layer by which the layers are shifted up: another first layer, a raft.
    suspects : places to judge;  None for all that can be flagged.
    """
    if suspects is None:
        suspects = Suspects.of(cavity, rule)
    if not len(suspects):
        return Unsupported(())
    return Unsupported(tuple(p for phase in phases for p in _judged(cavity, rule, phase, suspects)))


def _judged(
    void: Manifold, rule: Acceptance, phase: float, suspects: Suspects
) -> Iterator[Flagged]:
    """The flagged patches of all layers, those that touch a suspect."""
    cut: tuple[float, CrossSection] | None = None
    for (under, _), (middle, bottom) in pairwise(_layers(void, rule, phase)):
        near = (suspects.low_mm[:, 2] <= middle) & (suspects.high_mm[:, 2] >= under)
        if not near.any():
            continue
        low, high = suspects.low_mm[near, :2], suspects.high_mm[near, :2]
        below = cut[1] if cut and cut[0] == under else void.slice(under)
        here = void.slice(middle)
        cut = middle, here
        if below.is_empty():
            continue
        window = cells(low - AROUND_MM, high + AROUND_MM)
        here, below = ((layer ^ window).simplify(SIMPLIFY_MM) for layer in (here, below))
        for patch in _ceilings(here, below, bottom, rule):
            if _touches(patch, low - rule.off_mm, high + rule.off_mm):
                yield patch


def _touches(patch: Flagged, low: Float, high: Float) -> bool:
    """Whether a patch meets any of the boxes; low, high : (n, 2) mm."""
    outline = np.concatenate(patch.outline_mm)
    met = (outline.min(axis=0) <= high).all(axis=1) & (outline.max(axis=0) >= low).all(axis=1)
    boxes = [np.stack([a, b]) for a, b in zip(low[met], high[met], strict=True)]
    return bool(boxes) and not (regions(patch.outline_mm) ^ windows(boxes, 0.0)).is_empty()


def unsupported_overhangs(part: Manifold, rule: Acceptance, phase: float = 0.0) -> Unsupported:
    """Overhangs of a whole part, inside and outside, above its first layer, that need support.

    This is the rule word by word, on material; :func:`unsupported_ceilings` is the fast form for
    voids, which tests compare with it.
    """
    patches: list[Flagged] = []
    below: CrossSection | None = None
    for middle, bottom in _layers(part, rule, phase):
        here = closed(part.slice(middle).simplify(SIMPLIFY_MM), rule.closing_mm)
        if below is not None:
            left = here - grown(below, rule.off_mm)
            islands = [piece for piece in here.decompose() if (piece ^ below).is_empty()]
            for island in islands:
                left = left - island
            patches.extend(_flagged(left, bottom, island=False))
            for island in islands:
                patches.extend(_flagged(island, bottom, island=True))
        below = here
    return Unsupported(tuple(patches))


def _layers(body: Manifold, rule: Acceptance, phase: float) -> Iterator[tuple[float, float]]:
    """(middle, underside) of the layers, from the first that cuts the body to one above it."""
    if body.is_empty():
        return
    box = body.bounding_box()
    first, height = rule.first_layer_mm, rule.layer_mm
    low = max(0, int(np.floor((box[2] - first) / height - phase)))
    high = int(np.ceil((box[5] - first) / height - phase)) + 1
    if box[2] < first * (1 + phase):
        yield first / 2 + phase * height, phase * height
    for layer in range(low, high + 1):
        bottom = first + (layer + phase) * height
        yield bottom + height / 2, bottom


def _ceilings(
    here: CrossSection, below: CrossSection, z_mm: float, rule: Acceptance
) -> Iterator[Flagged]:
    """Flagged patches of the layer with the void ``here``, over a layer with the void ``below``."""
    within, narrowed = grown(below, -rule.off_mm), grown(here, -rule.closing_mm)
    islands = new_pieces(here, below)
    suspect = within - narrowed
    if suspect.area() >= LEAST_AREA_MM2:
        suspect = within - grown(narrowed, rule.closing_mm)
    if suspect.area() < LEAST_AREA_MM2 and not islands:
        return
    window = windows([*suspect.to_polygons(), *islands], AROUND_MM)
    here, below = (closed(void ^ window, -rule.closing_mm) for void in (here, below))
    left = (grown(below, -rule.off_mm) - here) ^ suspect
    pieces = regions(new_pieces(here, below)) if islands else regions([])
    yield from _flagged(left - pieces, z_mm, island=False)
    yield from _flagged(pieces, z_mm, island=True)


def _flagged(region: CrossSection, z_mm: float, *, island: bool) -> Iterator[Flagged]:
    """The pieces of a region as patches."""
    for piece in region.decompose():
        outlines = piece.to_polygons()
        area, (x, y) = centroid(outlines)
        if area >= LEAST_AREA_MM2:
            yield Flagged(z_mm, tuple(outlines), area, (x, y, z_mm), island)
