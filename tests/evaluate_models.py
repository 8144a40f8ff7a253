"""Small models for the evaluation: boxes as OBJ text, and solids of voxels."""

from __future__ import annotations

from pathlib import Path

import numpy as np

_FACES = (
    (1, 3, 4), (1, 4, 2), (5, 6, 8), (5, 8, 7), (1, 2, 6), (1, 6, 5), (3, 7, 8), (3, 8, 4),
    (1, 5, 7), (1, 7, 3), (2, 4, 8), (2, 8, 6),
)  # fmt: skip


def box_arrays(low: tuple[float, ...], high: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (8, 3) and faces (12, 3), seen from outside, of a box."""
    corners = [[(low, high)[k][0], (low, high)[j][1], (low, high)[i][2]]
               for i in (0, 1) for j in (0, 1) for k in (0, 1)]  # fmt: skip
    return np.array(corners, dtype=float), np.array(_FACES, dtype=np.int64) - 1


def write_boxes(path: Path, *boxes: tuple[tuple[float, ...], tuple[float, ...]]) -> Path:
    """An OBJ file of boxes, each given by its lowest and highest corner."""
    lines = []
    for number, (low, high) in enumerate(boxes):
        vertices, faces = box_arrays(low, high)
        lines += [f"v {x} {y} {z}" for x, y, z in vertices]
        lines += ["f " + " ".join(str(c + 1 + 8 * number) for c in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def voxel_box(shape: tuple[int, int, int], low: tuple[int, ...], high: tuple[int, ...]):
    """(nx, ny, nz) bool, true from low up to, not including, high."""
    occupied = np.zeros(shape, dtype=bool)
    occupied[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = True
    return occupied


def random_voxels(seed: int, edge: int = 14) -> np.ndarray:
    """(edge, edge, edge) bool: a foot, and two overhanging boxes on it."""
    rng = np.random.default_rng(seed)
    middle = edge // 2
    occupied = np.zeros((edge,) * 3, dtype=bool)
    half = int(rng.integers(1, 3))
    occupied[middle - half : middle + half, middle - half : middle + half, 1 : edge - 2] = True
    for _ in range(2):
        low = rng.integers(1, middle, 3)
        low[2] = rng.integers(2, middle)
        high = rng.integers(middle + 1, edge - 1, 3)
        occupied[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = True
    return occupied
