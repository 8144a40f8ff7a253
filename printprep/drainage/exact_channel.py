"""Measure one channel exactly: its whole rim comes out, once, and breaks out nowhere else."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.channel import Channel, frame
from printprep.drainage.hole_candidates import LEAST_COSINE, LONGEST_MM

if TYPE_CHECKING:
    from printprep.drainage.hole_candidates import Candidate
    from printprep.grid.distance import Surface

LINES = 24
STEP_MM = 0.1
# The drill goes so far through air beyond the last point of its rim.
BEYOND_MM = 0.3
CLEAR_MM = 1.0


def exact_channel(
    candidate: Candidate,
    outside: Surface,
    void: Surface,
    diameter_mm: float,
    wall_mm: float,
    clearance_mm: float,
) -> Channel | None:
    """Build the channel along a candidate; None where it is not clean.

    outside : surface of the part without its cavities;  void : surface of the cavities.
    """
    radius = diameter_mm / 2
    across = frame(candidate.axis)[:, :2]
    turn = np.arange(LINES) * 2 * np.pi / LINES
    rim = radius * (np.outer(np.cos(turn), across[:, 0]) + np.outer(np.sin(turn), across[:, 1]))
    lines = np.vstack([np.zeros((1, 3)), rim])
    t = np.arange(0.0, LONGEST_MM + 4 * radius, STEP_MM)
    axis_depth = outside.depth_mm(candidate.inner_mm + t[:, None] * candidate.axis)
    come_out = np.flatnonzero(axis_depth < 0)
    if not len(come_out):
        return None
    t = t[: come_out[0] + int(4 * radius / STEP_MM) + 1]
    points = candidate.inner_mm + lines[:, None] + t[None, :, None] * candidate.axis
    depth = outside.depth_mm(points.reshape(-1, 3)).reshape(len(lines), len(t))
    air = depth < 0
    if not air[:, -1].all():
        return None
    exits = air.argmax(axis=1)
    end_mm = float(t[exits.max()]) + BEYOND_MM
    last = np.searchsorted(t, end_mm + CLEAR_MM)
    if last >= len(t):
        return None
    index = np.arange(len(t))
    after = (index >= exits[:, None]) & (index <= last)
    left = (exits[:, None] - index) * STEP_MM
    thin = depth < np.minimum(LEAST_COSINE * left, wall_mm / 2) - STEP_MM
    if (after & ~air).any() or (thin & (left > 0)).any():
        return None
    mouths = points[np.arange(len(lines)), exits]
    low = min(float(mouths[:, 2].min()), float(candidate.inner_mm[2]) - radius)
    if float(mouths[:, 2].min()) < clearance_mm:
        return None
    mouth_mm = float(t[exits[0]]) - STEP_MM / 2
    return Channel(
        inner_mm=candidate.inner_mm,
        axis=candidate.axis,
        diameter_mm=diameter_mm,
        mouth_mm=mouth_mm,
        end_mm=end_mm,
        length_mm=_in_material_mm(candidate, void, mouth_mm),
        low_mm=low,
    )


def _in_material_mm(candidate: Candidate, void: Surface, mouth_mm: float) -> float:
    fine = np.arange(0.0, mouth_mm, STEP_MM / 4)
    inside = void.contains(candidate.inner_mm + fine[:, None] * candidate.axis)
    return float((~inside).sum() * STEP_MM / 4)
