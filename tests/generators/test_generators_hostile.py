"""Voxel files that claim more than they hold, or hold no solid."""

from __future__ import annotations

import os
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

from printprep.errors import InputError
from printprep.generators.model import read_model
from printprep.generators.read import read_voxels


def npy(shape: str, descr: str = "'<i8'", more: bytes = b"") -> bytes:
    header = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}"
    header += " " * (63 - (10 + len(header)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode() + more


CLAIMS = {
    "huge": npy(f"(1{'0' * 400},)"),
    "large": npy("(1000000, 1000000)"),
    "negative": npy("(-5, 3)"),
    "no whole number": npy("(2.5, 3)"),
    "short": npy("(9, 3)", more=bytes(200)),
    "nested": npy("(" * 4000 + ")" * 4000),
    "pickled": npy("(1,)", "'|O'"),
    "a version of the future": b"\x93NUMPY\x09\x00" + bytes(100),
    "a header without end": b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + b"{" * 1000,
}


@pytest.mark.parametrize("name", list(CLAIMS))
@pytest.mark.parametrize("suffix", [".npy", ".npz"])
def test_headers_that_claim_what_no_grid_has(tmp_path: Path, name: str, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    if suffix == ".npy":
        path.write_bytes(CLAIMS[name])
    else:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("coords.npy", CLAIMS[name])
    began = time.process_time()
    with pytest.raises(InputError, match="cannot be read as voxels") as caught:
        read_voxels(path)
    assert len(caught.value.message) < 400
    assert time.process_time() - began < 1.0


def test_both_orders_are_read(tmp_path: Path) -> None:
    grid = np.zeros((64, 64, 64), dtype=bool)
    grid[3, 7:9, 20] = True
    for order in "CF":
        path = tmp_path / f"{order}.npy"
        np.save(path, np.array(grid, order=order))  # type: ignore[call-overload]
        assert (read_voxels(path) == grid).all()


NOISE = {
    "checkerboard": lambda i: i.sum(axis=0) % 2 == 0,
    "dots": lambda i: (i % 2 == 0).all(axis=0),
    "columns": lambda i: (i[0] + i[1]) % 2 == 0,
    "slabs": lambda i: i[0] % 2 == 0,
    "random": lambda i: np.random.default_rng(0).random(i.shape[1:]) < 0.5,
}


@pytest.mark.parametrize("name", list(NOISE))
def test_noise_is_no_solid(tmp_path: Path, name: str) -> None:
    path = tmp_path / "a.npy"
    np.save(path, NOISE[name](np.indices((64, 64, 64))))
    with pytest.raises(InputError, match="noise, no solid"):
        read_model(path)


@pytest.mark.skipif(sys.platform == "win32", reason="has no devices in folders")
@pytest.mark.parametrize("suffix", [".npy", ".npz", ".pt"])
def test_what_has_no_end_is_refused(tmp_path: Path, suffix: str) -> None:
    device = tmp_path / f"zero{suffix}"
    device.symlink_to("/dev/zero")
    pipe = tmp_path / f"pipe{suffix}"
    os.mkfifo(pipe)
    for path in (device, pipe):
        with pytest.raises(InputError, match="is not a plain file"):
            read_voxels(path)
