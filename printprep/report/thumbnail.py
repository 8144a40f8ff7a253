"""A small picture of a part, as a slicer shows it beside the file: numpy and zlib, nothing else.

Parallel projection from the front right and above; a key light from the upper left, a fill light,
a sky that is brighter than the ground, and a soft shadow on the bed; transparent around it.
No clock, no graphics card, no font: the same mesh gives the same picture.
"""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from printprep.report.raster import coverage, rasterize

if TYPE_CHECKING:
    from printprep.types import Float, Int

_OVERSAMPLING = 2
_MARGIN = 0.06  # of the picture's side, on every side
_AZIMUTH_DEG, _ELEVATION_DEG = -60.0, 22.0  # of the eye, from +x towards +y, above the bed
_CREASE_COS = 0.77  # edges sharper than about 40° stay sharp
_COLOUR = np.array([0.95, 0.33, 0.06])  # linear light: printed orange
_KEY = np.array([-0.55, -0.55, 0.75])
_FILL = np.array([0.90, -0.30, 0.15])
_SHADOW = 0.38
_SHADOW_BLUR = 0.025  # of the picture's side


def thumbnail_png(vertices: Float, faces: Int, size: int = 256) -> bytes:
    """The mesh as a PNG of `size` × `size` pixels, RGBA.

    vertices : (n, 3) mm, z up;  faces : (m, 3), counter-clockwise seen from outside.
    """
    rgba = _render(np.asarray(vertices, dtype=np.float64), np.asarray(faces), size * _OVERSAMPLING)
    blocks = rgba.reshape(size, _OVERSAMPLING, size, _OVERSAMPLING, 4).mean(axis=(1, 3))
    alpha = blocks[..., 3:]
    light = np.where(alpha > 0.0, blocks[..., :3] / np.where(alpha > 0.0, alpha, 1.0), 0.0)
    srgb = np.where(  # IEC 61966-2-1
        light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    )
    picture = np.concatenate([srgb, alpha], axis=2)
    return _png(np.clip(np.rint(picture * 255.0), 0, 255).astype(np.uint8))


def _render(vertices: Float, faces: Int, size: int) -> Float:
    """(size, size, 4) linear colour, premultiplied by alpha."""
    image = np.zeros((size * size, 4))
    if not len(faces):
        return image.reshape(size, size, 4)
    right, up, eye = _camera()
    ground = vertices * [1.0, 1.0, 0.0] + [0.0, 0.0, float(vertices[:, 2].min())]
    flat = np.column_stack([_along(vertices, right), -_along(vertices, up)])
    flat_ground = np.column_stack([_along(ground, right), -_along(ground, up)])
    low = np.minimum(flat.min(axis=0), flat_ground.min(axis=0))
    high = np.maximum(flat.max(axis=0), flat_ground.max(axis=0))
    scale = size * (1.0 - 2.0 * _MARGIN) / max(float((high - low).max()), 1e-12)
    shift = size / 2.0 - scale * (low + high) / 2.0
    flat, flat_ground = flat * scale + shift, flat_ground * scale + shift

    shade = _blur(coverage(flat_ground[faces], size).astype(np.float64), size) * _SHADOW
    image[:, 3] = shade.ravel()

    normals, corner_normals = _normals(vertices, faces)
    seen = np.flatnonzero(_along(normals, eye) > 0.0)
    depth = _along(vertices, eye)
    hits = rasterize(flat[faces[seen]], depth[faces[seen]], size)
    normal = (corner_normals[seen[hits.triangle]] * hits.weights[:, :, None]).sum(axis=1)
    image[hits.pixel, :3] = _light(_unit(normal), eye)
    image[hits.pixel, 3] = 1.0
    return image.reshape(size, size, 4)


def _camera() -> tuple[Float, Float, Float]:
    azimuth, elevation = np.radians(_AZIMUTH_DEG), np.radians(_ELEVATION_DEG)
    eye = np.array(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return right, np.cross(eye, right), eye


def _light(normal: Float, eye: Float) -> Float:
    key, fill = _unit(_KEY[None])[0], _unit(_FILL[None])[0]
    sky = 0.5 + 0.5 * normal[:, 2:]
    diffuse = 0.05 + 0.13 * sky
    diffuse = diffuse + 0.86 * np.maximum(_along(normal, key), 0.0)[:, None]
    diffuse = diffuse + 0.20 * np.maximum(_along(normal, fill), 0.0)[:, None]
    half = _unit((key + eye)[None])[0]
    gloss = 0.14 * np.maximum(_along(normal, half), 0.0)[:, None] ** 24
    rim = 0.10 * (1.0 - np.maximum(_along(normal, eye), 0.0)[:, None]) ** 3 * sky
    return np.asarray(_COLOUR * diffuse + gloss + rim)


def _normals(vertices: Float, faces: Int) -> tuple[Float, Float]:
    """Unit normals of faces (m, 3), and of their corners (m, 3, 3), smooth but creased."""
    corners = vertices[faces]
    flat = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    # weighted by the angle at the corner, so that how a side is cut into triangles does not matter
    after = _unit((np.roll(corners, -1, axis=1) - corners).reshape(-1, 3))
    before = _unit((np.roll(corners, 1, axis=1) - corners).reshape(-1, 3))
    angle = np.arccos(np.clip((after * before).sum(axis=1), -1.0, 1.0))
    weighted = np.repeat(flat, 3, axis=0) * angle[:, None]
    summed = np.zeros((len(vertices), 3))
    for axis in range(3):
        summed[:, axis] = np.bincount(
            faces.ravel(), weights=weighted[:, axis], minlength=len(vertices)
        )
    smooth = _unit(summed)[faces]
    agrees = (smooth * flat[:, None]).sum(axis=2, keepdims=True) > _CREASE_COS
    return flat, np.where(agrees, smooth, flat[:, None])


def _along(vectors: Float, direction: Float) -> Float:
    """Dot products by plain arithmetic: a matrix product may round otherwise elsewhere."""
    x, y, z = direction
    return np.asarray(vectors[:, 0] * x + vectors[:, 1] * y + vectors[:, 2] * z)


def _unit(vectors: Float) -> Float:
    length = np.sqrt((vectors * vectors).sum(axis=1, keepdims=True))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def _blur(image: Float, size: int) -> Float:
    """Three box blurs along each axis, close to a Gaussian."""
    radius = max(1, round(_SHADOW_BLUR * size))
    for _ in range(3):
        for axis in (0, 1):
            width = [(radius + 1, radius) if axis == at else (0, 0) for at in (0, 1)]
            sums = np.cumsum(np.pad(image, width), axis=axis)
            stop = np.take(sums, np.arange(2 * radius + 1, sums.shape[axis]), axis=axis)
            start = np.take(sums, np.arange(sums.shape[axis] - 2 * radius - 1), axis=axis)
            image = (stop - start) / (2 * radius + 1)
    return image


def _png(picture: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]) -> bytes:
    """An RGBA picture (height, width, 4) as PNG (ISO/IEC 15948), rows coded as differences."""
    height, width, _ = picture.shape
    rows = picture.reshape(height, width * 4)
    above = np.vstack([np.zeros((1, width * 4), dtype=np.uint8), rows[:-1]])
    up = np.column_stack([np.full(height, 2, dtype=np.uint8), rows - above])
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(up.tobytes(), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
