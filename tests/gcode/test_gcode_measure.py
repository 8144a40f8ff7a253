"""What a G-code prints, against closed forms; each way of saying the same must measure the same."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from gcode_texts import AREA_175, FILAMENT, HEIGHT, WIDTH, beads
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.errors import InputError
from printprep.gcode import source as measuring
from printprep.gcode.measure import measure_gcode

LENGTH, DEPTH, TALL = 20.0, 20.0, 10.0


@pytest.fixture
def measured(tmp_path: Path):
    def measure(text: str, **options):
        path = tmp_path / "part.gcode"
        path.write_text(text, encoding="utf-8", newline="")
        return measure_gcode(path, **options)

    return measure


def is_the_cuboid(printed, raft_mm3: float = 0, rtol: float = 1e-6) -> None:
    mass = LENGTH * DEPTH * TALL * 1.25e-3
    assert printed.mass_g == pytest.approx(mass, rel=1e-6)
    assert printed.centre_of_mass_mm == pytest.approx((110, 110, TALL / 2), abs=1e-6)
    expected = mass / 12 * np.diag([DEPTH**2 + TALL**2, LENGTH**2 + TALL**2, LENGTH**2 + DEPTH**2])
    np.testing.assert_allclose(printed.inertia_g_mm2, expected, rtol=rtol, atol=1e-6)
    # Round ends stand out by half a width along x
    low, high = printed.contact_polygon_mm.min(axis=0), printed.contact_polygon_mm.max(axis=0)
    np.testing.assert_allclose(low, [100 - WIDTH / 2, 100], atol=1e-5)
    np.testing.assert_allclose(high, [120 + WIDTH / 2, 120], atol=1e-5)
    half_disc = 16 / 2 * math.sin(2 * math.pi / 16) * (WIDTH / 2) ** 2 / 2
    ends = 40 * 2 * half_disc
    assert printed.contact_area_mm2 == pytest.approx(LENGTH * DEPTH + ends, rel=1e-5)
    expected = [[100 - WIDTH / 2, 100], [120 + WIDTH / 2, 120]]
    np.testing.assert_allclose(np.ptp(printed.bounds_mm[:, 2]), TALL, atol=1e-9)
    np.testing.assert_allclose(printed.bounds_mm[:, :2], expected, atol=WIDTH / 2 + 1e-9)
    assert printed.tilt_deg == pytest.approx(math.degrees(math.atan(10 / 5)), abs=0.05)
    assert printed.filament_mm3 == pytest.approx(LENGTH * DEPTH * TALL + raft_mm3, rel=1e-6)


@pytest.mark.parametrize("relative", [True, False])
@pytest.mark.parametrize("piece", [173, 4096, 1 << 22])
def test_a_cuboid_of_beads(measured, monkeypatch, relative: bool, piece: int):
    monkeypatch.setattr(measuring, "_PIECE_BYTES", piece)
    is_the_cuboid(measured(beads(relative=relative) + FILAMENT))


FLAVOURS = {
    "PrusaSlicer": {},
    "OrcaSlicer": {"label": ";TYPE:Outer wall"},
    "BambuStudio": {
        "label": "; FEATURE: Outer wall",
        "width": "; LINE_WIDTH: {:g}",
        "height": "; Z_HEIGHT: 0.2\n; LAYER_HEIGHT: {:g}",
    },
    "SuperSlicer": {"label": ";TYPE:Internal bridge infill"},
    "Cura": {"label": ";LAYER:0\n;MESH:a.stl\n;TYPE:WALL-OUTER", "width": "", "height": ""},
    "nobody": {"label": ";nothing", "width": "", "height": ""},
}


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_every_slicers_comments(measured, flavour: str):
    text = beads(**FLAVOURS[flavour]) + FILAMENT
    printed = measured(text)
    # Without a width, a bead's own width is missing from the inertia
    is_the_cuboid(printed, rtol=1e-6 if ";WIDTH" in text or "LINE_WIDTH" in text else 1e-3)
    expected = {
        "OrcaSlicer": "external perimeter", "BambuStudio": "external perimeter",
        "Cura": "external perimeter", "SuperSlicer": "bridge infill",
        "PrusaSlicer": "solid infill", "nobody": "unlabelled",
    }[flavour]  # fmt: skip
    assert list(printed.feature_mass_g) == [expected]


def test_other_ways_to_write_the_same(measured):
    text = beads() + FILAMENT
    is_the_cuboid(measured(text.replace("\n", "\r\n")))
    is_the_cuboid(measured(text.replace("G1 X", "G01X").replace(" E", "E")))
    sent = [
        line if line.startswith(";") else f"  {line.split(' ;')[0]}*71"
        for line in beads().splitlines()
    ]
    is_the_cuboid(measured("\n".join(sent) + "\n" + FILAMENT))
    numbered = [
        line if line.startswith(";") else f"N{n} {line.split(' ;')[0]}*{n % 256}"
        for n, line in enumerate(beads().splitlines())
    ]
    is_the_cuboid(measured("\n".join(numbered) + "\n" + FILAMENT))
    lower = "\n".join(
        line if line.startswith(";") else line.lower() for line in beads().splitlines()
    )
    is_the_cuboid(measured(lower + "\n" + FILAMENT))
    is_the_cuboid(measured(text.rstrip("\n")))


def test_inches(measured):
    lines = []
    for line in beads().splitlines():
        words = line.split(" ;")[0].split()
        if words[0] == "G1":
            words = [w if w[0] in "GF" else f"{w[0]}{float(w[1:]) / 25.4:.9f}" for w in words]
        lines.append(" ".join(words).replace("G21", "G20") if line[0] != ";" else line)
    is_the_cuboid(measured("\n".join(lines) + "\n" + FILAMENT))


def test_relative_axes_and_new_origins(measured):
    """The head's own way: G91 throughout, and an origin moved with G92 on the way."""
    text = ["G90", "M83", ";TYPE:Perimeter", f";WIDTH:{WIDTH}", f";HEIGHT:{HEIGHT}"]
    text += ["G1 X100 Y100.25 Z0", "G92 X0 Y7", "G91"]
    per_line = LENGTH * WIDTH * HEIGHT / AREA_175
    for layer in range(50):
        text.append("G1 Z0.2")
        for _ in range(40):
            text += [f"G1 X20 E{per_line:.9f}", "G1 X-20", "G1 Y0.5"]
        text += ["G1 Y-20"]
        if layer == 20:
            text += ["G90", "G1 X0", "G92 X50", "G1 X50", "G91"]
    is_the_cuboid(measured("\n".join(text) + "\n" + FILAMENT))


def test_retraction_is_no_material(measured):
    text = beads().replace("G1 Z", "G1 E-2\nG1 X5 Y5 E-0.5\nG1 E2.5\nG10\nG11\nG1 Z")
    is_the_cuboid(measured(text + FILAMENT))


@pytest.mark.parametrize("how", ["M200 D1.75\n", "; use_volumetric_e = 1\n"])
def test_volumetric_filament(measured, how: str):
    text = beads(per_mm=WIDTH * HEIGHT)
    is_the_cuboid(measured((how + text if how[0] == "M" else text + how) + FILAMENT))


def test_each_extruder_has_its_own_filament(measured):
    one = beads()
    two = beads(at=(100.0, 150.0), per_mm=WIDTH * HEIGHT / (math.pi / 4 * 2.85**2))
    said = "; filament_diameter = 1.75,2.85\n; filament_density = 1,3\n"
    printed = measured(one + "T1\n" + two + said)
    assert printed.volume_mm3 == pytest.approx(2 * 4000, rel=1e-6)
    assert printed.mass_g == pytest.approx(4.0 + 12.0, rel=1e-6)
    assert printed.centre_of_mass_mm[1] == pytest.approx((110 * 4 + 160 * 12) / 16, rel=1e-6)
    assert printed.assumed == ()


def test_what_is_left_out_is_told_but_not_weighed(measured):
    extra = {
        "Skirt/Brim": "skirt", "Support material": "support material", "Custom": "custom",
        "Wipe tower": "wipe tower",
    }  # fmt: skip
    text = beads()
    for label in extra:
        text += beads(label=f";TYPE:{label}", at=(50.0, 20.0), layers=5)
    printed = measured(text + FILAMENT)
    assert printed.mass_g == pytest.approx(5.0)
    assert printed.left_out == tuple(sorted(extra.values()))
    for feature in extra.values():
        assert printed.feature_mass_g[feature] == pytest.approx(0.5)
    assert printed.filament_mm3 == pytest.approx(4000 + 3 * 400, rel=1e-6)
    with_all = measured(text + FILAMENT, left_out=())
    assert with_all.mass_g == pytest.approx(7.0)


def test_start_code_before_the_first_label_is_custom(measured):
    prime = "M83\nG1 X0 Y0 Z0.3\nG1 X100 E9\n"
    printed = measured(prime + beads() + FILAMENT)
    is_the_cuboid(printed)
    assert printed.feature_mass_g["custom"] == pytest.approx(9 * AREA_175 * 1.25e-3)


@pytest.mark.parametrize("clockwise", [True, False])
@pytest.mark.parametrize("by", ["centre", "radius", "whole"])
def test_arcs(measured, clockwise: bool, by: str):
    """A ring of radius 20 about (100, 100), as quarters or in one go."""
    corners = [(120, 100), (100, 120), (80, 100), (100, 80)]
    if clockwise:
        corners = [corners[i] for i in (0, 3, 2, 1)]
    code = "G2" if clockwise else "G3"
    per_ring = 2 * math.pi * 20 * WIDTH * HEIGHT / AREA_175
    text = ["M83", ";TYPE:Perimeter", f";WIDTH:{WIDTH}", f";HEIGHT:{HEIGHT}", "G1 X120 Y100 Z0.2"]
    if by == "whole":
        text.append(f"{code} I-20 J0 E{per_ring:.9f}")
    else:
        for here, there in zip(corners, corners[1:] + corners[:1], strict=True):
            way = f"I{100 - here[0]} J{100 - here[1]}" if by == "centre" else "R20"
            text.append(f"{code} X{there[0]} Y{there[1]} {way} E{per_ring / 4:.9f}")
    printed = measured("\n".join(text) + "\n" + FILAMENT)
    assert printed.volume_mm3 == pytest.approx(2 * math.pi * 20 * WIDTH * HEIGHT, rel=1e-6)
    assert printed.centre_of_mass_mm == pytest.approx((100, 100, 0.1), abs=1e-6)
    assert printed.inertia_g_mm2[2, 2] == pytest.approx(printed.mass_g * 400, rel=2e-3)
    assert np.linalg.norm(printed.contact_polygon_mm - 100, axis=1).max() == pytest.approx(
        20.25, abs=0.03
    )


@pytest.mark.parametrize("piece", [97, 1 << 22])
def test_lines_of_words_alone_move_as_the_line_before(measured, monkeypatch, piece: int):
    monkeypatch.setattr(measuring, "_PIECE_BYTES", piece)
    lines, moved = [], False
    for line in beads().splitlines():
        lines.append(line[3:] if moved and line.startswith("G1 ") else line)
        moved = moved or line.startswith("G1 ")
    text = "\n".join(lines) + "\n" + FILAMENT
    assert text.count("G1 ") == 1 and text.count("\nX") > 3000
    is_the_cuboid(measured(text))
    # What only looks like it is no move: a macro's name, and words before any move
    macros = "X5 E9\n" + text.replace("\nZ", "\nEXCLUDE X1 E9\nXMACRO E9\nZ")
    is_the_cuboid(measured(macros))


def test_the_mode_of_an_arc_is_kept_too(measured):
    """A ring as four quarters, of which only the first says G3."""
    per_quarter = math.pi * 10 * WIDTH * HEIGHT / AREA_175
    text = ["M83", ";TYPE:Perimeter", f";WIDTH:{WIDTH}", f";HEIGHT:{HEIGHT}", "G1 X120 Y100 Z0.2"]
    ways = ((100, 120, -20, 0), (80, 100, 0, -20), (100, 80, 20, 0), (120, 100, 0, 20))
    for n, (x, y, i, j) in enumerate(ways):
        code = "G3 " if n == 0 else ""
        text.append(f"{code}X{x} Y{y} I{i} J{j} E{per_quarter:.9f}")
    printed = measured("\n".join(text) + "\n" + FILAMENT)
    assert printed.centre_of_mass_mm == pytest.approx((100, 100, 0.1), abs=1e-6)
    assert printed.inertia_g_mm2[2, 2] == pytest.approx(printed.mass_g * 400, rel=2e-3)


def test_absolute_centres_of_arcs(measured):
    """G90.1: I and J are where the centre is, in the coordinates that G92 moved."""
    head = "M83\n;TYPE:Perimeter\n;WIDTH:0.5\n;HEIGHT:0.2\nG1 X120 Y100 Z0.2\n"
    relative = measured(f"{head}G3 X100 Y120 I-20 J0 E3\n" + FILAMENT)
    for arc in (
        "G90.1\nG3 X100 Y120 I100 J100 E3\n",
        "G92 X20 Y0\nG90.1\nG3 X0 Y20 I0 J0 E3\n",
        "G90.1\nG91.1\nG3 X100 Y120 I-20 J0 E3\n",
        "G90.1\nG3 X100 Y120 J100 I100 E3\nG91.1\n",
    ):
        absolute = measured(head + arc + FILAMENT)
        np.testing.assert_allclose(
            absolute.centre_of_mass_mm, relative.centre_of_mass_mm, atol=1e-9
        )
        np.testing.assert_allclose(absolute.inertia_g_mm2, relative.inertia_g_mm2, atol=1e-9)


def test_a_helix_spreads_its_material_over_its_height(measured):
    """A turn of G2 that climbs a millimetre: its centre is half way up."""
    text = "M83\n;TYPE:Perimeter\n;WIDTH:0.5\n;HEIGHT:0.2\nG1 X120 Y100 Z0.2\nG2 Z1.2 I-20 E50\n"
    printed = measured(text + FILAMENT)
    x, y, z = printed.centre_of_mass_mm
    assert (x, y) == pytest.approx((100, 100), abs=1e-6)
    assert printed.bounds_mm[1, 2] == pytest.approx(1.2)
    assert z + printed.bounds_mm[0, 2] == pytest.approx(0.7 - 0.1, abs=0.02)


def test_a_large_arc_by_negative_radius(measured):
    text = (
        "M83\n;TYPE:Perimeter\n;WIDTH:0.5\n;HEIGHT:0.2\nG1 X120 Y100 Z0.2\nG3 X100 Y80 R-20 E10\n"
    )
    printed = measured(text + FILAMENT)
    # Three quarters of a ring: its centre lies at r sin(α) / α from the middle, α = 135°
    distance = 20 * math.sin(math.radians(135)) / math.radians(135)
    x, y, _ = printed.centre_of_mass_mm
    assert math.hypot(x - 100, y - 100) == pytest.approx(distance, rel=1e-3)
    assert (x - 100, y - 100) == pytest.approx((-distance / 2**0.5, distance / 2**0.5), rel=1e-3)


def test_material_and_support_inside_cavities(measured):
    cavity = Manifold.cube((7.8, 8, 4)).translate((106.1, 106, 3))
    wall = beads()
    printed = measured(wall + FILAMENT, cavities=[cavity])
    # Axes deeper than half a line: sampled every half millimetre along x
    layers = np.arange(50) * 0.2 + 0.1
    layers = np.sum((layers > 3.25) & (layers < 6.75))
    lines = 100.25 + 0.5 * np.arange(40)
    lines = np.sum((lines > 106.25 + 1e-9) & (lines < 113.75 - 1e-9))
    expected = layers * lines * 7.3 * WIDTH * HEIGHT
    assert printed.in_cavities_mm3 == pytest.approx(expected, rel=0.05)
    assert printed.support_in_cavities_mm3 == 0.0
    support = beads(label=";TYPE:Support material") + beads(at=(200.0, 100.0))
    printed = measured(support + FILAMENT, cavities=[cavity])
    assert printed.support_in_cavities_mm3 == pytest.approx(expected, rel=0.05)
    elsewhere = cavity.translate((50, 0, 0))
    assert measured(wall + FILAMENT, cavities=[elsewhere]).in_cavities_mm3 == 0.0


def test_bodies_are_balanced_each_by_itself(measured):
    """Two cuboids of one print: a tall one on 20 × 20 mm, and a flat one beside it."""
    at_x, at_y = (100.0, 100.0), (100.0, 130.0)
    text = beads(at=at_x, layers=100) + beads(at=at_y, layers=5)
    # The second one's box reaches round the first: what lies in both boxes goes by the surface
    frame = Manifold.cube((60, 60, 1)).translate((80, 90, 0)) - Manifold.cube(
        (22, 22, 1)
    ).translate((99, 99, 0))
    tall = Manifold.cube((20, 20, 20)).translate((100, 100, 0))
    for flat in (Manifold.cube((20, 20, 1)).translate((100, 130, 0)), frame):
        printed = measured(text + FILAMENT, bodies=[tall, flat])
        first, second = printed.bodies
        assert first.mass_g == pytest.approx(LENGTH * DEPTH * 20 * 1.25e-3, rel=1e-6)
        assert second.mass_g == pytest.approx(LENGTH * DEPTH * 1 * 1.25e-3, rel=1e-6)
        assert first.centre_of_mass_mm == pytest.approx((110, 110, 10), abs=1e-6)
        assert second.centre_of_mass_mm == pytest.approx((110, 140, 0.5), abs=1e-6)
        assert first.tilt_deg == pytest.approx(45.0, abs=0.05)
        assert second.tilt_deg == pytest.approx(math.degrees(math.atan(10 / 0.5)), abs=0.05)
        assert first.contact_area_mm2 + second.contact_area_mm2 == pytest.approx(
            printed.contact_area_mm2, rel=1e-6
        )
    assert measured(text + FILAMENT).bodies == ()


def test_a_body_above_the_bed_does_not_touch_it(measured):
    lifted = "".join(
        f"G1 Z{float(line[4:].split()[0]) + 5:.3f}\n" if line.startswith("G1 Z") else line + "\n"
        for line in beads(at=(100.0, 130.0), layers=5).splitlines()
    )
    solids = [Manifold.cube((20, 20, z)).translate((100, y, 0)) for y, z in ((100, 1), (130, 6))]
    on_bed, above = measured(beads(layers=5) + lifted + FILAMENT, bodies=solids).bodies
    assert on_bed.tilt_deg > 80
    assert above.tilt_deg is None and len(above.contact_polygon_mm) == 0
    assert above.centre_of_mass_mm[2] == pytest.approx(5.5)


def test_what_the_file_does_not_say_is_told(measured):
    printed = measured(beads())
    assert len(printed.assumed) == 2
    assert printed.mass_g == pytest.approx(4.0 * 1.24)
    told = measured(beads(), diameter_mm=1.75, density_g_cm3=1.25)
    is_the_cuboid(told)
    assert told.assumed == ()


def test_a_part_on_a_raft_stands_on_its_own_lowest_layer(measured):
    raft = beads(label=";TYPE:Support material", layers=3)
    lifted = "".join(
        f"G1 Z{float(line[4:].split()[0]) + 0.6:.3f}\n" if line.startswith("G1 Z") else line + "\n"
        for line in beads().splitlines()
    )
    is_the_cuboid(measured(raft + lifted + FILAMENT), raft_mm3=240)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"GCDE\x01\x00\x00", "cut off"),
        (b"PK\x03\x04", "archive"),
        (b"", "prints no part of a model"),
        (b"solid cube\nendsolid\n", "prints no part of a model"),
        (b"M83\nG1 X1 Y2 Z0.2 E1.2.3\n", "line 2"),
        (b"M83\nG1 X--1 E1\n", "line 2"),
        (b"M83\nG1 X E1\n", "line 2"),
        (b"M83\nG1 X1234567890123456789 E1\n", "line 2"),
    ],
)
def test_what_is_refused(tmp_path: Path, content: bytes, words: str):
    path = tmp_path / "x.gcode"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words) as caught:
        measure_gcode(path)
    assert "x.gcode" in caught.value.message


def test_a_missing_file_is_an_input_error(tmp_path: Path):
    with pytest.raises(InputError, match="does not exist"):
        measure_gcode(tmp_path / "none.gcode")


def plain_measure(moves) -> tuple[float, np.ndarray]:
    """An independent reader of absolute moves: mass and centre by one loop."""
    at, mass, first = np.zeros(3), 0.0, np.zeros(3)
    for x, y, z, e in moves:
        to = np.array([x, y, z])
        if e > 0 and (to[:2] != at[:2]).any():
            mass += e
            first += e * ((at + to) / 2 - [0, 0, 0.1])
        at = to
    return mass * AREA_175 * 1.25e-3, first / mass if mass else first


coordinate = st.integers(0, 200_000).map(lambda n: n / 1000)
moves = st.lists(
    st.tuples(
        coordinate, coordinate, st.sampled_from([0.2, 0.4, 7.6]), st.sampled_from([0, 0, 1.5, 2])
    ),
    min_size=4, max_size=40,
)  # fmt: skip


@given(moves=moves, piece=st.integers(20, 400))
def test_any_moves_weigh_what_a_plain_loop_says(tmp_path_factory, moves, piece: int):
    mass, centre = plain_measure(moves)
    path = tmp_path_factory.mktemp("moves") / "m.gcode"
    lines = [f"G1 X{x:.3f} Y{y:.3f} Z{z} E{e}" for x, y, z, e in moves]
    head = "M83\n;TYPE:Perimeter\n;WIDTH:0.4\n;HEIGHT:0.2\n"
    path.write_text(head + "\n".join(lines) + "\n" + FILAMENT)
    before = measuring._PIECE_BYTES
    measuring._PIECE_BYTES = piece
    try:
        if mass == 0:
            with pytest.raises(InputError):
                measure_gcode(path)
            return
        printed = measure_gcode(path)
    finally:
        measuring._PIECE_BYTES = before
    assert printed.mass_g == pytest.approx(mass, rel=1e-9)
    bottom = min(
        (z - 0.2 for a, (x, y, z, e) in zip([(0, 0, 0, 0), *moves], moves, strict=False)
         if e > 0 and (a[0], a[1]) != (x, y)),
        default=0.0,
    )  # fmt: skip
    expected = centre - np.array([0, 0, bottom])
    np.testing.assert_allclose(printed.centre_of_mass_mm, expected, atol=1e-6)


@pytest.mark.parametrize(
    "label", ["; printing object {} id:0 copy 0", "EXCLUDE_OBJECT_START NAME={}", "M486 S{}"]
)
def test_labelled_objects_are_told_apart(measured, label: str):
    text = "".join(f"{label.format(i)}\n{beads(layers=2)}" for i in (7, 8, 7))
    assert len(measured(text + FILAMENT).objects) == 2
    assert measured(beads() + FILAMENT).objects == ()


def test_memory_stays_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Ten times the file must not take more memory: it is read in pieces."""
    import tracemalloc

    monkeypatch.setattr(measuring, "_PIECE_BYTES", 1 << 16)
    path = tmp_path / "long.gcode"
    peaks = []
    for layers in (60, 600):
        path.write_text(beads(layers=layers) + FILAMENT)
        tracemalloc.start()
        measure_gcode(path)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert path.stat().st_size > 1e6
    assert peaks[1] < 1.2 * peaks[0]
