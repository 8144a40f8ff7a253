"""Voxelize a model as the paper does: scaled into the unit cube.

The frame is the generator's: the bounding box is centred on the origin and its longest side is 1,
so the object lies in [-0.5, 0.5]³ with z up; voxel (i, j, k) of N³ is centred at
(index + 0.5) / N − 0.5.

"surface" takes all voxels that the surface passes through, as the shell, and what they enclose.  A
generator's sparse structure is such a set, and the authors' code freezes and fills it.  "centre"
takes the voxels whose centre is inside, with the outermost layer as the shell, as the paper's text
has it: the shell is thinner, and nothing lies outside the object.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from printprep.errors import GeometryError
from printprep.evaluate.voxelize_surface import voxelize_surface
from printprep.mesh.measure import signed_volumes
from printprep.mesh.place import place
from printprep.mesh.read import read_mesh
from printprep.mesh.winding_columns import winding_in_columns

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float, Int

Voxels = Literal["surface", "centre"]

# Columns must not meet an edge or a corner, and no face may lie between two voxels: these shifts
# are incommensurable with any grid.
_JITTER = np.array([2.0**0.5, 3.0**0.5, 5.0**0.5]) * 1e-7
# The outermost faces lie this share inside the unit cube, so that they touch the cube's own voxels.
_WITHIN = 1e-6


@dataclass(frozen=True, eq=False)
class Picture:
    """A model's voxels, and its surface to compare with.

    vertices : (v, 3) float64 in [-0.5, 0.5]³;  faces : (f, 3) int64, counter-clockwise seen from
    outside.
    occupied : (N, N, N) bool, axis order x, y, z;  frozen : (N, N, N) bool, the occupied voxels
    that belong to the shell, outermost or not.
    """

    vertices: Float
    faces: Int
    occupied: NDArray[np.bool_]
    frozen: NDArray[np.bool_]


def picture_of(path: Path, up: str, resolution: int, voxels: Voxels = "surface") -> Picture:
    """Read, scale and voxelize a model.

    Raises
    ------
    InputError : as ``read_mesh``.
    GeometryError : the model encloses no voxel's centre.
    """
    placed = place(read_mesh(path), up=up, size_mm=1.0)
    vertices = placed.vertices - [0.0, 0.0, placed.vertices[:, 2].max() / 2]
    faces = placed.faces
    if signed_volumes(vertices[faces]).sum() < 0:  # inside out as a whole
        faces = faces[:, ::-1]
    inside = inside_voxels(vertices, faces, resolution)
    if not inside.any():
        raise GeometryError(
            f"{path} encloses none of the {resolution}³ voxel centres.",
            "Use a closed model that is thicker than a voxel.",
        )
    if voxels == "centre":
        return Picture(vertices, faces, inside, np.zeros_like(inside))
    shrunk = vertices * (1 - _WITHIN) + _JITTER
    frozen = voxelize_surface((shrunk[faces] + 0.5) * resolution, resolution)
    return Picture(vertices, faces, inside | frozen, frozen)


def inside_voxels(vertices: Float, faces: Int, resolution: int) -> NDArray[np.bool_]:
    """(N, N, N) bool: voxels of [-0.5, 0.5]³ with a winding number above ½ at their centre.

    vertices : (v, 3);  faces : (f, 3).
    """
    centres = (np.arange(resolution) + 0.5) / resolution - 0.5
    x, y = np.meshgrid(centres, centres, indexing="ij")
    columns = np.column_stack([x.ravel(), y.ravel()]) + _JITTER[:2]
    column_of = np.repeat(np.arange(len(columns)), resolution)
    winding = winding_in_columns(
        vertices, faces, columns, column_of, np.tile(centres, len(columns))
    )
    return (winding > 0.5).reshape(resolution, resolution, resolution)
