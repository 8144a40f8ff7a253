"""Camera, normals, light and display values for pictures of a part, in plain numpy arithmetic.

The light: a key light from the upper left, a fill light, and a sky brighter than the ground.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

_CREASE_COS = 0.77  # edges sharper than about 40° stay sharp
_KEY = np.array([-0.55, -0.55, 0.75])
_FILL = np.array([0.90, -0.30, 0.15])


def camera(azimuth_deg: float, elevation_deg: float) -> tuple[Float, Float, Float]:
    """(3,) unit vectors to the right, up and toward the eye, for an eye in this direction.

    azimuth_deg : from +x toward +y;  elevation_deg : above the bed.
    """
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    level = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    eye = np.cos(elevation) * level + np.array([0.0, 0.0, np.sin(elevation)])
    right = np.array([-level[1], level[0], 0.0])
    return right, np.cross(eye, right), eye


def shaded(normal: Float, eye: Float, colour: Float) -> Float:
    """(k, 3) linear colour of lit surfaces with unit normals (k, 3).

    eye : (3,) unit vector toward the viewer;  colour : (3,), or (k, 3) one for each.
    """
    key, fill = normalized(_KEY[None])[0], normalized(_FILL[None])[0]
    sky = 0.5 + 0.5 * normal[:, 2:]
    diffuse = 0.05 + 0.13 * sky
    diffuse = diffuse + 0.86 * np.maximum(dot(normal, key), 0.0)[:, None]
    diffuse = diffuse + 0.20 * np.maximum(dot(normal, fill), 0.0)[:, None]
    half = normalized((key + eye)[None])[0]
    gloss = 0.14 * np.maximum(dot(normal, half), 0.0)[:, None] ** 24
    rim = 0.10 * (1.0 - np.maximum(dot(normal, eye), 0.0)[:, None]) ** 3 * sky
    return np.asarray(colour * diffuse + gloss + rim)


def corner_normals(vertices: Float, faces: Int) -> tuple[Float, Float]:
    """(m, 3) unit normals of faces, and (m, 3, 3) of their corners, smooth except at creases.

    vertices : (n, 3);  faces : (m, 3).
    """
    corners = vertices[faces]
    flat = normalized(area_normals(corners))
    # The weight is the angle at the corner: it does not depend on how a side is triangulated.
    after = normalized((np.roll(corners, -1, axis=1) - corners).reshape(-1, 3))
    before = normalized((np.roll(corners, 1, axis=1) - corners).reshape(-1, 3))
    angle = np.arccos(np.clip((after * before).sum(axis=1), -1.0, 1.0))
    weighted = np.repeat(flat, 3, axis=0) * angle[:, None]
    summed = np.zeros((len(vertices), 3))
    for axis in range(3):
        summed[:, axis] = np.bincount(
            faces.ravel(), weights=weighted[:, axis], minlength=len(vertices)
        )
    smooth = normalized(summed)[faces]
    agrees = (smooth * flat[:, None]).sum(axis=2, keepdims=True) > _CREASE_COS
    return flat, np.where(agrees, smooth, flat[:, None])


def dot(vectors: Float, direction: Float) -> Float:
    """(k,) dot products of vectors (k, 3) with a direction (3,).

    It avoids a matrix product, which may round differently on another machine.
    """
    x, y, z = direction
    return np.asarray(vectors[:, 0] * x + vectors[:, 1] * y + vectors[:, 2] * z)


def normalized(vectors: Float) -> Float:
    """(k, 3) vectors (k, 3) scaled to length one; a zero vector stays zero."""
    length = np.sqrt((vectors * vectors).sum(axis=1, keepdims=True))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def to_srgb(light: Float) -> Float:
    """Linear light, an array of any shape, as display values from 0 to 1 by IEC 61966-2-1."""
    return np.asarray(
        np.where(
            light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
        )
    )


def blur(image: Float, radius: int) -> Float:
    """An image (height, width) after three box blurs along each axis, close to a Gaussian.

    radius : of a box in pixels, at least 1.
    """
    radius = max(1, radius)
    for _ in range(3):
        for axis in (0, 1):
            width = [(radius + 1, radius) if axis == at else (0, 0) for at in (0, 1)]
            sums = np.cumsum(np.pad(image, width), axis=axis)
            stop = np.take(sums, np.arange(2 * radius + 1, sums.shape[axis]), axis=axis)
            start = np.take(sums, np.arange(sums.shape[axis] - 2 * radius - 1), axis=axis)
            image = (stop - start) / (2 * radius + 1)
    return image
