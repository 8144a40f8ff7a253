"""The small picture: its pixels against closed forms, its bytes the same every time."""

from __future__ import annotations

import struct
import time
import zlib

import numpy as np
import pytest
from numpy.typing import NDArray

from printprep.render.raster import coverage, rasterize
from printprep.render.thumbnail import thumbnail_png


def decode(png: bytes) -> NDArray[np.uint8]:
    """RGBA pixels of an 8-bit PNG without interlacing; every checksum is looked at."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data, size = 8, b"", (0, 0)
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        body = png[at + 8 : at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0] == zlib.crc32(
            kind + body
        )
        if kind == b"IHDR":
            assert body[8:] == bytes([8, 6, 0, 0, 0])
            size = struct.unpack(">II", body[:8])
        data += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height = size
    raw = np.frombuffer(zlib.decompress(data), dtype=np.uint8).reshape(height, 1 + width * 4)
    assert (raw[:, 0] == 2).all()
    rows = np.cumsum(raw[:, 1:].astype(np.int64), axis=0) % 256
    return rows.astype(np.uint8).reshape(height, width, 4)


def sphere(steps: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A unit sphere of `steps` by 2 · `steps` quadrilaterals, cut into triangles."""
    polar, around = np.meshgrid(
        np.linspace(0, np.pi, steps + 1), np.linspace(0, 2 * np.pi, 2 * steps + 1), indexing="ij"
    )
    points = np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1
    )
    index = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    faces = np.concatenate(
        [np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]
    )
    return points.reshape(-1, 3), faces


def test_a_rectangle_covers_exactly_the_pixel_centres_inside_it() -> None:
    corners = np.array([[[2, 3], [10, 3], [10, 8]], [[2, 3], [10, 8], [2, 8]]], dtype=float)
    expected = np.zeros((16, 16), dtype=bool)
    expected[3:8, 2:10] = True
    assert (coverage(corners, 16) == expected).all()
    assert (coverage(corners[:, ::-1], 16) == expected).all()  # whichever way round
    hits = rasterize(corners, np.zeros((2, 3)), 16)
    assert sorted(hits.pixel) == sorted(np.flatnonzero(expected))
    assert hits.weights.sum(axis=1) == pytest.approx(1.0)


def test_the_nearest_triangle_wins_and_the_first_on_a_tie() -> None:
    whole = np.array([[0, 0], [20, 0], [0, 20]], dtype=float)
    corners = np.stack([whole, whole, whole])
    depth = np.array([[1.0, 1, 1], [3, 3, 3], [3, 3, 3]])
    assert set(rasterize(corners, depth, 8).triangle) == {1}
    tilted = np.array([[0.0, 10.0, 0.0], [2.0, 2.0, 2.0], [0, 0, 0]])  # crosses at x = 4
    hits = rasterize(corners, tilted, 8)
    assert ((hits.triangle == 0) == (hits.pixel % 8 + 0.5 > 4.0)).all()


def test_triangles_off_the_picture_or_without_area_hit_nothing() -> None:
    outside = np.array([[[-9, -9], [-1, -9], [-1, -1]], [[30, 3], [40, 3], [40, 9]]], dtype=float)
    flat = np.array([[[1, 1], [5, 5], [3, 3]]], dtype=float)
    for corners in (outside, flat):
        assert not coverage(corners, 16).any()
        assert len(rasterize(corners, np.zeros((len(corners), 3)), 16).pixel) == 0


def test_a_sphere_is_a_disc_lit_from_the_upper_left() -> None:
    vertices, faces = sphere(60)
    picture = decode(thumbnail_png(vertices * 7.0 + [3, 4, 5], faces, 200))
    solid = picture[..., 3] == 255
    rows, columns = np.nonzero(solid)
    wide, tall = np.ptp(columns) + 1, np.ptp(rows) + 1
    assert abs(wide - tall) <= 2  # a parallel projection keeps it round
    assert solid.sum() == pytest.approx(np.pi / 4 * wide * tall, rel=0.03)
    light = picture[..., :3].sum(axis=2)
    middle_row, middle_column = int(rows.mean()), int(columns.mean())
    quarter = wide // 4
    assert light[middle_row - quarter, middle_column - quarter] > (
        1.3 * light[middle_row + quarter, middle_column + quarter]
    )
    assert (picture[0, :, 3] == 0).all()  # transparent around it
    shadow = (picture[..., 3] > 0) & (picture[..., 3] < 120)
    assert np.nonzero(shadow)[0].mean() > middle_row  # which lies below


def test_a_cube_shows_three_flat_sides_of_three_shades() -> None:
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = np.array(
        [
            *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
            *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
        ]
    )
    picture = decode(thumbnail_png(corner, faces, 128))
    colours, counts = np.unique(picture[picture[..., 3] == 255], axis=0, return_counts=True)
    # light varies over a side only by the gloss at an edge: three colours fill the picture
    assert np.sort(counts)[-3:].sum() > 0.6 * counts.sum()
    assert len({tuple(colour) for colour in colours[np.argsort(counts)[-3:]]}) == 3


def test_the_same_mesh_gives_the_same_bytes_in_any_place_and_scale() -> None:
    vertices, faces = sphere(24)
    first = thumbnail_png(vertices, faces, 64)
    assert thumbnail_png(vertices, faces, 64) == first
    moved = decode(thumbnail_png(vertices * 32.0 + [64, -32, 0], faces, 64)).astype(int)
    assert np.abs(moved - decode(first)).max() <= 2


def test_nothing_gives_an_empty_picture() -> None:
    empty = thumbnail_png(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64), 16)
    assert (decode(empty) == 0).all()


def test_a_hundred_thousand_triangles_take_well_under_a_second() -> None:
    vertices, faces = sphere(160)
    assert len(faces) > 100_000
    began = time.perf_counter()
    thumbnail_png(vertices, faces)
    assert time.perf_counter() - began < 5.0  # measured 0.35 s alone on two cores
