"""The film of a fall, and its pictures: what they show, and the same bytes every time."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
import solids
from PIL import Image

from printprep.render.animation import gif_bytes, strip_bytes
from printprep.stand.fall import Film, film


@pytest.fixture(scope="module")
def falling_prism() -> Film:
    return film(solids.leaning_prism(20, 60, 10).rotate((0, 0, 70)), 0.2, 12.5)


def orange(picture: Image.Image) -> np.ndarray:
    """Where the part is: the bed and the paper are grey."""
    pixels = np.asarray(picture.convert("RGB")).astype(int)
    return pixels[..., 0] - pixels[..., 2] > 40


def test_the_film_ends_with_the_part_on_its_side(falling_prism: Film) -> None:
    first, last = falling_prism.frames[0], falling_prism.frames[-1]
    np.testing.assert_allclose(first.rotation, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(first.shift_mm, 0, atol=1e-3)
    assert falling_prism.azimuth_deg == pytest.approx(70)
    leans = [frame.lean_deg for frame in falling_prism.frames]
    assert leans == sorted(leans) and leans[0] == 0
    assert 9.49 < leans[-1] < 11
    # Its leaning side, nine degrees off its axis, comes to lie on the bed.
    assert last.tilt_deg == pytest.approx(90 - np.degrees(np.arctan(10 / 60)), abs=0.5)
    lowest = (solids.leaning_prism(20, 60, 10).rotate((0, 0, 70)).to_mesh64().vert_properties[:, :3]
              @ last.rotation.T + last.shift_mm)[:, 2].min()  # fmt: skip
    assert lowest == pytest.approx(0, abs=0.1)


def test_a_film_of_what_does_not_go_over_ends() -> None:
    coin = film(solids.cylinder(40, 2, segments=32), 0.2, 5.0)
    assert coin.frames[-1].tilt_deg < 1
    outrigger = solids.box(10, 10, 60) + solids.box(40, 10, 3).translate((20, 0, 1))
    held = film(outrigger, 0.2, 12.5)
    assert 1 < held.frames[-1].tilt_deg < 3
    assert len(held.frames) < 12.5 * 8


def test_the_strip_shows_the_fall_to_the_right(falling_prism: Film) -> None:
    strip = Image.open(BytesIO(strip_bytes(falling_prism, size=120, stills=4)))
    assert strip.size == (480, 120)
    rows, columns = zip(
        *(np.nonzero(orange(strip.crop((120 * k, 0, 120 * k + 120, 120)))) for k in range(4)),
        strict=True,
    )
    tall = [np.ptp(row) for row in rows]
    assert all(count.size > 200 for count in rows)
    assert tall[0] > 1.3 * tall[-1]
    assert np.mean(columns[-1]) > np.mean(columns[0]) + 10
    corner = np.asarray(strip.convert("RGB"))[-3:, -3:]
    assert (corner > 200).all()  # paper


def test_the_gif_has_every_frame_and_repeats(falling_prism: Film) -> None:
    data = gif_bytes(falling_prism, size=64)
    assert data == gif_bytes(falling_prism, size=64)
    picture = Image.open(BytesIO(data))
    assert picture.info["loop"] == 0
    milliseconds = 0
    for at in range(picture.n_frames):
        picture.seek(at)
        milliseconds += picture.info["duration"]
        assert orange(picture).sum() > 40
    # Frames that look alike are shown once, for longer; the last rests.
    assert milliseconds == 80 * (len(falling_prism.frames) - 1) + 1200
