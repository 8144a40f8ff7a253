"""Draws the small picture of a part that a slicer shows beside the file, with numpy and zlib only.

Parallel projection from the front right and above, with the light of shading.py and a soft shadow
on the bed; the background is transparent.  It needs no graphics card and no font: the same mesh
gives the same picture.
"""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals
from printprep.mesh.shell_figures import shell_figures
from printprep.render.raster import coverage, rasterize
from printprep.render.shading import blur, camera, corner_normals, dot, normalized, shaded, to_srgb

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

_OVERSAMPLING = 2
_MARGIN = 0.06  # of the picture's side, on every side
_AZIMUTH_DEG, _ELEVATION_DEG = -60.0, 22.0  # of the eye, from +x toward +y, above the bed
_COLOUR = np.array([0.95, 0.33, 0.06])  # linear light: printed orange
_SHADOW = 0.38
_SHADOW_BLUR = 0.025  # of the picture's side


def thumbnail_png(vertices: Float, faces: Int, size: int = 256) -> bytes:
    """The mesh as a PNG of `size` × `size` pixels, RGBA.

    vertices : (n, 3) mm, z up;  faces : (m, 3), counter-clockwise seen from outside.
    """
    vertices, faces = np.asarray(vertices, dtype=np.float64), np.asarray(faces)
    rgba = _render(vertices, _not_enclosed(vertices, faces), size * _OVERSAMPLING)
    blocks = rgba.reshape(size, _OVERSAMPLING, size, _OVERSAMPLING, 4).mean(axis=(1, 3))
    alpha = blocks[..., 3:]
    light = np.where(alpha > 0.0, blocks[..., :3] / np.where(alpha > 0.0, alpha, 1.0), 0.0)
    srgb = to_srgb(light)
    picture = np.concatenate([srgb, alpha], axis=2)
    return _png(np.clip(np.rint(picture * 255.0), 0, 255).astype(np.uint8))


def _not_enclosed(vertices: Float, faces: Int) -> Int:
    """The faces (m, 3) but for those of voids inside the largest body, which nobody sees."""
    figures = shell_figures(vertices, faces)
    if len(figures.volume_mm3) < 2:
        return faces
    around = int(np.argmax(figures.volume_mm3))
    within = (figures.low_mm > figures.low_mm[around]) & (figures.high_mm < figures.high_mm[around])
    enclosed = (figures.volume_mm3 < 0) & within.all(axis=1)
    seen: Int = faces[~enclosed[figures.label]]
    return seen


def _render(vertices: Float, faces: Int, size: int) -> Float:
    """(size, size, 4) linear colour, premultiplied by alpha; vertices (n, 3) mm, faces (m, 3)."""
    image = np.zeros((size * size, 4))
    if not len(faces):
        return image.reshape(size, size, 4)
    right, up, eye = camera(_AZIMUTH_DEG, _ELEVATION_DEG)
    ground = vertices * [1.0, 1.0, 0.0] + [0.0, 0.0, float(vertices[:, 2].min())]
    flat = np.column_stack([dot(vertices, right), -dot(vertices, up)])
    flat_ground = np.column_stack([dot(ground, right), -dot(ground, up)])
    low = np.minimum(flat.min(axis=0), flat_ground.min(axis=0))
    high = np.maximum(flat.max(axis=0), flat_ground.max(axis=0))
    scale = size * (1.0 - 2.0 * _MARGIN) / max(float((high - low).max()), 1e-12)
    shift = size / 2.0 - scale * (low + high) / 2.0
    flat, flat_ground = flat * scale + shift, flat_ground * scale + shift

    shadow = coverage(flat_ground[faces], size).astype(np.float64)
    shade = blur(shadow, round(_SHADOW_BLUR * size)) * _SHADOW
    image[:, 3] = shade.ravel()

    seen = np.flatnonzero(dot(normalized(area_normals(vertices[faces])), eye) > 0.0)
    depth = dot(vertices, eye)
    hits = rasterize(flat[faces[seen]], depth[faces[seen]], size)
    shown, which = np.unique(seen[hits.triangle], return_inverse=True)
    smooth = _corner_normals_of(shown, vertices, faces)
    normal = (smooth[which] * hits.weights[:, :, None]).sum(axis=1)
    image[hits.pixel, :3] = shaded(normalized(normal), eye, _COLOUR)
    image[hits.pixel, 3] = 1.0
    return image.reshape(size, size, 4)


def _corner_normals_of(shown: Int, vertices: Float, faces: Int) -> Float:
    """(k, 3, 3) the corner normals of the faces shown (k,), of vertices (n, 3) and faces (m, 3).

    Only faces that share a corner with these matter: of a fine mesh, few have a pixel.
    """
    corners = np.zeros(len(vertices), dtype=bool)
    corners[faces[shown]] = True
    around = np.flatnonzero(corners[faces].any(axis=1))
    _, smooth = corner_normals(vertices, faces[around])
    result: Float = smooth[np.searchsorted(around, shown)]
    return result


def _png(picture: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]) -> bytes:
    """An RGBA picture (height, width, 4) as PNG (ISO/IEC 15948), with rows as differences."""
    height, width, _ = picture.shape
    rows = picture.reshape(height, width * 4)
    above = np.vstack([np.zeros((1, width * 4), dtype=np.uint8), rows[:-1]])
    up = np.column_stack([np.full(height, 2, dtype=np.uint8), rows - above])
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(up.tobytes(), 6)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
