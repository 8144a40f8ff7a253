"""Rule: the file's triangles have an area."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Height below which a triangle faces nowhere in single precision, as a share of the size.
_FLAT = float(np.finfo(np.float32).eps)
# Every program makes a few; one in so many is a fault of the file.
LEAST_SHARE = 0.001


@rule("degenerate-triangles")
def degenerate_triangles(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells of triangles without an area, which face nowhere and which programs drop or keep."""
    del profile
    raw = context.raw
    if raw is None:
        return
    corners = raw.vertices[raw.faces]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    doubled = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    size = float(np.ptp(raw.vertices, axis=0).max())
    flat = np.flatnonzero(doubled <= _FLAT * size * sides.max(axis=1))
    if len(flat) < LEAST_SHARE * len(raw.faces) or len(flat) == 0:
        return
    x, y, z = corners[flat[0]].mean(axis=0).tolist()
    yield finding(
        "degenerate-triangles",
        f"{len(flat)} of its {len(raw.faces)} triangles have no area.",
        "Most programs drop them; merge close vertices where the model was made.",
        value=float(len(flat)),
        limit=LEAST_SHARE * len(raw.faces),
        at_mm=(x, y, z),
    )
