"""Judges that are not our code: lib3mf reads the file, libigl measures walls and outside."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import igl
import lib3mf
import numpy as np
import trimesh
from numpy.typing import NDArray

Float = NDArray[np.float64]
Int = NDArray[np.int64]
CONFIG = "Metadata/Slic3r_PE_model.config"


@dataclass(frozen=True, eq=False)
class Mesh:
    """vertices (n, 3) float64 mm, faces (m, 3) int64."""

    vertices: Float
    faces: Int


def read_strictly(path: Path, *, everything: bool = False) -> tuple[Mesh, list[str]]:
    """The one mesh of a 3MF as lib3mf reads it in strict mode, and its warnings.

    Triangles that PrusaSlicer's config names as no material (support blockers, modifiers) are left
    out, unless ``everything`` is asked for.
    """
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    warnings = [reader.GetWarning(i)[0] for i in range(reader.GetWarningCount())]
    objects = model.GetMeshObjects()
    assert objects.MoveNext()
    found = objects.GetCurrentMeshObject()
    vertices = np.array([tuple(v.Coordinates) for v in found.GetVertices()], dtype=float)
    faces = np.array([tuple(t.Indices) for t in found.GetTriangleIndices()], dtype=np.int64)
    assert not objects.MoveNext()
    if not everything:
        faces = faces[_material(path, len(faces))]
        used = np.unique(faces)
        vertices, faces = vertices[used], np.searchsorted(used, faces)
    return Mesh(vertices, faces), warnings


def _material(path: Path, count: int) -> NDArray[np.bool_]:
    """(count,) whether each triangle is material, by PrusaSlicer's config."""
    material = np.ones(count, dtype=bool)
    with zipfile.ZipFile(path) as package:
        if CONFIG not in package.namelist():
            return material
        config = ElementTree.fromstring(package.read(CONFIG))
    for volume in config.iter("volume"):
        settings = {item.get("key"): item.get("value") for item in volume.iter("metadata")}
        if settings.get("volume_type") != "ModelPart":
            material[int(volume.get("firstid", 0)) : int(volume.get("lastid", -1)) + 1] = False
    return material


def outside_and_cavities(mesh: Mesh) -> tuple[Mesh, Mesh | None]:
    """Shells of positive volume, and those of negative volume together (None without any)."""
    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    outside, inside = [], []
    for shell in whole.split(only_watertight=False):
        (outside if shell.volume > 0 else inside).append(shell)
    return _joined(outside), _joined(inside) if inside else None


def thinnest_wall_mm(mesh: Mesh) -> float | None:
    """Least distance between cavity and outside, vertices of each against the other's triangles."""
    outside, inside = outside_and_cavities(mesh)
    if inside is None:
        return None
    return min(farthest(outside, inside).min(), farthest(inside, outside).min())


def farthest(points_of: Mesh, surface: Mesh) -> Float:
    """(n,) distances of one mesh's vertices to another's surface."""
    squared, _, _ = igl.point_mesh_squared_distance(
        points_of.vertices, surface.vertices, surface.faces
    )
    return np.sqrt(squared)


def samples(mesh: Mesh, count: int = 20000) -> Float:
    """(count, 3) points on a mesh, the same ones every time."""
    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    points, _ = trimesh.sample.sample_surface(whole, count, seed=0)
    return np.asarray(points)


def _joined(shells: list[trimesh.Trimesh]) -> Mesh:
    whole = trimesh.util.concatenate(shells)
    return Mesh(
        np.ascontiguousarray(whole.vertices, dtype=float),
        np.ascontiguousarray(whole.faces, dtype=np.int64),
    )
