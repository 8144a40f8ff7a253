"""Every format and unit; every refusal names the file, the fact and exit code 3."""

from __future__ import annotations

import os
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mesh_bodies import box, joined

from printprep.errors import InputError, UsageError
from printprep.mesh.measure import from_arrays, signed_volumes
from printprep.mesh.place import place
from printprep.mesh.read import from_trimesh, read_mesh
from printprep.mesh.weld import edge_counts, weld
from printprep.mesh.write import to_bytes

BOX = box((0, 0, 0), (1, 2, 3))


def volume(path: Path, units: str | None = None) -> float:
    raw = read_mesh(path, units)
    assert edge_counts(raw.faces).open_edges == 0
    return float(signed_volumes(raw.vertices[raw.faces]).sum())


def ascii_stl(vertices: np.ndarray, faces: np.ndarray) -> str:
    lines = ["solid 方 facet"]
    for corners in vertices[faces].tolist():
        lines += ["facet normal 0 0 nonsense", " outer loop"]
        lines += [f"  vertex {x} {y} {z}" for x, y, z in corners]
        lines += [" endloop with words", "endfacet"]
    return "\n".join([*lines, "endsolid", ""])


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".STL"])
def test_formats_in_mm(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"box{suffix}"
    path.write_bytes(to_bytes(from_arrays(*BOX), suffix))
    assert volume(path) == pytest.approx(6)
    assert volume(path, "cm") == pytest.approx(6e3)
    assert volume(path, "in") == pytest.approx(6 * 25.4**3)
    raw = read_mesh(path, "m")
    assert raw.name == "box"
    assert raw.from_file.tolist() == np.diag([1000.0, 1000, 1000, 1]).tolist()


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_ascii_stl_with_any_line_end_and_several_solids(tmp_path: Path, end: str) -> None:
    path = tmp_path / "box.stl"
    text = ascii_stl(*BOX) + ascii_stl(*box((5, 0, 0), (6, 1, 1)))
    path.write_bytes(text.replace("\n", end).encode())
    assert volume(path) == pytest.approx(7)


def test_binary_stl_that_begins_with_solid(tmp_path: Path) -> None:
    path = tmp_path / "box.stl"
    data = to_bytes(from_arrays(*BOX), ".stl")
    path.write_bytes(b"solid \xff\xfe made by".ljust(80) + data[80:])
    assert volume(path) == pytest.approx(6)
    path.write_bytes(data + b"\0\0trailing")
    assert volume(path) == pytest.approx(6)


def test_obj_as_people_write_it(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    path.write_text(
        "# quads, seams, names from the end, colours, a continued line, no material file\n"
        "mtllib nowhere.mtl\no box\n"
        "v 0 0 0 nan nan nan\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvn 0 0 1\n"
        "usemtl stone\nf 4/1/1 3/1/1 2/1/1 1/1/1\nf -4 -3 -2 -1\n"
        "f 1//1 2//1 6//1 \\\n5//1\nf 2 3 7 6\nf 3 4 8 7\n\tf 4 1 5 8 # last\n"
    )
    assert volume(path) == pytest.approx(1)


def test_glb_is_metres_and_y_up(tmp_path: Path) -> None:
    path = tmp_path / "box.glb"
    mesh = trimesh.Trimesh(*box((0, 0, 0), (0.01, 0.02, 0.03)), process=False)
    path.write_bytes(mesh.export(file_type="glb"))
    raw = read_mesh(path)
    assert raw.up_hint == "+y"
    assert np.ptp(raw.vertices, axis=0) == pytest.approx([10, 30, 20])
    model = place(raw)
    assert model.vertices[:, 2].max() == pytest.approx(20)
    file_corner = np.array([0.01, 0.02, 0.03, 1])
    assert (model.placement @ file_corner)[2] == pytest.approx(20)
    assert np.ptp(read_mesh(path, "mm").vertices, axis=0) == pytest.approx([0.01, 0.03, 0.02])


def test_scene_bodies_come_with_their_transforms_even_mirrored(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    mesh = trimesh.Trimesh(*box((0, 0, 0), (1, 1, 1)), process=False)
    scene.add_geometry(mesh, node_name="one")
    mirror = np.diag([-1.0, 1, 1, 1])
    mirror[0, 3] = -3
    scene.add_geometry(mesh, node_name="two", transform=mirror)
    raw = from_trimesh(scene, "two boxes")
    assert np.ptp(raw.vertices, axis=0) == pytest.approx([5, 1, 1])
    assert signed_volumes(raw.vertices[raw.faces]).sum() == pytest.approx(2)
    path = tmp_path / "scene.glb"
    path.write_bytes(scene.export(file_type="glb"))
    assert volume(path, "mm") == pytest.approx(2)


def test_trimesh_units_are_honoured() -> None:
    mesh = trimesh.Trimesh(*BOX, process=False)
    assert np.ptp(from_trimesh(mesh).vertices, axis=0) == pytest.approx([1, 2, 3])
    mesh.units = "inches"
    assert np.ptp(from_trimesh(mesh).vertices, axis=0) == pytest.approx([25.4, 50.8, 76.2])
    assert np.ptp(from_trimesh(mesh, units="cm").vertices, axis=0) == pytest.approx([10, 20, 30])
    mesh.units = "parsnips"
    with pytest.raises(InputError, match="parsnips"):
        from_trimesh(mesh)


@pytest.mark.corpus
def test_3mf_has_its_own_unit(models_dir: Path) -> None:
    path = models_dir / "3mf/mustpass/MUSTPASS_Chapter4.2_Components.3mf"
    own = read_mesh(path)
    assert edge_counts(own.faces).open_edges == 0
    inches = read_mesh(path, "in")
    assert inches.vertices == pytest.approx(own.vertices * 25.4 / own.from_file[0, 0])
    corner = np.append(np.linalg.solve(own.from_file, [*own.vertices[0], 1])[:3], 1)
    assert (inches.from_file @ corner)[:3] == pytest.approx(inches.vertices[0])


def test_weld_joins_equal_corners_and_drops_what_collapses() -> None:
    vertices, faces = BOX
    soup = vertices[faces].reshape(-1, 3)
    soup[0] = soup[0] + 0.0 * -1.0
    extra = np.vstack([np.arange(36).reshape(-1, 3), [[0, 0, 1]]])
    welded, kept = weld(np.vstack([soup, [[9, 9, 9]]]), extra)
    assert len(welded) == 8
    assert len(kept) == 12
    assert welded[kept] == pytest.approx(vertices[faces])


def test_weld_mends_float32_noise_only_where_the_surface_is_open() -> None:
    vertices, faces = BOX
    noise = np.random.default_rng(3).uniform(-1e-7, 1e-7, (36, 3))
    welded, kept = weld(vertices[faces].reshape(-1, 3) + noise, np.arange(36).reshape(-1, 3))
    assert edge_counts(kept).open_edges == 0
    assert len(welded) == 8
    gap, _ = weld(vertices[faces].reshape(-1, 3) + 1e4 * noise, np.arange(36).reshape(-1, 3))
    assert len(gap) == 36
    two = joined(BOX, box((1 + 2e-7, 0, 0), (2, 2, 3)))
    assert len(weld(*two)[0]) == 16


def refused(path: Path, fact: str) -> None:
    with pytest.raises(InputError, match=fact) as caught:
        read_mesh(path)
    assert path.name in caught.value.message
    assert "\n" not in caught.value.message
    assert caught.value.exit_code == 3


STL = to_bytes(from_arrays(*BOX), ".stl")


@pytest.mark.parametrize(
    ("name", "data", "fact"),
    [
        ("a.stl", b"", "0 bytes"),
        ("a.obj", b"", "0 bytes"),
        ("a.stl", STL[:-1], "cut short: it holds 11 whole facets, its header names 12"),
        ("a.stl", STL[:300], "cut short"),
        ("a.stl", b"\0" * 40, "cut short"),
        ("a.stl", STL[:80] + bytes(4), "no triangles"),
        ("a.stl", b"solid a\nendsolid a\n", "no triangles"),
        ("a.stl", b"0.1 0.2 0.3\n" * 50, "not an STL file"),
        ("a.stl", b"solid\n facet\n outer loop\n vertex 0 0\n", "line 4"),
        ("a.stl", b"solid\n facet\n outer loop\n vertex 0 0 x\n", "three numbers"),
        ("a.stl", b"solid\n outer loop\n vertex 0 0 1\n vertex 0 1 0\n endloop\n", "2 corners"),
        ("a.stl", b"solid\n outer loop\n vertex 0 0 1\n", "cut short"),
        ("a.stl", b"solid\n ticket 5\n vertix 0 0 1\n endsolid x\nbogus\n", "not a word of an STL"),
        (
            "a.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
            "line 4: a face uses vertex 4, the file has 3",
        ),
        ("a.obj", b"v 0 0 0\nf 1 2\n", "2 corners"),
        ("a.obj", b"v 0 0 0\nf 0 1 1\n", "before the first"),
        ("a.obj", b"v 0 0 0\nf -1 -2 -1\n", "before the first"),
        ("a.obj", b"v 0 zero 0\n", "line 1: a vertex"),
        ("a.obj", b"v 0 0 0\nf a b c\n", "not a whole number"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n", "no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n", "1 corner whose .* not finite"),
        (
            "a.obj",
            b"v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n",
            "no triangles with three different corners",
        ),
        ("a.ply", b"ply\nnot really\n", "PLY"),
        ("a.ply", to_bytes(from_arrays(*BOX), ".ply")[:250], "PLY"),
        ("a.glb", b"glTF" + struct.pack("<II", 2, 12), "GLB"),
        ("a.glb", b"no such thing", "GLB"),
        ("a.gltf", b"{", "GLTF"),
        ("a.3mf", b"no zip", "3mf"),
        ("a.step", b"ISO-10303-21;", r"suffix is \.step"),
        ("a", STL, "suffix is missing"),
    ],
)
def test_refusals(tmp_path: Path, name: str, data: bytes, fact: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    refused(path, fact)


def test_not_finite_in_binary_stl(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    data = bytearray(STL)
    struct.pack_into("<f", data, 84 + 12, float("nan"))
    path.write_bytes(data)
    refused(path, "not finite")


# In single precision, a NaN that announces itself: numpy warns when it is cast
SIGNALLING_NAN = b"\x01\x00\x80\x7f"


def test_a_signalling_nan_is_refused_without_a_warning(tmp_path: Path) -> None:
    # fuzz: numpy's RuntimeWarning of the cast reached the terminal for PLY
    stl = tmp_path / "a.stl"
    stl.write_bytes(STL[:96] + SIGNALLING_NAN + STL[100:])
    refused(stl, "not finite")
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 8\n"
        "property float x\nproperty float y\nproperty float z\n"
        "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
    )
    vertices, faces = BOX
    corners = np.asarray(vertices, "<f4").tobytes()
    rows = b"".join(struct.pack("<B3i", 3, *face) for face in np.asarray(faces).tolist())
    ply = tmp_path / "a.ply"
    ply.write_bytes(header.encode() + SIGNALLING_NAN + corners[4:] + rows)
    refused(ply, "not finite")


def test_missing_folder_and_unreadable(tmp_path: Path) -> None:
    refused(tmp_path / "nowhere.stl", "does not exist")
    refused(tmp_path, "is a folder")
    if sys.platform != "win32" and os.geteuid() != 0:
        path = tmp_path / "locked.stl"
        path.write_bytes(STL)
        path.chmod(0)
        refused(path, "cannot be read")


def test_gltf_may_not_name_files_outside_its_folder(tmp_path: Path) -> None:
    mesh = trimesh.Trimesh(*BOX, process=False)
    files = trimesh.Scene(mesh).export(file_type="gltf")
    inner = tmp_path / "inner"
    inner.mkdir()
    for name, data in files.items():
        folder = inner if name.endswith(".gltf") else tmp_path
        text = data.replace(b'"uri":"', b'"uri":"../').replace(b'"uri": "', b'"uri": "../')
        (folder / name).write_bytes(text if name.endswith(".gltf") else data)
    refused(inner / "model.gltf", "GLTF")


def test_unknown_units(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    path.write_bytes(STL)
    with pytest.raises(UsageError, match="ft"):
        read_mesh(path, "ft")
