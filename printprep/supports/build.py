"""Vault a hollowable volume: carry every ceiling of it from inside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies, together
from printprep.mesh.short_edges import contract_short_edges
from printprep.overhang.rule import Unsupported, unsupported_ceilings
from printprep.supports.capitals import Capitals, cover
from printprep.supports.carry_flagged import PHASES, carry_flagged
from printprep.supports.ceiling import ceiling_samples, spacing_of
from printprep.supports.column_feet import set_feet
from printprep.supports.column_forest import Forest
from printprep.supports.columns import raise_columns
from printprep.supports.distance_to_footing import DistanceToFooting
from printprep.supports.inside_lookup import LOOKUP_MM, InsideLookup
from printprep.supports.member_sizes import MemberSizes, built_for, slope_deg
from printprep.supports.solids import Frustum, columns, funnels, united

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.profiles import Profile
    from printprep.types import VaultRule

# Simplifying the cavity may move faces by so much: a fiftieth of the slicer's off.
SIMPLIFY_MM = 0.003
# Shorter edges of the finished cavity are contracted.
SHORT_MM = 0.002


@dataclass(frozen=True, eq=False)
class Vaults:
    """The vaults of a hollowable volume, and the cavity they leave.

    cavity : the hollowable volume without the vaults.
    samples, capitals, columns : how many;  added_mm3 : volume of the vaults.
    thinnest_mm : least thickness of any of them, across its axis.
    unsupported_mm2, islands : what the rule, with the reserve, still flags, over all phases.  Short
        edges are contracted after that, which moves corners by less than the reserve.
    """

    cavity: Manifold
    samples: int
    capitals: int
    columns: int
    added_mm3: float
    thinnest_mm: float | None
    unsupported_mm2: float
    islands: int


def vaulted(hollowable_volume: Manifold, profile: Profile, built: VaultRule) -> Vaults:
    """Carry every ceiling of a hollowable volume with solids inside it.

    Parameters
    ----------
    hollowable_volume : all that may be cavity, in printing position, with thick walls around it.
    profile : an fdm profile: layers, lines, least feature.
    built : the overhang rule that the vaults keep.

    Raises UsageError for a profile without a nozzle, GeometryError for vast ceilings.
    """
    rule = built_for(profile, built)
    members = MemberSizes.of(profile, rule)
    theta_deg = slope_deg(rule, profile.overhang_deg)
    spacing_mm = spacing_of(hollowable_volume, theta_deg)
    samples = ceiling_samples(hollowable_volume, theta_deg, spacing_mm)
    capitals, forest = _raised(samples, spacing_mm, hollowable_volume, members)
    wide, narrow = funnels(capitals, members), columns(forest, members)
    cavity = _without(hollowable_volume, wide + narrow).simplify(SIMPLIFY_MM)
    cavity = without_small_pieces(cavity, members.thickness_mm)
    flagged = unsupported_ceilings(cavity, rule, PHASES).patches
    under, props, flagged = carry_flagged(cavity, flagged, rule, members, capitals, forest)
    wide, narrow = wide + under, narrow + props
    if wide:
        cavity = contract_short_edges(_without(cavity, under + props), SHORT_MM)
        cavity = without_small_pieces(cavity, members.thickness_mm)
    left = Unsupported(flagged)
    return Vaults(
        cavity=cavity,
        samples=len(samples),
        capitals=len(wide),
        columns=len(narrow),
        added_mm3=float(hollowable_volume.volume() - cavity.volume()),
        thinnest_mm=min((piece.across_mm for piece in wide + narrow), default=None),
        unsupported_mm2=left.area_mm2,
        islands=left.islands,
    )


def _raised(
    samples: Float, spacing_mm: float, hollowable_volume: Manifold, members: MemberSizes
) -> tuple[Capitals, Forest]:
    """Capitals for all samples (n, 3) mm, and the columns under them."""
    forest = Forest()
    if len(samples) == 0:
        return Capitals.none(), forest
    lookup = InsideLookup.of(hollowable_volume, LOOKUP_MM)
    capitals = cover(samples, members, spacing_mm**2, lookup)
    footings = DistanceToFooting.of(lookup, members, float(capitals.node_mm[:, 2].max()))
    raise_columns(capitals.node_mm, lookup, footings, members, forest)
    set_feet(forest, lookup, members)
    return capitals, forest


def _without(hollowable_volume: Manifold, pieces: Sequence[Frustum]) -> Manifold:
    """The hollowable volume minus the pieces built in it."""
    if not pieces:
        return hollowable_volume
    # As one original surface: the kernel keeps edges between surfaces of different origin.
    return (hollowable_volume - united(pieces)).as_original()


def without_small_pieces(cavity: Manifold, thickness_mm: float) -> Manifold:
    """Drop the pieces of a cavity smaller than a ball of the least feature: they print solid."""
    from manifold3d import Manifold

    least = np.pi / 6 * thickness_mm**3
    pieces = bodies(cavity)
    kept = [piece for piece in pieces if piece.volume() >= least]
    if len(kept) == len(pieces):
        return cavity
    if len(kept) == 1:
        return kept[0]
    return together(kept) if kept else Manifold()
