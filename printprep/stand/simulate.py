"""Let a part go on the bed and see whether it stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.mesh.measure import bodies
from printprep.stand.contact import contact_of, section_at_bed
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import scene_of
from printprep.types import Settled

if TYPE_CHECKING:
    from manifold3d import Manifold

# The judgement of Dang et al., "DensiCrafter", 2025: turned by less than this after ten seconds.
STANDS_BELOW_DEG = 20.0
SECONDS = 10.0


def simulate(
    part: Manifold, first_layer_mm: float, *, seconds: float = SECONDS, step_s: float = STEP_S
) -> Settled:
    """Let a part go on a level bed, and tell how far it has turned in the end.

    Parameters
    ----------
    part : sitting on the bed, hollow as it is; several bodies each fall by themselves.
    first_layer_mm : height of the first layer; what it stands on is the section at half of it.
    """
    each = [_settle(body, first_layer_mm, seconds, step_s) for body in bodies(part)]
    return max(each, key=lambda found: (not found.stands, found.rotation_deg))


def _settle(body: Manifold, first_layer_mm: float, seconds: float, step_s: float) -> Settled:
    motion = Motion(scene_of(body, first_layer_mm), step_s)
    motion.advance(round(seconds / step_s))
    rotation_deg = motion.rotation_deg
    # What touches the bed nowhere may balance on a point here; nobody prints that.
    grounded = contact_of(section_at_bed(body, first_layer_mm)) is not None
    return Settled(rotation_deg, grounded and rotation_deg < STANDS_BELOW_DEG, seconds)
