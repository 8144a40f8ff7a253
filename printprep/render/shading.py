"""Light on a surface: normals, a lamp or two, display values; plain arithmetic in numpy.

A key light from the upper left, a fill light, a sky that is brighter than the ground.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

_CREASE_COS = 0.77  # edges sharper than about 40° stay sharp
_KEY = np.array([-0.55, -0.55, 0.75])
_FILL = np.array([0.90, -0.30, 0.15])


def lit(normal: Float, eye: Float, colour: Float) -> Float:
    """(k, 3) linear colour of surfaces with unit normals (k, 3); colour (3,), or (k, 3) of each."""
    key, fill = unit(_KEY[None])[0], unit(_FILL[None])[0]
    sky = 0.5 + 0.5 * normal[:, 2:]
    diffuse = 0.05 + 0.13 * sky
    diffuse = diffuse + 0.86 * np.maximum(along(normal, key), 0.0)[:, None]
    diffuse = diffuse + 0.20 * np.maximum(along(normal, fill), 0.0)[:, None]
    half = unit((key + eye)[None])[0]
    gloss = 0.14 * np.maximum(along(normal, half), 0.0)[:, None] ** 24
    rim = 0.10 * (1.0 - np.maximum(along(normal, eye), 0.0)[:, None]) ** 3 * sky
    return np.asarray(colour * diffuse + gloss + rim)


def corner_normals(vertices: Float, faces: Int) -> tuple[Float, Float]:
    """Unit normals of faces (m, 3), and of their corners (m, 3, 3), smooth but creased."""
    corners = vertices[faces]
    flat = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    # weighted by the angle at the corner, so that how a side is cut into triangles does not matter
    after = unit((np.roll(corners, -1, axis=1) - corners).reshape(-1, 3))
    before = unit((np.roll(corners, 1, axis=1) - corners).reshape(-1, 3))
    angle = np.arccos(np.clip((after * before).sum(axis=1), -1.0, 1.0))
    weighted = np.repeat(flat, 3, axis=0) * angle[:, None]
    summed = np.zeros((len(vertices), 3))
    for axis in range(3):
        summed[:, axis] = np.bincount(
            faces.ravel(), weights=weighted[:, axis], minlength=len(vertices)
        )
    smooth = unit(summed)[faces]
    agrees = (smooth * flat[:, None]).sum(axis=2, keepdims=True) > _CREASE_COS
    return flat, np.where(agrees, smooth, flat[:, None])


def along(vectors: Float, direction: Float) -> Float:
    """Dot products by plain arithmetic: a matrix product may round otherwise elsewhere."""
    x, y, z = direction
    return np.asarray(vectors[:, 0] * x + vectors[:, 1] * y + vectors[:, 2] * z)


def unit(vectors: Float) -> Float:
    """Rows of length one; a row without length stays as it is."""
    length = np.sqrt((vectors * vectors).sum(axis=1, keepdims=True))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def to_srgb(light: Float) -> Float:
    """Linear light as display values from 0 to 1, by IEC 61966-2-1."""
    return np.asarray(
        np.where(
            light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
        )
    )


def blur(image: Float, radius: int) -> Float:
    """Three box blurs of at least one pixel along each axis, close to a Gaussian."""
    radius = max(1, radius)
    for _ in range(3):
        for axis in (0, 1):
            width = [(radius + 1, radius) if axis == at else (0, 0) for at in (0, 1)]
            sums = np.cumsum(np.pad(image, width), axis=axis)
            stop = np.take(sums, np.arange(2 * radius + 1, sums.shape[axis]), axis=axis)
            start = np.take(sums, np.arange(sums.shape[axis] - 2 * radius - 1), axis=axis)
            image = (stop - start) / (2 * radius + 1)
    return image
