"""Generator voxels: every form in, the same form out, and what is refused."""

import numpy as np
import pytest
import torch

from printprep.errors import InputError
from printprep.generators.voxel_arrays import GRID, occupancy

CUBE = np.argwhere(np.ones((3, 4, 5), dtype=bool)) + np.array([10, 20, 30])


def _occupied():
    grid = np.zeros((GRID,) * 3, dtype=bool)
    grid[10:13, 20:24, 30:35] = True
    return grid


@pytest.mark.parametrize("dtype", ["int32", "int64", "uint8"])
def test_three_columns_there_and_back(dtype):
    occupied, form = occupancy(CUBE.astype(dtype))
    assert np.array_equal(occupied, _occupied())
    back = form.write(occupied)
    assert back.dtype == dtype
    assert np.array_equal(back, CUBE)


def test_order_and_repetition_do_not_matter():
    shuffled = np.random.default_rng(0).permutation(np.concatenate((CUBE, CUBE[:7])))
    occupied, form = occupancy(shuffled)
    assert np.array_equal(form.write(occupied), CUBE)


def test_batch_column_picks_a_sample_and_stays():
    first = np.insert(CUBE, 0, 0, axis=1)
    second = np.insert(CUBE + 5, 0, 1, axis=1)
    both = np.concatenate((first, second)).astype(np.int32)
    occupied, form = occupancy(both, batch=1)
    assert occupied.sum() == len(CUBE)
    assert np.array_equal(form.write(occupied), second)
    assert np.array_equal(occupancy(both)[0], _occupied())
    with pytest.raises(InputError, match="no sample 2"):
        occupancy(both, batch=2)


def test_torch_in_torch_out():
    tensor = torch.from_numpy(np.insert(CUBE, 0, 0, axis=1)).int()
    occupied, form = occupancy(tensor)
    back = form.write(occupied)
    assert back.dtype == torch.int32
    assert back.device == tensor.device
    assert torch.equal(back, tensor)


@pytest.mark.parametrize("dtype", ["bool", "uint8", "float32"])
def test_binary_array_there_and_back(dtype):
    occupied, form = occupancy(_occupied().astype(dtype))
    assert np.array_equal(occupied, _occupied())
    back = form.write(occupied)
    assert back.dtype == dtype
    assert back.shape == (GRID,) * 3
    assert np.array_equal(back, _occupied())


def test_leading_axes_of_one_are_dropped():
    occupied, _ = occupancy(torch.from_numpy(_occupied())[None, None])
    assert np.array_equal(occupied, _occupied())


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (CUBE.astype(float), "not integers"),
        (CUBE - 11, "-1 is off"),
        (CUBE + 30, "64 is off"),
        (CUBE[:, :2], "shape"),
        (np.zeros((0, 3), dtype=int), "no voxel"),
        (np.zeros((0, 4), dtype=int), "no voxel"),
        (np.zeros((GRID,) * 3), "no voxel"),
        (np.full((GRID,) * 3, 0.3), "other than 0 and 1"),
        (np.full((GRID,) * 3, np.nan), "other than 0 and 1"),
        (np.zeros((32, 32, 32), dtype=bool), "shape"),
        (np.array(["a"]), "shape"),
        (np.broadcast_to(np.int64(1), (10**9, 3)), "MiB"),
    ],
)
def test_refusals(wrong, says):
    with pytest.raises(InputError, match=says) as caught:
        occupancy(wrong, name="part.npz")
    assert caught.value.message.startswith("part.npz")
