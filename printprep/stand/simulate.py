"""Simulates a part that is released on the level bed: does it stand?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.mesh.measure import bodies
from printprep.stand.contact import contact_of, section_at_bed
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import scene_of
from printprep.types import Settled

if TYPE_CHECKING:
    from manifold3d import Manifold

# The criterion of Dang et al., "DensiCrafter", 2025: turned by less than this after ten seconds.
STANDS_BELOW_DEG = 20.0
SECONDS = 10.0


def simulate(
    part: Manifold, first_layer_mm: float, *, seconds: float = SECONDS, step_s: float = STEP_S
) -> Settled:
    """Release a part on the level bed, and measure how far it has turned at the end.

    Parameters
    ----------
    part : on the bed, with its cavities; each body falls by itself, and the worst one counts.
    first_layer_mm : height of the first layer; the part stands on the section at half of it.
    """
    each = [_settle(body, first_layer_mm, seconds, step_s) for body in bodies(part)]
    return max(each, key=lambda found: (not found.stands, found.rotation_deg))


def _settle(body: Manifold, first_layer_mm: float, seconds: float, step_s: float) -> Settled:
    motion = Motion(scene_of(body, first_layer_mm), step_s)
    motion.advance(round(seconds / step_s))
    rotation_deg = motion.rotation_deg
    # A body without contact may balance on a point here, but it cannot be printed.
    grounded = contact_of(section_at_bed(body, first_layer_mm)) is not None
    return Settled(rotation_deg, grounded and rotation_deg < STANDS_BELOW_DEG, seconds)
