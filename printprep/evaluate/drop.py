"""Release a body of voxels on a bed and simulate it: the paper's test of what stands.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298: MuJoCo, a free body on a plane,
ten seconds in steps of a millisecond, inertia of the hollow body; it stands when its final rotation
is below 20°.  The convex hull of the voxels collides.  The object has the size of the paper's
numbers in metres: its longest side is 1 m.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.paper.voxel_balance import inertia, moments, support_polygon
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import Scene
from printprep.stand.simulate import SECONDS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float

MM = 1000.0  # longest side
_CUBE = np.stack(np.meshgrid(*[[0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


def final_rotation_deg(weight: Float, ground: int, *, seconds: float = SECONDS) -> float:
    """Final rotation of a body of voxels after its release on a level bed, in degrees.

    weight : (nx, ny, nz) densities;  ground : index of the layer that touches the bed.
    """
    motion = Motion(scene_of_voxels(weight, ground))
    motion.advance(round(seconds / STEP_S))
    return motion.rotation_deg


def scene_of_voxels(weight: Float, ground: int) -> Scene:
    """The scene of a body for the simulation: hull, centre, inertia, in radii of gyration.

    weight : (nx, ny, nz) densities;  ground : index of the layer that touches the bed.
    """
    pitch_mm = MM / max(weight.shape)
    mass, *first = moments(weight, ground)
    centre = np.array(first) / mass
    turning = inertia(weight, ground) / mass
    unit = float(np.sqrt(np.trace(turning) / 2))
    points = _hull(weight > 0, ground)
    return Scene(
        points=(points - centre) / unit,
        height=float(centre[2]) / unit,
        inertia=turning / unit**2,
        unit_mm=unit * pitch_mm,
        centre_mm=centre * pitch_mm,
    )


def _hull(material: NDArray[np.bool_], ground: int) -> Float:
    """(n, 3) voxels, corners of the convex hull; on the bed those of the support polygon.

    material : (nx, ny, nz) bool.
    """
    from scipy.spatial import ConvexHull

    # Only the ends of vertical lines can be corners.
    columns = np.argwhere(material.any(axis=2))
    lines = material[tuple(columns.T)]
    low = lines.argmax(axis=1)
    high = material.shape[2] - 1 - lines[:, ::-1].argmax(axis=1)
    ends = np.concatenate([np.column_stack([columns, low]), np.column_stack([columns, high])])
    nx, ny, _ = material.shape
    corners = (ends[:, None] + _CUBE).reshape(-1, 3) - np.array([nx / 2, ny / 2, ground])
    corners = np.unique(corners, axis=0)
    outermost = corners[ConvexHull(corners).vertices]
    polygon = support_polygon(material[:, :, ground])
    foot = np.column_stack([polygon, np.zeros(len(polygon))])
    return np.concatenate([foot, outermost[outermost[:, 2] > 0]])
