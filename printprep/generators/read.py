"""Read voxel files (.npz, .npy and .pt) without running any code from a file."""

from __future__ import annotations

import io
import math
import pickle
import struct
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from printprep.errors import InputError
from printprep.generators.voxel_arrays import LIMIT_BYTES
from printprep.input_file import check_plain_file
from printprep.wording import printable, shortened

NAMES = ("coords", "coordinates", "voxels", "binary_voxel", "occupancy")
"""Names of the voxel array in a file with several arrays, in order of preference."""

_NPY_HEAD_MAX = 16 << 10  # more than numpy's own longest header

SUFFIXES = (".npz", ".npy", ".pt")

DAMAGE = (
    OSError,
    ValueError,
    EOFError,
    KeyError,
    MemoryError,
    OverflowError,
    RecursionError,
    RuntimeError,  # an encrypted member
    zipfile.BadZipFile,
    zlib.error,
)
"""Errors that readers raise on damaged or foreign files; they have no common type."""

NUMPY_ERRORS = (
    *DAMAGE,
    SyntaxError,
    TypeError,
    AttributeError,
    struct.error,
    tokenize.TokenError,
    NotImplementedError,  # a compression of a zip that this Python does not know
)
TORCH_ERRORS = (*DAMAGE, IndexError, TypeError, AttributeError, AssertionError, struct.error)


def read_voxels(path: Path | str) -> NDArray[Any]:
    """Read the voxel array of a file, as `printprep.generators.hollow` takes it.

    A file with several arrays (.npz, or a dict in .pt) must hold one of the names coords,
    coordinates, voxels, binary_voxel, occupancy.
    Returns (n, 3) or (n, 4) coordinates, or a binary array (64, 64, 64).

    Raises InputError when the file cannot be read, is too large, holds pickled objects, or holds
    several arrays and none of these names.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path}: {suffix or 'a file without suffix'} is not a voxel file.",
            "Use .npz, .npy or .pt.",
        )
    check_plain_file(path, LIMIT_BYTES)
    return _torch_file(path) if suffix == ".pt" else _numpy_file(path, suffix)


def _numpy_file(path: Path, suffix: str) -> NDArray[Any]:
    """The voxel array of a .npy or .npz file, of any shape (…, …)."""
    try:
        if suffix == ".npy":
            with path.open("rb") as handle:
                return _array(handle)
        with zipfile.ZipFile(path) as archive:
            _limit(path, sum(entry.file_size for entry in archive.infolist()))
            members = [name.removesuffix(".npy") for name in archive.namelist()]
            with archive.open(_chosen(path, members) + ".npy") as member:
                return _array(member)
    except NUMPY_ERRORS as error:
        raise _unreadable(path, error) from error


def _array(handle: IO[bytes]) -> NDArray[Any]:
    """An array of any shape (…, …) in numpy's format, without pickled objects."""
    head = handle.read(_NPY_HEAD_MAX)
    stream = io.BytesIO(head)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a header of an old numpy
        version = np.lib.format.read_magic(stream)
        readers = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }
        if version not in readers:
            raise ValueError(f"its format {version} is not known")
        shape, fortran, dtype = readers[version](stream)
    if dtype.hasobject:
        raise ValueError("it holds pickled objects")
    # Compared as whole numbers, since a product of them may overflow an array's size.
    size = math.prod(shape) * dtype.itemsize
    if min(shape, default=1) < 0 or size > LIMIT_BYTES:
        raise ValueError("its header promises more than one grid of voxels")
    data = head[stream.tell() :] + handle.read(max(size - (len(head) - stream.tell()), 0))
    if len(data) < size:
        raise ValueError(f"it is cut short: {len(data)} of {size} bytes are there")
    flat: NDArray[Any] = np.frombuffer(data[:size], dtype=dtype, count=math.prod(shape))
    return flat.reshape(shape, order="F" if fortran else "C")


def _torch_file(path: Path) -> NDArray[Any]:
    """The voxel tensor of a .pt file as an array, of any shape (…, …)."""
    import torch

    try:
        if zipfile.is_zipfile(path):
            with zipfile.ZipFile(path) as archive:
                _limit(path, sum(entry.file_size for entry in archive.infolist()))
        with warnings.catch_warnings():
            # torch warns of unknown pickle protocols, and then raises if it cannot read them.
            warnings.simplefilter("ignore")
            loaded = torch.load(path, map_location="cpu", weights_only=True)
    except pickle.UnpicklingError as error:
        raise InputError(
            f"{path}: the file holds objects other than tensors, or is damaged.",
            "Save the tensor itself: torch.save(coords, path).",
        ) from error
    except TORCH_ERRORS as error:
        raise _unreadable(path, error) from error
    if isinstance(loaded, Mapping):
        tensors = {str(key): value for key, value in loaded.items() if torch.is_tensor(value)}
        loaded = tensors[_chosen(path, list(tensors))]
    if not torch.is_tensor(loaded):
        raise InputError(
            f"{path}: the file holds a {type(loaded).__name__}, not a tensor.",
            "Save the tensor itself: torch.save(coords, path).",
        )
    if loaded.layout != torch.strided or loaded.is_quantized or loaded.dtype == torch.bfloat16:
        raise InputError(
            f"{path}: the tensor is not a plain array of numbers.",
            "Save a dense tensor of integers or booleans.",
        )
    array: NDArray[Any] = loaded.detach().numpy()
    return array


def _chosen(path: Path, names: list[str]) -> str:
    """Name of the voxel array: the only one, or the first known name."""
    if len(names) == 1:
        return names[0]
    for name in NAMES:
        if name in names:
            return name
    listed = printable(", ".join(shortened(name) for name in names[:8])) or "none"
    raise InputError(
        f"{path}: none of its arrays ({listed}) has a known name.",
        f"Name the voxel array {NAMES[0]}.",
    )


def _limit(path: Path, size: int) -> None:
    """Raise when a file is larger than one grid of voxels."""
    if size > LIMIT_BYTES:
        raise InputError(
            f"{path}: {size / 2**20:.0f} MiB is more than one grid of voxels.",
            "Save one sample only.",
        )


def _unreadable(path: Path, error: BaseException) -> InputError:
    first = str(error).partition("\n")[0] or type(error).__name__
    return InputError(
        f"{path}: the file cannot be read as voxels ({shortened(first, 160)}).",
        "Save it again with numpy or torch.",
    )
