"""Convert a generator's voxel arrays to occupancy, and back to the same form.

Source of the forms: microsoft/TRELLIS, `sample_sparse_structure` (int tensor (n, 4) of batch, x,
y, z in a 64³ grid) and `run_detail_variation` (binary array (64, 64, 64)).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from printprep.arrays import Bool
from printprep.errors import InputError

GRID = 64
"""Voxels along the edge of the generator's grid."""

LIMIT_BYTES = 64 * 2**20
"""A larger array is more than one grid's voxels: 64³ rows of four 8-byte numbers are 8 MiB."""


@dataclass(frozen=True)
class Form:
    """The form of a voxel array, so that other voxels can be written alike.

    columns : 3 or 4 for coordinates, 0 for a binary array.
    batch : value of the batch column.
    dtype : numpy name of the numbers.
    device : torch device of a tensor, None for a numpy array.
    """

    columns: int
    batch: int
    dtype: str
    device: str | None

    def write(self, occupied: Bool) -> Any:
        """Write occupancy (64, 64, 64) in this form; coordinates sorted by x, then y, then z."""
        if not self.columns:
            array = occupied.astype(self.dtype)
        else:
            coordinates = np.argwhere(occupied)
            if self.columns == 4:
                batch = np.full((len(coordinates), 1), self.batch)
                coordinates = np.concatenate((batch, coordinates), axis=1)
            array = coordinates.astype(self.dtype)
        if self.device is None:
            return array
        import torch

        return torch.from_numpy(np.ascontiguousarray(array)).to(self.device)


def occupancy(voxels: Any, *, batch: int = 0, name: str = "voxels") -> tuple[Bool, Form]:
    """Read the occupancy of one sample, and the form of its array.

    Parameters
    ----------
    voxels : numpy array or torch tensor on any device: integers (n, 3) of x, y, z or (n, 4) of
        batch, x, y, z, each in 0..63; or (64, 64, 64) of 0 and 1, after any leading axes of 1.
    batch : the sample, for an array with a batch column.
    name : of the voxels, in messages.

    Returns
    -------
    (64, 64, 64) bool, axis order x, y, z, z up; and the form.

    Raises
    ------
    InputError : any other shape or number, a coordinate off the grid, no voxel, no such batch.
    """
    array, device = _array(voxels)
    if array.nbytes > LIMIT_BYTES:
        raise InputError(
            f"{name}: {array.nbytes / 2**20:.0f} MiB of numbers is more than one {GRID}³ grid.",
            "Pass one sample only.",
        )
    while array.ndim > 3 and array.shape[0] == 1:
        array = array[0]
    if array.shape == (GRID,) * 3:
        occupied, form = _binary(array, name), Form(0, batch, array.dtype.name, device)
    elif array.ndim == 2 and array.shape[1] in (3, 4):
        occupied = _coordinates(array, batch, name)
        form = Form(array.shape[1], batch, array.dtype.name, device)
    else:
        raise InputError(
            f"{name}: an array of shape {array.shape} is not voxels.",
            f"Use coordinates (n, 3) or (n, 4), or a binary array ({GRID}, {GRID}, {GRID}).",
        )
    if not occupied.any():
        raise InputError(f"{name}: no voxel is occupied.", "Pass at least one occupied voxel.")
    return occupied, form


def _array(voxels: Any) -> tuple[NDArray[Any], str | None]:
    """Voxels of any shape (…, …) as a numpy array, and their torch device; imports no torch."""
    if type(voxels).__module__.partition(".")[0] == "torch":
        return voxels.detach().cpu().numpy(), str(voxels.device)
    return np.asarray(voxels), None


def _binary(array: NDArray[Any], name: str) -> Bool:
    """(64, 64, 64) bool from a binary array of that shape."""
    if array.dtype.kind not in "buif" or not np.isin(array, (0, 1)).all():
        raise InputError(
            f"{name}: the array holds values other than 0 and 1.",
            "Threshold the generator's scores first.",
        )
    return array.astype(bool)


def _coordinates(array: NDArray[Any], batch: int, name: str) -> Bool:
    """(64, 64, 64) bool from coordinates (n, 3), or of one sample from (n, 4)."""
    if array.dtype.kind not in "ui":
        raise InputError(
            f"{name}: the coordinates are {array.dtype}, not integers.",
            f"Use voxel indices 0..{GRID - 1}.",
        )
    if array.shape[1] == 4:
        found = np.unique(array[:, 0])
        if len(array) and batch not in found:
            listed = ", ".join(str(value) for value in found[:8])
            raise InputError(
                f"{name}: no sample {batch} is in the batch.", f"Choose one of {listed}."
            )
        array = array[array[:, 0] == batch][:, 1:]
    if len(array) and (array.min() < 0 or array.max() >= GRID):
        worst = array.min() if array.min() < 0 else array.max()
        raise InputError(
            f"{name}: coordinate {worst} is off the grid.", f"Use voxel indices 0..{GRID - 1}."
        )
    occupied = np.zeros((GRID,) * 3, dtype=bool)
    occupied[tuple(array.T)] = True
    return occupied
