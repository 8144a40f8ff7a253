"""Rule: pins and rods are at least as thick as the profile's minimum feature."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.check.wall_thickness import FACETED
from printprep.mesh.weld import connected
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile
    from printprep.thickness import Thin

# Less surface than this is a tip, which is meant to be thin.
LEAST_MM2 = 5.0
# Thin places in cubes of this size that touch belong to one pin.
LINK_MM = 2.0
# Material thinner than this is a sliver between surfaces that nearly coincide: nothing prints it.
SLIVER_MM = 0.02


@rule("min-feature")
def min_feature(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a pin or a rod that breaks off, or that a slicer leaves out.

    A place counts where it is thinner than the profile's minimum feature in both directions across.
    """
    limit = FACETED * profile.min_feature_mm
    thin = context.thin_below(FACETED * max(profile.min_feature_mm, profile.wall_mm))
    slender = (thin.thick_mm < limit) & (thin.wide_mm < profile.min_feature_mm)
    rods = thin.only(slender & (thin.thick_mm >= SLIVER_MM))
    pins = [pin for pin in _gathered(rods) if pin.total_mm2 >= LEAST_MM2]
    if not pins:
        return
    least, place = min(pin.thinnest for pin in pins)
    total_mm2 = sum(pin.total_mm2 for pin in pins)
    yield finding(
        "min-feature",
        f"A pin or rod is {least:.2f} mm thick; it should be {profile.min_feature_mm:g} mm "
        f"({total_mm2:.0f} mm² of surface).",
        "Make it thicker, or scale the model up (--size).",
        value=least,
        limit=profile.min_feature_mm,
        at_mm=place,
        area_mm2=total_mm2,
    )


def _gathered(places: Thin) -> list[Thin]:
    """The places in groups that are apart from each other: each is one pin, or one sliver."""
    from scipy.spatial import cKDTree

    if not len(places):
        return []
    cubes, index = np.unique(
        np.floor(places.middle / LINK_MM).astype(np.int64), axis=0, return_inverse=True
    )
    pairs = cKDTree(cubes).query_pairs(1.8, output_type="ndarray")  # √3: cubes that share a corner
    group = connected(pairs[:, 0], pairs[:, 1], len(cubes))[np.ravel(index)]
    return [places.only(group == number) for number in np.unique(group)]
