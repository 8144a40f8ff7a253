"""What a page's viewer is told: balance, findings with their places, poses, bounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from printprep.output.numbers import place, rounded
from printprep.page.meshes import MOST_WALLS

if TYPE_CHECKING:
    from printprep.page.encode import Encoded
    from printprep.page.shape import Shape
    from printprep.stand.poses import Pose
    from printprep.types import Finding, Lean, Stability


def view_of(
    shape: Shape,
    encoded: Encoded,
    *,
    wall_mm: float,
    stability: Stability,
    centre_mm: tuple[float, float, float],
    centre_before_mm: tuple[float, float, float] | None,
    lean: Lean,
    findings: Sequence[Finding],
    poses: Sequence[Pose] = (),
) -> dict[str, Any]:
    """Plain values under the names that ``web/src/page.js`` reads."""
    box = shape.part.bounding_box()
    return {
        "directory": encoded.directory,
        "wallMm": wall_mm,
        "thickestMm": MOST_WALLS * wall_mm,
        "hollowed": bool(shape.cavities) or shape.infill is not None,
        "balance": _balance(stability, centre_mm, centre_before_mm, lean),
        "findings": [
            {
                "at": None if item.at_mm is None else list(place(item.at_mm)),
                "severity": item.severity,
                "rule": item.rule,
            }
            for item in findings
        ],
        "poses": [
            {
                "rotation": [rounded(float(value), 9) for value in pose.rotation.ravel()],
                "tiltDeg": rounded(pose.tilt_deg),
            }
            for pose in poses
        ],
        "low": list(place(box[:3])),
        "high": list(place(box[3:])),
    }


def _balance(
    stability: Stability,
    centre_mm: tuple[float, float, float],
    centre_before_mm: tuple[float, float, float] | None,
    lean: Lean,
) -> dict[str, Any] | None:
    if stability.tilt_deg is None:
        return None
    azimuth = stability.weakest_azimuth_deg
    return {
        "polygon": [
            [round(float(x), 4), round(float(y), 4)] for x, y in stability.support_polygon_mm
        ],
        "centre": list(place(centre_mm)),
        "centreBefore": None if centre_before_mm is None else list(place(centre_before_mm)),
        "tiltDeg": rounded(stability.tilt_deg),
        "weakestEdge": stability.weakest_edge,
        "weakestAzimuthDeg": None if azimuth is None else rounded(azimuth),
        "leanDeg": rounded(lean.angle_deg),
        "leanAzimuthDeg": lean.azimuth_deg,
    }
