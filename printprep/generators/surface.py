"""The surface of a set of voxels as triangles, in the generator's frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from printprep.arrays import Float, Int


@dataclass(frozen=True, eq=False)
class VoxelSurface:
    """A closed surface, counter-clockwise seen from outside; empty arrays around no voxels.

    vertices : (v, 3) float64 in [-0.5, 0.5]³, axis order x, y, z, z up unless turned y up.
    faces : (f, 3) int64.
    """

    vertices: Float
    faces: Int

    def turned_y_up(self) -> VoxelSurface:
        """The surface in the frame of the generator's exported files: (x, y, z) → (x, z, −y)."""
        x, y, z = self.vertices.T
        return VoxelSurface(np.stack((x, z, -y), axis=1), self.faces)


LEVEL = 0.501
"""Just above one half: at one half a face with diagonal voxels is a tie, which its two cells may
decide differently, and so leave a hole.  Above one half diagonal voxels do not join, so cavities
that share only an edge stay apart."""


def surface_of(voxels: NDArray[np.bool_]) -> VoxelSurface:
    """The surface of voxels, by marching cubes between voxel centres.

    Source: Lewiner et al., 2003, DOI 10.1080/10867651.2003.10487582.  The surface lies half a voxel
    outside the outermost centres along each axis and cuts the corners, so a cavity's surface stays
    within its voxels.

    voxels : (nx, ny, nz) bool; voxel (i, j, k) is centred at (index + 0.5) / n − 0.5 on each axis.
    """
    if not voxels.any():
        return VoxelSurface(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    from skimage.measure import marching_cubes

    padded = np.pad(voxels, 1).astype(np.float32)
    # "ascent" tells skimage that the inside is above the level.
    vertices, faces, _, _ = marching_cubes(padded, LEVEL, gradient_direction="ascent")
    centred = (vertices.astype(np.float64) - 0.5) / np.array(voxels.shape) - 0.5
    return VoxelSurface(centred, faces.astype(np.int64))
