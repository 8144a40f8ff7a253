"""Occupancies for the tests of the paper's objective: dev models and random solids."""

from __future__ import annotations

from pathlib import Path

import numpy as np

TURN = {"+z": np.eye(3), "+y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])}


def voxelize(path: Path, up: str, resolution: int) -> np.ndarray:
    """(N, N, N) bool, z up: the model scaled to fill [-0.5, 0.5]³, inside by winding number."""
    import igl
    import trimesh

    mesh = trimesh.load(path, force="mesh", process=False)
    vertices = np.asarray(mesh.vertices, dtype=np.float64) @ TURN[up].T
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    vertices = (vertices - (low + high) / 2) / (high - low).max()
    axis = (np.arange(resolution) + 0.5) / resolution - 0.5
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    faces = np.asarray(mesh.faces, dtype=np.int64)
    winding = igl.fast_winding_number(vertices, faces, np.ascontiguousarray(points))
    return (winding > 0.5).reshape((resolution,) * 3)
