"""Rule: the support blocker covers the ceilings of cavities, and nothing outside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.check.context import CheckContext
    from printprep.overhang.rule import Flagged
    from printprep.profiles import Profile

# Less than this, over all layers, is a few specks that no slicer supports.
AREA_MM2 = 0.5
# A blocker that comes so near to the outside of a part may cover an overhang there; simplification
# and rounding of the outside stay below it.
SLACK_MM = 0.02
# More air in a blocker than this, beside sealed cavities, is an open cavity or the outside.
OPEN_MM3 = 0.5


@rule("support-blocker")
def support_blocker(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents supports inside, where the blocker is too small, and sagging outside, where it is
    too large.

    Ceilings that the slicer supports must lie in the blocker, layer by layer.  Overhangs outside
    lie no deeper in the part than a layer, so the blocker must lie deeper.  A cavity with drain
    holes is open to the outside: of a blocker around one, only the bounds are judged.
    """
    if context.blocker is None or not profile.traits.ceilings_sag:
        return
    from printprep.supports.blocker import tallest_step_mm

    bare = _uncovered(context, profile)
    if bare:
        area_mm2 = sum(patch.area_mm2 for patch in bare)
        yield finding(
            "support-blocker",
            f"The support blocker leaves {area_mm2:.1f} mm² of cavity ceilings uncovered: a slicer "
            "with supports on prints supports there, which stay inside.",
            "Hollow the model again, or slice without supports.",
            value=area_mm2,
            limit=AREA_MM2,
            at_mm=max(bare, key=lambda patch: patch.area_mm2).at_mm,
        )
    least_mm, at_mm = _least_depth_mm(context)
    if least_mm < tallest_step_mm(profile) - SLACK_MM:
        yield finding(
            "support-blocker",
            "The support blocker reaches the outside of the part: a slicer makes no supports under "
            "overhangs there.",
            "Hollow the model again.",
            at_mm=at_mm,
        )


def _least_depth_mm(context: CheckContext) -> tuple[float, tuple[float, float, float] | None]:
    """How deep the blocker lies below the outside, and where it comes nearest, as far as known."""
    from printprep.supports.blocker import depth_mm

    assert context.blocker is not None
    if (context.blocker - context.outside).volume() < OPEN_MM3:
        return depth_mm(context.blocker, context.outside)
    own, whole = (np.reshape(m.bounding_box(), (2, 3)) for m in (context.blocker, context.part))
    return float(min((own[0] - whole[0]).min(), (whole[1] - own[1]).min())), None


def _uncovered(context: CheckContext, profile: Profile) -> list[Flagged]:
    """The patches of ceiling that the slicer supports in spite of the blocker; [] for specks."""
    from printprep.check.walls import united
    from printprep.overhang.limits import slicer_acceptance
    from printprep.overhang.polygons import regions
    from printprep.overhang.rule import unsupported_ceilings
    from printprep.supports.blocker import tallest_step_mm

    assert context.blocker is not None
    if not context.cavities:
        return []
    cavities: Manifold = united(context.cavities)
    # All that the slicer can support lies in the cavities raised by a layer.
    if (cavities.translate((0.0, 0.0, tallest_step_mm(profile))) - context.blocker).is_empty():
        return []
    accepted = slicer_acceptance(profile)
    bare = [
        patch
        for patch in unsupported_ceilings(cavities, accepted).patches
        if not (
            regions(patch.outline_mm) - context.blocker.slice(patch.z_mm + accepted.layer_mm / 2)
        ).is_empty()
    ]
    return bare if sum(patch.area_mm2 for patch in bare) > AREA_MM2 else []
