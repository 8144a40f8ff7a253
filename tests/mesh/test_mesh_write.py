"""Each format read back by our reader and by trimesh, the same bytes each time."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mesh_bodies import box, inside_out, joined

from printprep.errors import OutputError
from printprep.mesh.measure import arrays, from_arrays
from printprep.mesh.read import read_mesh
from printprep.mesh.write import to_bytes

MESH = joined(box((0, 0, 0), (1 / 3, 2, 3)), inside_out(box((0.1, 0.1, 0.1), (0.2, 1, 1))))


@pytest.mark.parametrize(("suffix", "digits"), [(".stl", 1e-7), (".obj", 0), (".ply", 0)])
def test_round_trip(tmp_path: Path, suffix: str, digits: float) -> None:
    part = from_arrays(*MESH)
    data = to_bytes(part, suffix)
    assert data == to_bytes(part, suffix.upper())
    path = tmp_path / f"part{suffix}"
    path.write_bytes(data)
    found = read_mesh(path)
    vertices, faces = arrays(part)
    assert found.vertices[found.faces] == pytest.approx(vertices[faces], abs=digits)
    assert from_arrays(found.vertices, found.faces).volume() == pytest.approx(part.volume())
    other = trimesh.load_mesh(io.BytesIO(data), file_type=suffix[1:])
    assert other.is_watertight
    assert other.volume == pytest.approx(part.volume(), rel=1e-6)


def test_stl_is_not_taken_for_text_and_has_unit_normals() -> None:
    data = to_bytes(from_arrays(*MESH), ".stl")
    assert not data.lower().startswith(b"solid")
    assert len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
    normals = np.frombuffer(data, dtype="<f4", offset=84, count=3)
    assert np.linalg.norm(normals) == pytest.approx(1)


def test_other_suffixes_are_refused() -> None:
    with pytest.raises(OutputError, match=r"\.step"):
        to_bytes(from_arrays(*MESH), ".step")
