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


def box() -> np.ndarray:
    """(16, 16, 16) bool: a cube of 10 voxels from index 3 to 12 on each axis."""
    occupied = np.zeros((16, 16, 16), dtype=bool)
    occupied[3:13, 3:13, 3:13] = True
    return occupied


def random_solid(seed: int, edge: int = 12) -> np.ndarray:
    """(edge, edge, edge) bool: a few overlapping boxes and balls, with at least one voxel."""
    rng = np.random.default_rng(seed)
    index = np.stack(np.meshgrid(*[np.arange(edge)] * 3, indexing="ij"), axis=-1)
    occupied = np.zeros((edge,) * 3, dtype=bool)
    for _ in range(rng.integers(1, 4)):
        centre = rng.uniform(edge * 0.25, edge * 0.75, 3)
        size = rng.uniform(edge * 0.15, edge * 0.4, 3)
        offset = np.abs(index - centre) / size
        ball = rng.random() < 0.5
        occupied |= (offset**2).sum(axis=-1) <= 1 if ball else (offset <= 1).all(axis=-1)
    occupied[edge // 2, edge // 2, edge // 2] = True
    return occupied
