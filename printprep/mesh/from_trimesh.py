"""Triangles of trimesh's objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import InputError

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


def arrays_of(mesh: Any, what: str) -> tuple[Float, Int]:
    """Vertices (n, 3) and triangles (m, 3) of a trimesh object; a scene's bodies are placed.

    Raises InputError, which begins with ``what``, for a face whose vertex does not exist.
    """
    if hasattr(mesh, "to_mesh"):  # a Scene
        mesh = mesh.to_mesh()
    vertices = np.array(getattr(mesh, "vertices", ()), dtype=np.float64)
    faces = np.array(getattr(mesh, "faces", ()), dtype=np.int64)
    if len(faces) and not (vertices.shape[1:] == faces.shape[1:] == (3,)):
        raise InputError(
            f"{what} has corners without three coordinates, or faces without three corners.",
            "Export the model again, or export it in another format.",
        )
    vertices, faces = vertices.reshape(-1, 3), faces.reshape(-1, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise InputError(
            f"{what} has a face that uses a vertex which does not exist.",
            "Export the model again, or export it in another format.",
        )
    return vertices, faces
