"""Read a voxel file as a model: the surface of the solid that its voxels describe."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from printprep.generators.read import read_voxels
from printprep.generators.surface import surface_of
from printprep.generators.voxel_arrays import occupancy
from printprep.mesh.read import RawMesh
from printprep.paper.domain import fill


def read_model(path: Path) -> RawMesh:
    """Read the filled solid of a voxel file as triangles, 1 mm along the grid's edge, z up.

    The generator's frame [-0.5, 0.5]³ has no unit: the caller asks for a size.

    Raises InputError when the file is not a voxel file, or holds no voxel.
    """
    occupied, _ = occupancy(read_voxels(path), name=str(path))
    surface = surface_of(fill(occupied))
    return RawMesh(surface.vertices, surface.faces, path.stem, np.eye(4))
