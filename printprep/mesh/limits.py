"""Limits on what a reader takes, so that no file costs more than its content is worth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

# 5 million triangles on a figure of 100 mm are edges of 0.1 mm, finer than any layer.
TRIANGLES_MAX = 5_000_000
# A corner this many times as far from the middle as nine tenths of them is damage, not shape.
_STRAY = 1e4
_SAMPLES = 1_000_000  # corners that tell where the middle is


def refuse_too_many(count: int, what: str) -> None:
    """Raise InputError where a file has more triangles than printprep works on."""
    if count > TRIANGLES_MAX:
        raise InputError(
            f"{what} has {count} triangles; at most {TRIANGLES_MAX} are read.",
            "Reduce the number of triangles in a modelling program; a print shows no difference.",
        )


def refuse_strays(vertices: Float, faces: Int, what: str) -> None:
    """Raise InputError, which names the corner, where a few corners lie absurdly far away.

    vertices : (n, 3), all finite, in the file's unit;  faces : (m, 3).
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces.ravel()] = True
    corners = vertices if used.all() else vertices[used]
    some = corners[:: 1 + len(corners) // _SAMPLES]
    middle = np.median(some, axis=0)
    away = np.zeros(len(corners))
    for axis in range(3):  # halves, so that nothing overflows
        np.maximum(away, np.abs(corners[:, axis] / 2 - middle[axis] / 2), out=away)
    most = float(np.quantile(away[:: 1 + len(corners) // _SAMPLES], 0.9))
    if most <= 0.0 or not float(away.max()) / _STRAY > most:
        return
    strays = int((away / _STRAY > most).sum())
    x, y, z = corners[int(away.argmax())]
    raise InputError(
        f"{what} has {counted(strays, 'corner')} more than {_STRAY:g} times as far away as the "
        f"rest, one at x = {x:.6g}, y = {y:.6g}, z = {z:.6g}: the file is damaged there.",
        "Delete the corner in a modelling program, or export the model again.",
    )
