"""The balance of a body of voxels: its moments, its support polygon, its tilt angle.

Lengths are voxels; x and y are measured from the middle of the grid and z from the bottom of the
ground layer, so the bed is z = 0.  All figures are exact for cubes of even density.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.stand.contact import Contact
from printprep.stand.footing import Footing

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int


# (4, 2) the corners of a voxel's bottom, from its centre.
_SQUARE = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])


def moment_columns(voxels: Int, shape: tuple[int, int, int], ground: int) -> Float:
    """(4, n) what each voxel of unit density adds to (M, M c_x, M c_y, M c_z).

    voxels : (n, 3) x, y, z indices;  shape : of the grid;  ground : index of the lowest layer.
    """
    return np.vstack([np.ones(len(voxels)), _centres(voxels, shape, ground).T])


def moments(weight: Float, ground: int) -> Float:
    """(4,) M and M c of a grid of densities.

    weight : (nx, ny, nz);  ground : index of the lowest layer.
    """
    voxels = np.argwhere(weight > 0)
    nx, ny, nz = weight.shape
    columns = moment_columns(voxels, (nx, ny, nz), ground)
    result: Float = np.einsum("kn,n->k", columns, weight[tuple(voxels.T)])
    return result


def inertia(weight: Float, ground: int) -> Float:
    """(3, 3) inertia about the centre of mass, each voxel a cube of even density (a sixth about
    itself).

    weight : (nx, ny, nz);  ground : index of the lowest layer.
    """
    voxels = np.argwhere(weight > 0)
    nx, ny, nz = weight.shape
    density = weight[tuple(voxels.T)]
    points = _centres(voxels, (nx, ny, nz), ground)
    mass = density.sum()
    offset = points - density @ points / mass
    second = np.einsum("n,ni,nj->ij", density, offset, offset) + np.eye(3) * mass / 12
    result: Float = np.trace(second) * np.eye(3) - second
    return result


def support_polygon(layer: Bool) -> Float:
    """(k, 2) convex hull, counter-clockwise, of the squares of a layer's voxels.

    layer : (nx, ny) bool, the voxels that touch the bed, at least one.
    """
    from scipy.spatial import ConvexHull

    middle = (np.array(layer.shape) - 1) / 2
    corners = (np.argwhere(layer)[:, None] - middle + _SQUARE).reshape(-1, 2)
    hull: Float = corners[ConvexHull(corners).vertices]
    return hull


def footing(layer: Bool) -> Footing:
    """The support polygon's edges, in voxels although the type says millimetres.

    layer : (nx, ny) bool, the voxels that touch the bed, at least one.
    """
    return Contact(support_polygon(layer), float(np.count_nonzero(layer))).footing


def tilt_deg(weight: Float, ground: int) -> float:
    """The lean at which a body of voxels tips over; negative when it falls even upright.

    weight : (nx, ny, nz) densities; all of the ground layer touches the bed.
    """
    return tilt_on(footing(weight[:, :, ground] > 0), moments(weight, ground))


def tilt_on(foot: Footing, total: Float) -> float:
    """The lean at which a body with moments (4,) tips over on a footing."""
    return float(np.degrees(np.arctan(foot.tangent(total))))


def _centres(voxels: Int, shape: tuple[int, int, int], ground: int) -> Float:
    """(n, 3) centres of voxels (n, 3)."""
    nx, ny, _ = shape
    result: Float = voxels - np.array([(nx - 1) / 2, (ny - 1) / 2, ground - 0.5])
    return result
