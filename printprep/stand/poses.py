"""Finds the poses in which a solid stands by itself, on facets of its hull, and turns it there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals, arrays, from_arrays, volume_and_centre
from printprep.mesh.weld import in_order
from printprep.stand.footing import Footing

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float


# Hull triangles whose normals differ by less than this carry the solid together, and poses whose
# down directions differ by less are one pose: a hundredth of a usual lean.
SAME_DEG = 0.1
MOST_POSES = 12
# Poses that are looked at together, to bound the memory.
_AT_ONCE = 256


@dataclass(frozen=True, eq=False)
class Pose:
    """A stable pose on the bed.

    rotation : (3, 3) proper, turns the solid so that the facet of the pose faces down.
    tilt_deg : the lean at which the solid tips out of the pose, over its weakest edge.
    """

    rotation: Float
    tilt_deg: float


def stable_poses(solid: Manifold) -> tuple[Pose, ...]:
    """The poses in which a solid stands, the most stable first, twelve at most.

    A pose is a facet of the convex hull with the centre of mass above its inside; its tilt angle
    is atan(distance to the nearest edge of the facet / height), as for any support polygon.
    """
    vertices, index = arrays(solid.hull())
    faces = in_order(index)  # the kernel sorts the triangles of a large hull on several threads
    centre = np.array(volume_and_centre(solid)[1])
    normals = area_normals(vertices[faces])
    area = np.linalg.norm(normals, axis=1)
    normals = normals[area > 0] / area[area > 0, None]
    downs = normals[np.argsort(-area[area > 0], kind="stable")]
    poses: list[tuple[Float, Pose]] = []
    for down in downs[_may_stand(downs, vertices, centre)]:
        if any(down @ known > np.cos(np.radians(SAME_DEG)) for known, _ in poses):
            continue
        pose = _pose(down, vertices, centre)
        if pose is not None:
            poses.append((down, pose))
    ranked = sorted((pose for _, pose in poses), key=lambda pose: -pose.tilt_deg)
    return tuple(ranked[:MOST_POSES])


def in_pose(manifold: Manifold, pose: Pose) -> tuple[Manifold, Float]:
    """A solid in a pose, on the bed and centred on x = y = 0, and the (4, 4) move to it."""
    vertices, faces = arrays(manifold)
    move = np.eye(4)
    move[:3, :3] = pose.rotation
    turned = vertices @ pose.rotation.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    move[:3, 3] = -(low + high) / 2
    move[2, 3] = -low[2]
    return from_arrays(turned + move[:3, 3], faces), move


def _touch_mm(vertices: Float) -> float:
    """How far above the bed a corner of a hull (n, 3) mm may be that touches it."""
    return float(np.ptp(vertices, axis=0).max() * np.radians(SAME_DEG))


def _may_stand(downs: Float, vertices: Float, centre: Float) -> Bool:
    """(k,) false where a solid surely falls out of a pose.

    It does where the point under its centre of mass lies outside the box around what touches.
    downs : (k, 3) unit vectors;  vertices : (n, 3) mm, of the hull;  centre : (3,) mm.
    """
    touch_mm = _touch_mm(vertices)
    stands: Bool = np.zeros(len(downs), dtype=bool)
    for start in range(0, len(downs), _AT_ONCE):
        some = downs[start : start + _AT_ONCE]
        heights = some @ vertices.T
        top = heights.max(axis=1)
        # More than touches, so that rounding decides nothing here
        touching = heights > (top - 2 * touch_mm)[:, None]
        under = centre + (top - some @ centre)[:, None] * some
        within = np.ones(len(some), dtype=bool)
        for axis, at in enumerate(vertices.T):
            low = np.where(touching, at, np.inf).min(axis=1) - touch_mm
            high = np.where(touching, at, -np.inf).max(axis=1) + touch_mm
            within &= (low <= under[:, axis]) & (under[:, axis] <= high)
        stands[start : start + _AT_ONCE] = within
    return stands


def _pose(down: Float, vertices: Float, centre: Float) -> Pose | None:
    """The pose with a normal of the hull pointing down, None where the solid falls out of it.

    down : (3,) unit vector;  vertices : (n, 3) mm, of the hull;  centre : (3,) mm, centre of mass.
    """
    rotation = _turn_down(down)
    height = vertices @ down
    touching = vertices[height > height.max() - _touch_mm(vertices)]
    flat = (touching @ rotation.T)[:, :2]
    footing = _footing(flat)
    if footing is None:
        return None
    above = (rotation @ centre)[:2]
    lift = float(height.max() - centre @ down)
    ahead = float(np.min(footing.offsets_mm - footing.normals @ above))
    if ahead <= 0:
        return None
    return Pose(rotation, float(np.degrees(np.arctan2(ahead, lift))))


def _turn_down(down: Float) -> Float:
    """(3, 3) the shortest rotation that takes a unit vector (3,) to −z (Rodrigues)."""
    target = np.array([0.0, 0.0, -1.0])
    axis = np.cross(down, target)
    cosine = float(down @ target)
    if cosine < -1 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    result: Float = np.eye(3) + skew + skew @ skew / (1 + cosine)
    return result


def _footing(points: Float) -> Footing | None:
    """Edges of the convex hull of points (k, 2) mm, None where they lie on a line."""
    from manifold3d import CrossSection

    hull = CrossSection.hull_points(points)
    if hull.is_empty() or hull.area() <= 0:
        return None
    return Footing.around(np.asarray(hull.to_polygons()[0], dtype=float))
