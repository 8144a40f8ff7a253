"""Rule: the triangles of the file have an area."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.measure import area_normals
from printprep.types import Finding
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Below this height, as a share of the size, a triangle has no normal in single precision.
_FLAT = float(np.finfo(np.float32).eps)
# Every program makes a few; from this share on, it is a fault of the file.
LEAST_SHARE = 0.001


@rule("degenerate-triangles")
def degenerate_triangles(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells of triangles without area, which some programs drop and others keep."""
    del profile
    raw = context.raw
    if raw is None:
        return
    corners = raw.vertices[raw.faces]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    doubled = np.linalg.norm(area_normals(corners), axis=1)
    size = float(np.ptp(raw.vertices, axis=0).max())
    flat = np.flatnonzero(doubled <= _FLAT * size * sides.max(axis=1))
    if len(flat) < LEAST_SHARE * len(raw.faces) or len(flat) == 0:
        return
    yield finding(
        "degenerate-triangles",
        f"{len(flat)} of {counted(len(raw.faces), 'triangle')} "
        f"{'has' if len(flat) == 1 else 'have'} no area.",
        "Merge close vertices in the program that made the model; most programs drop such "
        "triangles.",
        value=float(len(flat)),
        limit=LEAST_SHARE * len(raw.faces),
        at_mm=mean_point(corners[flat[0]]),
    )
