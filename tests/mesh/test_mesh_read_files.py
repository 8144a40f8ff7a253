"""STL and PLY as people have them: counts that are wrong, files cut short, marks, odd numbers."""

from __future__ import annotations

import codecs
import itertools
import os
import resource
import struct
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_bodies import box

from printprep.errors import GeometryError, InputError, UsageError
from printprep.mesh.measure import from_arrays, signed_volumes
from printprep.mesh.place import place
from printprep.mesh.read import Choice, read_mesh
from printprep.mesh.weld import edge_counts, weld
from printprep.mesh.write import to_bytes

BOX = box((0, 0, 0), (1, 2, 3))
SOLID = from_arrays(*BOX)
STL = to_bytes(SOLID, ".stl")
FACETS = 12
OPEN = STL[:80] + struct.pack("<I", FACETS - 1) + STL[84:-50]
TEXT = "\n".join(
    ["solid box"]
    + [
        line
        for corners in BOX[0][BOX[1]].tolist()
        for line in (
            "facet normal 0 0 0",
            "outer loop",
            *(f"vertex {x} {y} {z}" for x, y, z in corners),
            "endloop",
            "endfacet",
        )
    ]
    + ["endsolid box", ""]
)
OBJ = to_bytes(SOLID, ".obj")


def counting(count: int, data: bytes = STL) -> bytes:
    return data[:80] + struct.pack("<I", count) + data[84:]


def read(folder: Path, name: str, data: bytes, **choice: object):
    path = folder / name
    path.write_bytes(data)
    return read_mesh(path, choice=Choice(**choice))  # type: ignore[arg-type]


def volume(raw) -> float:
    assert edge_counts(raw.faces).open_edges == 0
    return float(signed_volumes(raw.vertices[raw.faces]).sum())


def kinds(raw) -> list[str]:
    return [note.kind for note in raw.notes]


@pytest.mark.parametrize("count", [0, 1, FACETS - 2, FACETS + 1, 10**6, 2**31 - 1, 2**32 - 1])
def test_the_number_of_facets_comes_from_the_size_of_the_file(tmp_path: Path, count: int) -> None:
    raw = read(tmp_path, "a.stl", counting(count))
    assert volume(raw) == pytest.approx(6)
    assert kinds(raw) == ["facet-count"]
    assert f"the file has {FACETS}; all {FACETS} were read" in raw.notes[0].message
    assert str(tmp_path) not in raw.notes[0].message
    assert read(tmp_path, "a.stl", STL).notes == ()


@pytest.mark.parametrize("count", [0, 2**31 - 1, 2**32 - 1])
def test_what_a_streaming_program_writes_is_no_promise(tmp_path: Path, count: int) -> None:
    raw = read(tmp_path, "a.stl", counting(count, OPEN))
    assert len(raw.faces) == FACETS - 1
    assert kinds(raw) == ["facet-count"]


def test_bytes_after_the_last_facet_are_no_facets(tmp_path: Path) -> None:
    raw = read(tmp_path, "a.stl", STL + b"made by a program that leaves a line of its own" * 3)
    assert volume(raw) == pytest.approx(6)
    assert kinds(raw) == ["facet-count"]
    raw = read(tmp_path, "a.stl", STL + b"\xff" * 100)  # 100 = two records, of not finite numbers
    assert volume(raw) == pytest.approx(6)
    assert "100 bytes after the last facet" in raw.notes[0].message


@pytest.mark.parametrize(
    "data",
    [STL[:-1], STL[:-50], STL[:-70], counting(0, STL)[:-20], counting(2**32 - 1, STL)[:-20]],
)
def test_a_file_cut_short_is_taken_only_when_asked_for(tmp_path: Path, data: bytes) -> None:
    there = (len(data) - 84) // 50
    with pytest.raises(InputError, match=f"cut short: it holds {there} whole facets") as caught:
        read(tmp_path, "a.stl", data)
    assert "--partial" in (caught.value.hint or "")
    raw = read(tmp_path, "a.stl", data, partial=True)
    assert len(raw.faces) == there
    assert kinds(raw) == ["cut-short"]
    assert read(tmp_path, "b.stl", STL, partial=True).notes == ()


def test_text_cut_short_is_taken_only_when_asked_for(tmp_path: Path) -> None:
    third = TEXT.split("endfacet")
    whole = "endfacet".join(third[:4]) + "endfacet\n"
    for cut in (whole, whole + "facet normal 0 0 0\nouter loop\nvertex 1", TEXT[:400], TEXT[:401]):
        with pytest.raises(InputError, match="cut short"):
            read(tmp_path, "a.stl", cut.encode())
        raw = read(tmp_path, "a.stl", cut.encode(), partial=True)
        assert kinds(raw) == ["cut-short"]
        assert len(raw.faces) == cut.count("endloop\n")
    for end in ("", "endsol", "endsolid"):
        raw = read(tmp_path, "a.stl", (TEXT.removesuffix("endsolid box\n") + end).encode())
        assert volume(raw) == pytest.approx(6)


MARKS = [
    codecs.BOM_UTF8,
    codecs.BOM_UTF16_LE,
    codecs.BOM_UTF16_BE,
]


@pytest.mark.parametrize("mark", MARKS)
@pytest.mark.parametrize(("name", "text"), [("a.stl", TEXT), ("a.obj", OBJ.decode())])
def test_a_mark_of_the_byte_order_is_no_text(
    tmp_path: Path, mark: bytes, name: str, text: str
) -> None:
    encoding = {MARKS[0]: "utf-8", MARKS[1]: "utf-16-le", MARKS[2]: "utf-16-be"}[mark]
    raw = read(tmp_path, name, mark + text.replace("box", "Kästchen").encode(encoding))
    assert volume(raw) == pytest.approx(6)


def test_numbers_that_only_python_takes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"line \d: a corner is not three numbers: 1_0"):
        read(tmp_path, "a.stl", TEXT.replace("vertex 1.0", "vertex 1_0", 1).encode())
    assert volume(read(tmp_path, "a.stl", TEXT.replace("box", "my_box").encode())) == (
        pytest.approx(6)
    )
    for text in ("v 0 0 1_0\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0_3\n"):
        with pytest.raises(InputError, match="number"):
            read(tmp_path, "a.obj", text.encode())
    with pytest.raises(InputError, match="line 4"):
        read(tmp_path, "a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n")
    with pytest.raises(InputError, match="which no file has"):
        read(tmp_path, "a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9999999999999999999\n")


def test_colours_that_are_not_read_are_named(tmp_path: Path) -> None:
    two = b"usemtl red\n" + OBJ.replace(b"\nf ", b"\nusemtl blue\nf ", 1)
    assert kinds(read(tmp_path, "a.obj", two)) == ["colours-lost"]
    coloured = b"\n".join(
        line + b" 1 0 0" if line.startswith(b"v ") else line for line in OBJ.split(b"\n")
    )
    assert kinds(read(tmp_path, "a.obj", coloured)) == ["colours-lost"]
    assert kinds(read(tmp_path, "a.obj", b"usemtl red\n" + OBJ)) == []


def test_colours_of_an_stl_are_named_as_lost(tmp_path: Path) -> None:
    assert kinds(read(tmp_path, "a.stl", b"COLOR=".ljust(80) + STL[80:])) == []
    magics = b"COLOR=".ljust(80) + STL[80:132] + struct.pack("<H", 0x1F) + STL[134:]
    assert kinds(read(tmp_path, "a.stl", magics)) == ["colours-lost"]
    viscam = STL[:132] + struct.pack("<H", 0x801F) + STL[134:]
    assert kinds(read(tmp_path, "a.stl", viscam)) == ["colours-lost"]
    assert kinds(read(tmp_path, "a.stl", counting(0, viscam))) == ["facet-count", "colours-lost"]


def test_plates_and_objects_are_of_3mf_files_alone(tmp_path: Path) -> None:
    for choice in ({"plate": 1}, {"item": "box"}):
        with pytest.raises(UsageError, match="only a 3MF has plates and objects"):
            read(tmp_path, "a.stl", STL, **choice)


# --- PLY


def ply(order: str, faces: list[list[int]], more: str = "", rows: str = "") -> bytes:
    """A PLY of BOX's corners; order "", "<" or ">"."""
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\nformat {name} 1.0\ncomment TextureFile /etc/passwd\n"
        f"element vertex {len(BOX[0])}\nproperty float x\nproperty double y\nproperty float z\n"
        f"{more}element face {len(faces)}\nproperty uchar flags\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    if not order:
        lines = [" ".join(f"{value:g}" for value in row) + rows for row in BOX[0].tolist()]
        lines += [" ".join(map(str, [7, len(face), *face])) for face in faces]
        return (head + "\n".join(lines) + "\n").encode()
    body = b"".join(struct.pack(f"{order}fdf", *row) for row in BOX[0].tolist())
    body += b"".join(struct.pack(f"{order}BB{len(face)}i", 7, len(face), *face) for face in faces)
    return head.encode() + body


def polygons(mixed: bool) -> list[list[int]]:
    """BOX's triangles, or two of its sides as quads and the rest as triangles, alternating."""
    triangles = [list(face) for face in BOX[1].tolist()]
    if not mixed:
        return triangles
    merged = []
    for one, other in zip(triangles[0:4:2], triangles[1:4:2], strict=True):
        shared = [corner for corner in one if corner in other]
        lone = next(corner for corner in other if corner not in one)
        at = next(k for k in range(3) if {one[k], one[(k + 1) % 3]} == set(shared))
        merged.append([*one[: at + 1], lone, *one[at + 1 :]])
    rest = triangles[4:]
    return [rest[0], merged[0], rest[1], merged[1], *rest[2:]]


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("mixed", [False, True])
def test_ply_in_all_orders_with_triangles_and_polygons(
    tmp_path: Path, order: str, mixed: bool
) -> None:
    assert volume(read(tmp_path, "a.ply", ply(order, polygons(mixed)))) == pytest.approx(6)


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("mixed", [False, True])
def test_ply_cut_short_says_how_many_faces_are_there(
    tmp_path: Path, order: str, mixed: bool
) -> None:
    whole = ply(order, polygons(mixed))
    data = whole[:-2] if order else whole[: whole.rstrip().rfind(b"\n")] + b"\n7 3 0"
    faces = len(polygons(mixed)) - 1
    with pytest.raises(InputError, match=f"cut short: it holds {faces} whole faces"):
        read(tmp_path, "a.ply", data)
    raw = read(tmp_path, "a.ply", data, partial=True)
    assert kinds(raw) == ["cut-short"]
    assert len(raw.faces) == FACETS - 1


def test_ply_with_other_elements_and_colours(tmp_path: Path) -> None:
    whole = ply("", polygons(False))
    extra = whole.replace(
        b"element vertex", b"element camera 2\nproperty list uchar float v\nelement vertex"
    ).replace(b"end_header\n", b"end_header\n2 1 2\n0\n")
    assert volume(read(tmp_path, "a.ply", extra)) == pytest.approx(6)
    coloured = whole.replace(
        b"property float z\n",
        b"property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
    )
    lines = coloured.split(b"end_header\n")
    rows = lines[1].split(b"\n")
    rows[:8] = [row + b" 1 2 3" for row in rows[:8]]
    raw = read(tmp_path, "a.ply", lines[0] + b"end_header\n" + b"\n".join(rows))
    assert volume(raw) == pytest.approx(6)
    assert kinds(raw) == ["colours-lost"]


PLY_HEAD = "ply\nformat {} 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"


@pytest.mark.parametrize(
    ("data", "fact"),
    [
        (b"ply\nformat ascii 1.0\nelement vertex 99999999999999999\n", "has no end"),
        (
            b"ply\nformat ascii 1.0\nelement vertex 99999999999999999\nend_header\n",
            "promises 99999999999999999",
        ),
        (
            ply("<", polygons(False)).replace(b"list uchar int", b"list double double"),
            "no counts",
        ),
        (ply("<", polygons(False)).replace(b"list uchar int", b"list uchar float"), "no list"),
        (ply("<", polygons(False)).replace(b"vertex 8", b"vertex 999999999"), "cut short"),
        (ply("<", polygons(False)).replace(b"face 12", b"face 999999999"), "cut short"),
        (ply("", polygons(False)).replace(b"7 3 0", b"7 3 9", 1), "uses vertex 9"),
        (ply("", polygons(False)).replace(b"7 3 0", b"7 3 -1", 1), "uses vertex -1"),
        (ply("", [[0, 1]]), "2 corners"),
        (ply("<", [[0, 1]]), "2 corners"),
        (ply("", polygons(False)).replace(b"float z", b"float w"), "no x, y and z"),
        (b"ply\n" + b"x" * 100_000, "no end"),
    ],
)
def test_ply_refusals(tmp_path: Path, data: bytes, fact: str) -> None:
    with pytest.raises(InputError, match=fact):
        read(tmp_path, "a.ply", data)


# --- limits


def test_a_damaged_corner_is_named_not_welded_to_all(tmp_path: Path) -> None:
    """One corner at 1e9 among open facets: the tolerance of welding must not grow with it."""
    rng = np.random.default_rng(0)
    corners = rng.uniform(-50, 50, (30_000, 1, 3)) + rng.uniform(-1, 1, (30_000, 3, 3))
    corners[17, 1] = 1e9, 5, 6
    records = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    records["c"] = corners
    data = bytes(80) + struct.pack("<I", len(corners)) + records.tobytes()
    began = time.process_time()
    with pytest.raises(InputError, match=r"1 corner more than .* x = 1e\+09, y = 5, z = 6"):
        read(tmp_path, "a.stl", data)
    vertices, faces = corners.reshape(-1, 3), np.arange(90_000).reshape(-1, 3)
    vertices[::20] *= 1e9  # more than any quantile leaves out
    assert len(weld(vertices, faces)[1]) > 0
    assert time.process_time() - began < 3.0


@given(st.integers(0, 2**32), st.floats(0.0, 0.95))
def test_welding_joins_all_within_the_tolerance_and_none_far_beyond(
    seed: int, share: float
) -> None:
    vertices, faces = BOX
    size = float(np.quantile(np.abs(vertices).max(axis=1), 0.99))
    tolerance = 4 * 2.0**-24 * size
    rng = np.random.default_rng(seed)
    soup = vertices[faces].reshape(-1, 3)
    noisy = soup + rng.uniform(-share * tolerance / 2, share * tolerance / 2, soup.shape)
    welded, kept = weld(noisy, np.arange(36).reshape(-1, 3))
    assert (len(welded), len(kept)) == (8, 12)
    apart, _ = weld(soup + 100 * tolerance * np.arange(36)[:, None], np.arange(36).reshape(-1, 3))
    assert len(apart) == 36


@pytest.mark.parametrize("line", ["f", "v", "# "])
def test_a_line_without_end_is_refused_when_it_is_too_long(tmp_path: Path, line: str) -> None:
    data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + line.encode() + b" 1" * (3 << 20)
    began = time.process_time()
    with pytest.raises(InputError, match="line 4: the line has more than"):
        read(tmp_path, "a.obj", data)
    with pytest.raises(InputError, match="line 2: the line has more than"):
        read(tmp_path, "a.stl", b"solid a\nvertex" + b" 1" * (3 << 20))
    assert time.process_time() - began < 2.0


def test_more_triangles_than_any_model_has_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    with path.open("wb") as file:
        file.write(STL[:84])
        file.truncate(84 + 50 * 6_000_000)
    with pytest.raises(InputError, match="has 6000000 triangles; at most 5000000"):
        read_mesh(path)
    with path.open("wb") as file:
        file.truncate(20 << 30)
    with pytest.raises(InputError, match="has 20480 MiB; at most 1024 MiB"):
        read_mesh(path)
    for suffix in (".obj", ".ply", ".glb", ".3mf"):
        path = path.rename(path.with_suffix(suffix))
        with pytest.raises(InputError, match="20480 MiB"):
            read_mesh(path)


@pytest.mark.skipif(sys.platform == "win32", reason="has no devices in folders")
@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".glb", ".3mf"])
def test_what_has_no_end_is_refused(tmp_path: Path, suffix: str) -> None:
    device = tmp_path / f"zero{suffix}"
    device.symlink_to("/dev/zero")
    pipe = tmp_path / f"pipe{suffix}"
    os.mkfifo(pipe)
    for path in (device, pipe):
        with pytest.raises(InputError, match="is not a plain file"):
            read_mesh(path)


@pytest.mark.parametrize(
    ("factor", "what"),
    [(1e5, "too large"), (1e31, "too large"), (1e300, "too large"), (1e-6, "small"), (0, "small")],
)
def test_sizes_that_no_printer_prints_are_told_at_once(
    tmp_path: Path, factor: float, what: str
) -> None:
    vertices, faces = BOX
    raw = read(tmp_path, "a.obj", obj_of(vertices * (factor or 1e-319), faces))
    with pytest.raises(GeometryError, match=what) as caught:
        place(raw)
    assert "--units" in (caught.value.hint or "")
    if factor:
        assert np.ptp(place(raw, size_mm=60).vertices, axis=0).max() == pytest.approx(60)
    else:
        with pytest.raises(GeometryError, match="too small"):
            place(raw, size_mm=60)


def obj_of(vertices: np.ndarray, faces: np.ndarray) -> bytes:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join(lines).encode()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs the peak of a process")
@pytest.mark.parametrize(
    "name", ["face.obj", "vertex.stl", "many.obj", "many.stl", "alternating.ply"]
)
def test_large_files_take_memory_and_time_like_their_size(tmp_path: Path, name: str) -> None:
    """A face of 10^7 corners, a line of 100 MB, half a million facets as text."""
    content = {
        "face.obj": lambda: b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf" + b" 1 2 3" * 3_333_334,
        "vertex.stl": lambda: b"solid a\nfacet\nouter loop\nvertex " + b"0" * 100_000_000,
        "many.obj": lambda: b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f 1 2 3\n" * 1_000_000,
        "many.stl": lambda: TEXT.encode() * 40_000,
        "alternating.ply": lambda: ply(
            "<", list(itertools.islice(itertools.cycle([[0, 1, 2], [0, 1, 2, 3]]), 500_000))
        ),
    }[name]()
    path = tmp_path / name
    path.write_bytes(content)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    began = time.process_time()
    try:
        read_mesh(path)
    except InputError as error:
        assert name in error.message
    assert time.process_time() - began < 20.0
    grown_mib = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    assert grown_mib < 200 + 6 * len(content) / 2**20
