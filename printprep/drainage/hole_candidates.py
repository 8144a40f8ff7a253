"""Find where a hole costs least: straight ways from balls at rest in a cavity into the air.

A channel begins at a ball of its diameter that fits in the cavity, so that what reaches the ball
can follow it out.  Every ball and every direction is tried on the grid; the best are then measured
exactly (:mod:`printprep.drainage.exact_channel`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int
    from printprep.drainage.pools import Pools
    from printprep.drainage.voxelized_part import VoxelizedPart

Role = Literal["outlet", "vent"]

# At most so many balls are tried.
MOST_BALLS = 100
# An outlet falls at least this much on its way out, so that liquid runs in the real print too.
FALL_DEG = 3.0
AZIMUTHS = 24
FALLS_DEG = (FALL_DEG, 15.0, 30.0, 50.0, 70.0)
VENT_FALLS_DEG = (70.0, 50.0, 30.0, 10.0, -10.0, -30.0, -50.0, -70.0)
# A hole longer than this is not drilled.
LONGEST_MM = 30.0
# A channel farther from the surface's normal than the angle of this cosine cuts along the surface.
LEAST_COSINE = 0.35
# Two ways are alike when their mouths are this near and their axes have this cosine.
LIKE_MM = 3.0
LIKE_COSINE = 0.75
# A ball is out where it is this share of its radius away from material.
BALL_OUT = 0.8
# Costs and credits, in millimetres of channel.
UPWARD_MM = 10.0  # cost of a mouth that looks straight up, over one that looks straight down
CONVEX_MM = 2.0  # cost for each millimetre that the surface falls away around a mouth
RELIEF_MM = 4.0  # cost for each millimetre of unevenness around a mouth
FILLED_MM = 0.02  # cost for each cubic millimetre to fill below the channel
RUN_MM = 0.1  # cost for each millimetre that it runs through the cavity before the wall
SIGHT_MM = 0.05  # credit for each millimetre of cavity in line with the channel
FULL_SIGHT_MM = 60.0
AWAY_MM = 0.1  # credit for each millimetre between a vent and the nearest outlet
DEPTH_MM = 0.3  # cost for each millimetre that a vent lies below the cavity's top


@dataclass(frozen=True, eq=False)
class Candidate:
    """A straight way out.

    inner_mm : (3,) mm, the ball's centre;  axis : (3,) unit vector, outward;  mouth_mm : (3,) mm;
    cost_mm : in millimetres of channel.
    """

    inner_mm: Float
    axis: Float
    mouth_mm: Float
    cost_mm: float

    def like(self, other: Candidate) -> bool:
        """Whether another way is so near that it meets the same obstacles."""
        near = float(np.linalg.norm(self.mouth_mm - other.mouth_mm)) < LIKE_MM
        return near and float(self.axis @ other.axis) > LIKE_COSINE


def balls_at_rest(
    pools: Pools, pool: Int, band_mm: tuple[float, float], *, top: bool = False
) -> Float:
    """(n, 3) mm, centres of balls at rest in a pool, in columns whose lowest point is in a band.

    pool : (k,) dexels;  band_mm : its two ends, above the pool's lowest point;  top : take highest
    points instead, the band below the pool's highest.
    """
    dexels = pools.dexels
    edge = -dexels.high_mm[pool] if top else dexels.low_mm[pool]
    above = edge - edge.min()
    near = np.flatnonzero((above >= band_mm[0]) & (above <= band_mm[1]))
    near = pool[near[np.linspace(0, len(near) - 1, min(MOST_BALLS, len(near))).astype(int)]]
    i, j = np.divmod(dexels.column[near], pools.grid.shape[1])
    z = dexels.high_mm[near] if top else dexels.low_mm[near]
    xy = pools.grid.origin_mm[:2] + pools.grid.pitch_mm * np.column_stack([i, j])
    return np.column_stack([xy, z])


def directions(role: Role) -> Float:
    """(n, 3) unit vectors to try, never upward for an outlet."""
    falls = FALLS_DEG if role == "outlet" else VENT_FALLS_DEG
    fall, azimuth = np.meshgrid(
        np.radians(falls), np.arange(AZIMUTHS) * 2 * np.pi / AZIMUTHS, indexing="ij"
    )
    around = np.column_stack(
        [
            (np.cos(fall) * np.cos(azimuth)).ravel(),
            (np.cos(fall) * np.sin(azimuth)).ravel(),
            -np.sin(fall).ravel(),
        ]
    )
    straight = [[0.0, 0.0, -1.0]] if role == "outlet" else [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
    return np.vstack([around, straight])


def ways_out(
    voxelized: VoxelizedPart,
    centres: Float,
    extra_mm: Float,
    radius_mm: float,
    wall_mm: float,
    clearance_mm: float,
    role: Role,
) -> tuple[Candidate, ...]:
    """Every way out of balls that the grid allows, the cheapest first.

    centres : (n, 3) mm, of the balls;  extra_mm : (n,) mm, cost of each ball by itself;
    clearance_mm : between a mouth and the plate.
    """
    ways = directions(role)
    ball, way = (part.ravel() for part in np.indices((len(centres), len(ways))))
    start, axis = centres[ball], ways[way]
    step = voxelized.grid.pitch_mm / 2
    t = np.arange(0.0, LONGEST_MM, step)
    points = start[:, None] + t[None, :, None] * axis[:, None]
    depth = voxelized.depth_at(points.reshape(-1, 3)).reshape(len(ball), len(t))
    outside = depth < 0
    exits = np.where(outside.any(axis=1), outside.argmax(axis=1), len(t) - 1)
    index = np.arange(len(t))
    left = (exits[:, None] - index) * step
    # Before the mouth the channel stays in material, as deep as an oblique mouth allows
    asked = np.minimum(LEAST_COSINE * left, radius_mm + wall_mm / 2)
    within = ((depth >= asked - step) | (index >= exits[:, None])).all(axis=1)
    # A ball that is out lies in open air
    after = np.minimum(exits[:, None] + np.arange(int(4 * radius_mm / step)), len(t) - 1)
    beyond = np.take_along_axis(depth, after, axis=1)
    clear = (beyond <= -BALL_OUT * radius_mm) & ~np.logical_or.accumulate(beyond > 0, axis=1)
    at = np.take_along_axis(after, clear.argmax(axis=1)[:, None], axis=1)[:, 0]
    out = start + t[at][:, None] * axis
    mouth = start + t[exits][:, None] * axis
    lowest = mouth[:, 2] - radius_mm * np.sqrt(np.maximum(1 - axis[:, 2] ** 2, 0.0))
    good = np.flatnonzero(
        within
        & outside.any(axis=1)
        & clear.any(axis=1)
        & voxelized.open[voxelized.index(out)]
        & (lowest >= clearance_mm)
    )
    start, axis, mouth = start[good], axis[good], mouth[good]
    cost = (
        extra_mm[ball[good]]
        + RUN_MM * t[exits[good]]
        + (1 - RUN_MM) * _in_material_mm(voxelized, start, axis, t[exits[good]], step)
        + _looks_mm(voxelized, mouth, radius_mm)
        - SIGHT_MM * _sight_mm(voxelized, start, axis)
    )
    order = np.argsort(cost, kind="stable")
    return tuple(Candidate(start[k], axis[k], mouth[k], float(cost[k])) for k in order)


def _in_material_mm(
    voxelized: VoxelizedPart, start: Float, axis: Float, exit_mm: Float, step: float
) -> Float:
    """(n,) mm, length of each way in material.

    start : (n, 3) mm;  axis : (n, 3) unit vectors;  exit_mm : (n,) mm, length of the way.
    """
    t = np.arange(0.0, LONGEST_MM, step)
    points = start[:, None] + t[None, :, None] * axis[:, None]
    void = voxelized.void[voxelized.index(points.reshape(-1, 3))].reshape(len(start), len(t))
    result: Float = ((~void) & (t < exit_mm[:, None])).sum(axis=1) * step
    return result


def _looks_mm(voxelized: VoxelizedPart, mouth: Float, radius_mm: float) -> Float:
    """(n,) mm, cost of the places of mouths (n, 3) mm: looking up, on a bulge, on relief."""
    step = voxelized.grid.pitch_mm
    gradient = np.column_stack(
        [
            voxelized.depth_at(mouth + step * unit) - voxelized.depth_at(mouth - step * unit)
            for unit in np.eye(3)
        ]
    )
    normal = -gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 1e-9)
    aside = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(aside, normal)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-9)
    second = np.cross(normal, first)
    level = voxelized.depth_at(mouth)
    ring = []
    for angle in np.arange(8) * np.pi / 4:
        aside = np.cos(angle) * first + np.sin(angle) * second
        ring.append(voxelized.depth_at(mouth + 1.5 * radius_mm * aside) - level)
    around = np.array(ring)
    result: Float = (
        UPWARD_MM * (1 + normal[:, 2]) / 2
        - CONVEX_MM * np.clip(around.mean(axis=0), -2, 2)
        + RELIEF_MM * around.std(axis=0)
    )
    return result


def _sight_mm(voxelized: VoxelizedPart, start: Float, axis: Float) -> Float:
    """(n,) mm, how far one sees into the cavity through each channel.

    start : (n, 3) mm;  axis : (n, 3) unit vectors.
    """
    step = voxelized.grid.pitch_mm
    t = np.arange(0.0, FULL_SIGHT_MM, step)
    points = start[:, None] - t[None, :, None] * axis[:, None]
    void: Bool = voxelized.void[voxelized.index(points.reshape(-1, 3))].reshape(len(start), len(t))
    result: Float = np.logical_and.accumulate(void, axis=1).sum(axis=1) * step
    return result
