"""Binary G-code: what is measured in it is what is measured in the text it was made from."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest
from bgcode_files import binary, block, packed
from gcode.gcode_texts import FILAMENT, beads
from hypothesis import given
from hypothesis import strategies as st

from printprep.bgcode.blocks import GCODE, read_blocks
from printprep.bgcode.content import settings_of, text_of
from printprep.bgcode.meatpack import unpacked
from printprep.cli.run import run
from printprep.errors import InputError
from printprep.gcode.measure import measure_gcode
from printprep.slicer.sanitize import sets_density, without_commands

CUBE = Path(__file__).parent / "cube.bgcode"  # written by PrusaSlicer 2.9.2
TEXT = beads(lines=8, layers=6).encode()


def figures(path: Path) -> tuple[float, ...]:
    found = measure_gcode(path)
    return (found.mass_g, *found.centre_of_mass_mm, found.tilt_deg, found.contact_area_mm2)


@pytest.mark.parametrize("checksum", [True, False])
@pytest.mark.parametrize("encoding", [0, 1, 2])
@pytest.mark.parametrize("how", [0, 1, 2, 3])
def test_every_compression_and_encoding_measures_the_same(
    tmp_path: Path, how: int, encoding: int, checksum: bool
):
    text, made = tmp_path / "a.gcode", tmp_path / "a.bgcode"
    text.write_bytes(TEXT + FILAMENT.encode())
    made.write_bytes(binary(TEXT, how=how, encoding=encoding, checksum=checksum))
    assert figures(made) == pytest.approx(figures(text), rel=1e-12)
    printed = measure_gcode(made)
    assert printed.assumed == () and printed.labelled
    assert printed.slicer_summary.producer == "PrusaSlicer 2.9.2"


def test_a_file_of_the_slicer_measures_as_its_text_did():
    """The figures are those of the same model exported as text by the same slicer."""
    found = measure_gcode(CUBE)
    assert found.mass_g == pytest.approx(0.7929368588, rel=1e-9)
    assert found.tilt_deg == pytest.approx(50.895016597, rel=1e-9)
    assert found.left_out == ("skirt",)
    assert found.filament_mm3 == pytest.approx(found.slicer_summary.filament_mm3, rel=5e-3)


def test_what_is_packed_is_unpacked_again():
    text = b"G1 X10.5 Y2E.3\n;TYPE:Skirt \xc3\xbc\nM104 S200\nG92 E0\n"
    assert unpacked(packed(text)).replace(b"\n\n", b"\n") == text
    assert unpacked(packed(text, spaces=False)).replace(b"\n\n", b"\n") == text


@given(st.binary(max_size=400))
def test_any_bytes_unpack_to_at_most_twice_as_many(data: bytes):
    assert len(unpacked(b"\xff\xff\xfb" + data)) <= 2 * len(data) + 2


def test_the_hook_adds_its_figures_as_a_block_and_replaces_them(tmp_path: Path):
    path = tmp_path / "cube.bgcode.pp"
    before = CUBE.read_bytes()
    path.write_bytes(before)
    assert run(["hook", "--strict", str(path)]) == 0
    once = path.read_bytes()
    assert once.startswith(before)
    with path.open("rb") as file:
        *_, last = read_blocks(file, path.name)
    assert last.kind == GCODE and last.end == len(once)
    lines = last.data.decode().splitlines()
    assert all(line.startswith("; printprep: ") for line in lines)
    assert "; printprep: stands = yes" in lines and "; printprep: left_out = skirt" in lines
    assert run(["hook", "--strict", str(path)]) == 0
    assert path.read_bytes() == once
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


def test_without_comments_it_is_unknown_whether_it_stands(tmp_path: Path, capsys):
    path = tmp_path / "a.bgcode"
    bare = b"".join(line for line in TEXT.splitlines(True) if not line.startswith(b";"))
    path.write_bytes(binary(bare, encoding=1))
    assert run(["hook", str(path)]) == 0
    assert "skirt, brim and supports cannot be told" in capsys.readouterr().err
    assert b"stands = unknown" in path.read_bytes()


@pytest.mark.parametrize("cut", [5, 30, 300, 0.5, 0.99])
def test_a_file_that_is_cut_off_is_refused(tmp_path: Path, cut: float):
    whole = CUBE.read_bytes()
    path = tmp_path / "half.bgcode"
    half = whole[: int(cut * len(whole)) if cut < 1 else int(cut)]
    path.write_bytes(half)
    assert run(["hook", str(path)]) == 3
    assert path.read_bytes() == half


def test_a_file_cut_between_blocks_is_refused_for_what_it_counts(tmp_path: Path):
    counted = block(4, b"filament used [cm3]=0.6\n")  # 20 × 4 × 1.2 mm³ are there
    path = tmp_path / "half.bgcode"
    path.write_bytes(binary(TEXT, extra=[counted]))
    with pytest.raises(InputError, match=r"cut off: its moves take 0\.10 cm³ of the 0\.60"):
        measure_gcode(path)


HUGE = struct.pack("<HHI", 1, 0, 0xFFFFFFF0) + b"\0\0abc"
BOMB = struct.pack("<HHII", 1, 1, 10, 1030) + b"\0\0" + zlib.compress(bytes(1 << 20), 9)[:1030]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (struct.pack("<4sIH", b"GCDE", 2, 0), "version 2"),
        (struct.pack("<4sIH", b"GCDE", 1, 7), "type 7"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + struct.pack("<HHI", 9, 0, 0), "type 9"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + struct.pack("<HHI", 1, 4, 0), "compression 4"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + HUGE, "at most 64 MiB"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + BOMB, "damaged"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + block(1, b"G1", 0, 3, checksum=False), "encoding 3"),
        (struct.pack("<4sIH", b"GCDE", 1, 0) + block(3, b"a=b", checksum=False), "no G-code"),
        (binary(TEXT)[:-1] + b"\0", "checksum"),
    ],
)
def test_what_is_refused(tmp_path: Path, content: bytes, words: str):
    path = tmp_path / "x.bgcode"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words):
        measure_gcode(path)


def test_its_settings_reach_a_slicer_without_commands(tmp_path: Path):
    path = tmp_path / "a.bgcode"
    own = b"perimeters=3\npost_process=touch /tmp/never\nfilament_density=1.3\nBad Key=1\n"
    path.write_bytes(binary(TEXT, own))
    loaded = without_commands(path, tmp_path)
    assert loaded.suffix == ".ini"
    assert loaded.read_text() == "perimeters = 3\nfilament_density = 1.3\n"
    assert sets_density(path) and sets_density(CUBE)
    with CUBE.open("rb") as file:
        assert settings_of(file, "cube")["layer_height"] == "0.3"


@given(st.data())
def test_any_damage_ends_in_an_error_or_in_text(tmp_path_factory, data):
    """One file with bytes changed, removed or put in: no other exception, and bounded output."""
    content = bytearray(binary(TEXT[:600], how=data.draw(st.integers(0, 3)), checksum=False))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    path = tmp_path_factory.getbasetemp() / "fuzzed.bgcode"
    path.write_bytes(content)
    try:
        with path.open("rb") as file:
            size = sum(len(piece) for piece in text_of(file, path.name))
        assert size <= 2100 * len(content)  # deflate's limit, unpacked once more
        measure_gcode(path)
    except InputError:
        pass
