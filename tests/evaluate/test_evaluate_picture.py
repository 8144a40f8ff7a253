"""Boxes fill the voxels they should, in the frame they should."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import voxel_box, write_boxes

from printprep.errors import GeometryError, InputError
from printprep.evaluate.picture import picture_of


def test_a_brick_fills_half_by_half_of_the_cube(tmp_path):
    brick = write_boxes(tmp_path / "brick.obj", ((5, 5, 5), (25, 15, 15)))
    picture = picture_of(brick, "+z", 16, "centre")
    assert np.abs(picture.vertices).max(axis=0) == pytest.approx([0.5, 0.25, 0.25])
    assert (picture.occupied == voxel_box((16,) * 3, (0, 4, 4), (16, 12, 12))).all()
    assert not picture.frozen.any()


def test_the_surfaces_voxels_are_the_shell_and_what_they_enclose_is_inside(tmp_path):
    # Walls at quarters and halves of a voxel, and a wall within, which is shell as well.
    outer, inner = ((0, 0, 0), (20, 10, 10)), ((9.7, 0.4, 0.4), (10.2, 9.6, 9.6))
    picture = picture_of(write_boxes(tmp_path / "b.obj", outer, inner), "+z", 20, "surface")
    box = voxel_box((20,) * 3, (0, 5, 5), (20, 15, 15))
    # The box's sides lie between two voxels: one of the two has them, so it may grow by a layer.
    grown = voxel_box((20,) * 3, (0, 4, 4), (20, 16, 16))
    assert (picture.occupied >= box).all() and (picture.occupied <= grown).all()
    deep = picture.occupied[2:18, 7:13, 7:13]
    frozen = picture.frozen[2:18, 7:13, 7:13]
    assert deep.all()
    assert np.flatnonzero(frozen.any(axis=(1, 2))).tolist() == [7, 8]  # voxels 9 and 10


def test_up_is_z(tmp_path):
    tower = write_boxes(tmp_path / "tower.obj", ((0, 0, 0), (4, 16, 4)), ((0, 0, 0), (8, 4, 4)))
    occupied = picture_of(tower, "+y", 16, "centre").occupied
    assert occupied.sum(axis=(0, 1))[:4].tolist() == [32] * 4
    assert occupied.sum(axis=(0, 1))[4:].tolist() == [16] * 12


def test_inside_out_is_turned(tmp_path):
    path = write_boxes(tmp_path / "cube.obj", ((0, 0, 0), (1, 1, 1)))
    lines = path.read_text().splitlines()
    flipped = [" ".join(["f", *line.split()[:0:-1]]) if line[0] == "f" else line for line in lines]
    path.write_text("\n".join(flipped))
    assert picture_of(path, "+z", 8).occupied.all()


def test_a_model_thinner_than_a_voxel_is_refused(tmp_path):
    sheet = write_boxes(tmp_path / "sheet.obj", ((0, 0, 0), (10, 10, 0.001)))
    with pytest.raises(GeometryError, match=r"sheet\.obj encloses none"):
        picture_of(sheet, "+z", 16)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match="nowhere"):
        picture_of(tmp_path / "nowhere.obj", "+z", 16)
