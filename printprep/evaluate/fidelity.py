"""Measure how close two surfaces are: F-score and Chamfer distance, as in the paper.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code:
10,000 points on each surface, one aligned to the other by ICP, τ = 0.05 in the unit cube; the
Chamfer distance is the mean of the two mean distances, not squared.  Two samples of one surface of
area A are about ½ √(A / 10,000) apart: no such figure is lower.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

SAMPLES = 10_000
TAU = 0.05
_ICP_ROUNDS = 50
_ICP_STILL = 1e-7  # stop when the mean squared distance falls by less than this share


@dataclass(frozen=True)
class Fidelity:
    """Closeness of two surfaces.

    f_score : in [0, 1], 1 best;  chamfer : in lengths of the unit cube, 0 best.
    """

    f_score: float
    chamfer: float


def fidelity(
    result: tuple[Float, Int], target: tuple[Float, Int], *, seed: int = 0, samples: int = SAMPLES
) -> Fidelity:
    """Compare two surfaces, each vertices (v, 3) and faces (f, 3); the seed makes it repeatable."""
    points = sample_surface(*result, samples, seed)
    others = sample_surface(*target, samples, seed + 1)
    return compare(aligned(points, others), others)


def compare(points: Float, others: Float, tau: float = TAU) -> Fidelity:
    """F-score at τ and Chamfer distance of two sets of points (n, 3), without alignment."""
    from scipy.spatial import cKDTree

    there, _ = cKDTree(others).query(points)
    back, _ = cKDTree(points).query(others)
    precision, recall = float(np.mean(there < tau)), float(np.mean(back < tau))
    both = precision + recall
    score = 2 * precision * recall / both if both else 0.0
    return Fidelity(score, float(there.mean() + back.mean()) / 2)


def sample_surface(vertices: Float, faces: Int, count: int, seed: int) -> Float:
    """(count, 3) random points, uniform over triangles.

    vertices : (v, 3);  faces : (f, 3).
    """
    generator = np.random.default_rng(seed)
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    until = np.cumsum(area)
    which = np.searchsorted(until, generator.random(count) * until[-1], side="right")
    which = np.minimum(which, len(faces) - 1)
    u, v = generator.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    points: Float = a[which] + u * (b - a)[which] + v * (c - a)[which]
    return points


def aligned(points: Float, others: Float) -> Float:
    """Move points (n, 3) rigidly onto others (m, 3) by iterated closest points.

    (Besl & McKay, 1992.)  Returns (n, 3).
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(others)
    moved = points
    before = np.inf
    for _ in range(_ICP_ROUNDS):
        distance, index = tree.query(moved)
        now = float(np.mean(distance**2))
        if before - now <= _ICP_STILL * now:
            break
        before = now
        moved = _onto(moved, others[index])
    return moved


def _onto(points: Float, partners: Float) -> Float:
    """Move points (n, 3) onto their partners (n, 3), by least squares over rotations and shifts.

    (Kabsch, 1976.)  Returns (n, 3).
    """
    middle, other = points.mean(axis=0), partners.mean(axis=0)
    left, _, right = np.linalg.svd((points - middle).T @ (partners - other))
    turn = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    result: Float = (points - middle) @ turn + other
    return result
