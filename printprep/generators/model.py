"""Read a voxel file as a model: the surface of the solid that its voxels describe."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from printprep.arrays import Bool
from printprep.errors import InputError
from printprep.generators.read import read_voxels
from printprep.generators.surface import surface_of
from printprep.generators.voxel_arrays import occupancy
from printprep.mesh.read import RawMesh
from printprep.paper.domain import fill

# A generator's solid has a few bodies; its voxels have fewer than 100,000 faces to empty ones.
_PIECES_MAX = 100
_FACES_MAX = 200_000


def read_model(path: Path) -> RawMesh:
    """Read the filled solid of a voxel file as triangles, 1 mm along the grid's edge, z up.

    The generator's frame [-0.5, 0.5]³ has no unit: the caller asks for a size.

    Raises InputError when the file is not a voxel file, or holds no voxel.
    """
    occupied, _ = occupancy(read_voxels(path), name=str(path))
    filled = fill(occupied)
    _refuse_dust(filled, path)
    surface = surface_of(filled)
    return RawMesh(surface.vertices, surface.faces, path.stem, np.eye(4))


def _refuse_dust(filled: Bool, path: Path) -> None:
    """Raise InputError for voxels (nx, ny, nz) that are noise: no solid is meant by them."""
    from scipy.ndimage import label

    _, pieces = label(filled)
    padded = np.pad(filled, 1).astype(np.int8)
    faces = sum(int(np.count_nonzero(np.diff(padded, axis=axis))) for axis in range(3))
    if pieces > _PIECES_MAX or faces > _FACES_MAX:
        raise InputError(
            f"{path}: its voxels are {pieces} pieces with {faces} faces outside: noise, no solid.",
            "Save the occupied voxels, after the threshold of the generator.",
        )
