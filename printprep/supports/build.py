"""From a room for cavities to one whose every ceiling is carried from inside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies, together
from printprep.mesh.short_edges import contract_short_edges
from printprep.overhang.rule import Unsupported, unsupported_ceilings
from printprep.supports.capitals import Capitals, cover
from printprep.supports.ceiling import SPACING_MM, ceiling_samples
from printprep.supports.columns import raise_columns
from printprep.supports.dexels import DEXEL_MM, Dexels
from printprep.supports.distance_to_footing import DistanceToFooting
from printprep.supports.feet import set_feet
from printprep.supports.forest import Forest
from printprep.supports.members import Members, built_for, slope_deg
from printprep.supports.mend import PHASES, mended
from printprep.supports.solids import Frustum, columns, funnels, united

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.profiles import Profile

# Faces may move so much when the cavity is simplified: a fiftieth of the slicer's off.
SIMPLIFY_MM = 0.003
# Edges shorter than this are contracted once it is finished.
SHORT_MM = 0.002


@dataclass(frozen=True, eq=False)
class Vaults:
    """What it takes to print a room without support.

    cavity : the room without the vaults.
    samples, capitals, columns : how many;  added_mm3 : volume of the vaults.
    thinnest_mm : least thickness of any of them, across its axis.
    unsupported_mm2, islands : what the rule, with the reserve, still flags, over all phases, before
        short edges are contracted, which moves corners by less than the reserve.
    """

    cavity: Manifold
    samples: int
    capitals: int
    columns: int
    added_mm3: float
    thinnest_mm: float | None
    unsupported_mm2: float
    islands: int


def vaulted(hollowable_volume: Manifold, profile: Profile) -> Vaults:
    """Carry every ceiling of a room by solids inside it.

    Parameters
    ----------
    hollowable_volume : what may be cavity, in printing position; thick walls around it.
    profile : an fdm profile: layers, lines, least feature.

    Raises UsageError for a profile without a nozzle.
    """
    members, rule = Members.of(profile), built_for(profile)
    samples = ceiling_samples(hollowable_volume, slope_deg(profile))
    capitals, forest = _raised(samples, hollowable_volume, members)
    wide, narrow = funnels(capitals, members), columns(forest, members)
    cavity = _without(hollowable_volume, wide + narrow).simplify(SIMPLIFY_MM)
    cavity = roomy(cavity, members.thickness_mm)
    flagged = unsupported_ceilings(cavity, rule, PHASES).patches
    under, props, flagged = mended(cavity, flagged, rule, members, capitals, forest)
    wide, narrow = wide + under, narrow + props
    if wide:
        cavity = contract_short_edges(_without(cavity, under + props), SHORT_MM)
        cavity = roomy(cavity, members.thickness_mm)
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
    samples: Float, hollowable_volume: Manifold, members: Members
) -> tuple[Capitals, Forest]:
    """Capitals for all samples (n, 3), and the columns under them."""
    forest = Forest()
    if len(samples) == 0:
        return Capitals.none(), forest
    dexels = Dexels.of(hollowable_volume, DEXEL_MM)
    capitals = cover(samples, members, SPACING_MM**2, dexels)
    landings = DistanceToFooting.of(dexels, members, float(capitals.node_mm[:, 2].max()))
    raise_columns(capitals.node_mm, dexels, landings, members, forest)
    set_feet(forest, dexels, members)
    return capitals, forest


def _without(hollowable_volume: Manifold, pieces: Sequence[Frustum]) -> Manifold:
    """The room less what is built in it."""
    if not pieces:
        return hollowable_volume
    # As one surface of its own: the kernel leaves edges between those of several.
    return (hollowable_volume - united(pieces)).as_original()


def roomy(cavity: Manifold, thickness_mm: float) -> Manifold:
    """The cavity without pieces smaller than a ball of the least feature: those print solid."""
    from manifold3d import Manifold

    least = np.pi / 6 * thickness_mm**3
    pieces = bodies(cavity)
    kept = [piece for piece in pieces if piece.volume() >= least]
    if len(kept) == len(pieces):
        return cavity
    if len(kept) == 1:
        return kept[0]
    return together(kept) if kept else Manifold()
