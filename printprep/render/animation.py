"""Draws the film of a falling part as a GIF or as a strip of stills; the same film, the same bytes.

The view is from the side, so that the fall goes across the picture: the bed leans down to the
right.  Parallel projection; the bed is a slab in another colour, with a soft shadow of the part.
"""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.render.raster import coverage, rasterize
from printprep.render.shading import blur, camera, corner_normals, dot, normalized, shaded, to_srgb

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

    from printprep.arrays import Float, Int
    from printprep.stand.fall import Film, Frame

GIF_SIZE, STRIP_SIZE, STRIP_STILLS = 320, 280, 6
GIF_FRAMES_PER_S, STRIP_FRAMES_PER_S = 12.5, 50.0  # a GIF counts in hundredths of a second

_OVERSAMPLING = 2
_AZIMUTH_DEG, _ELEVATION_DEG = -60.0, 14.0  # of the eye, to which the lamps are placed
_SWING_DEG = 12.0  # how far the eye is off the side, toward the azimuth of the lean
_PART = np.array([0.95, 0.33, 0.06])  # linear light: printed orange
_BED = np.array([0.30, 0.34, 0.40])
_PAPER = np.array([0.93, 0.94, 0.95])
_INK = (60, 66, 74)
_SHADOW, _SHADOW_BLUR = 0.45, 0.012
_BED_THICKNESS = 0.03  # of the bed's radius
_MARGIN = 0.05
_DETAIL = 1 / 500  # of the part's size: smaller details are not visible
_COLOURS = 128


def gif_bytes(film: Film, size: int = GIF_SIZE) -> bytes:
    """The film as an endless GIF of `size` × `size` pixels, with a pause on the last frame."""
    from PIL import Image

    stage = _stage(film, size)
    pictures = [_still(stage, frame) for frame in film.frames]
    # One palette for all frames, made from some of them; with several, colours would flicker.
    sample = _beside([pictures[at] for at in _spread(len(pictures), STRIP_STILLS)])
    palette = sample.quantize(_COLOURS)
    indexed = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    durations = [round(1000 / film.frames_per_s)] * (len(indexed) - 1) + [1200]
    out = BytesIO()
    indexed[0].save(
        out, "GIF", save_all=True, append_images=indexed[1:], duration=durations, loop=0
    )
    return out.getvalue()


def strip_bytes(film: Film, size: int = STRIP_SIZE, stills: int = STRIP_STILLS) -> bytes:
    """Stills side by side as a PNG: rest, lean, tipping, and the fall at even angles."""
    stage = _stage(film, size)
    out = BytesIO()
    _beside([_still(stage, film.frames[at]) for at in _key_frames(film, stills)]).save(out, "PNG")
    return out.getvalue()


@dataclass(frozen=True, eq=False)
class _Stage:
    """Everything that stays the same from frame to frame.

    vertices : (n, 3) mm, faces : (m, 3), normals : (m, 3) and corner_normals : (m, 3, 3) of the
    part;  bed : (b, 3) mm and bed_faces : (c, 3);  pivot : (3,) mm, middle of the bed;  right, up,
    eye : (3,) unit vectors of the view;  scale : pixels per mm;  shift : (2,) pixels.
    """

    vertices: Float
    faces: Int
    normals: Float
    corner_normals: Float
    bed: Float
    bed_faces: Int
    pivot: Float
    azimuth_deg: float
    right: Float
    up: Float
    eye: Float
    scale: float
    shift: Float
    size: int


def _stage(film: Film, size: int) -> _Stage:
    """The stage of a film, with a scale at which all its frames fit into the picture."""
    x0, y0, z0, x1, y1, z1 = film.body.bounding_box()
    body = film.body.simplify(max(x1 - x0, y1 - y0, z1 - z0) * _DETAIL)
    vertices, faces = arrays(body)
    right, up, eye = camera(_AZIMUTH_DEG, _ELEVATION_DEG)
    everywhere = np.concatenate([_placed(vertices, frame) for frame in film.frames[::3]])
    over = everywhere[:, :2]
    middle = np.array([*(over.min(axis=0) + over.max(axis=0)) / 2, 0.0])
    radius = float(np.linalg.norm(over - middle[:2], axis=1).max()) * 1.06
    bed, bed_faces = _slab(middle, radius)
    seen = []
    for frame in [*film.frames[::3], film.frames[-1]]:
        turn = _leaning(film.azimuth_deg, frame.lean_deg)
        for points in (_placed(vertices, frame), bed):
            world = (points - middle) @ turn.T
            seen.append(np.column_stack([dot(world, right), -dot(world, up)]))
    flat = np.concatenate(seen)
    low, high = flat.min(axis=0), flat.max(axis=0)
    pixels = size * _OVERSAMPLING
    scale = pixels * (1 - 2 * _MARGIN) / float((high - low).max())
    normals, smooth = corner_normals(vertices, faces)
    return _Stage(
        vertices=vertices,
        faces=faces,
        normals=normals,
        corner_normals=smooth,
        bed=bed,
        bed_faces=bed_faces,
        pivot=middle,
        azimuth_deg=film.azimuth_deg,
        right=right,
        up=up,
        eye=eye,
        scale=scale,
        shift=pixels / 2 - scale * (low + high) / 2,
        size=pixels,
    )


def _still(stage: _Stage, frame: Frame) -> Picture:
    """The picture of one frame, with the lean of the bed written in a corner."""
    from PIL import Image, ImageDraw, ImageFont

    turn = _leaning(stage.azimuth_deg, frame.lean_deg)
    on_bed = _placed(stage.vertices, frame)
    part = (on_bed - stage.pivot) @ turn.T
    bed = (stage.bed - stage.pivot) @ turn.T
    shade = (on_bed * [1.0, 1.0, 0.0] - stage.pivot) @ turn.T

    bed_normals, bed_corner_normals = corner_normals(bed, stage.bed_faces)
    turned = turn @ frame.rotation
    part_front = dot(stage.normals @ turned.T, stage.eye) > 0
    bed_front = dot(bed_normals, stage.eye) > 0
    part_faces, bed_faces = stage.faces[part_front], stage.bed_faces[bed_front]
    corners = np.concatenate([_flat(part, stage)[part_faces], _flat(bed, stage)[bed_faces]])
    depth = np.concatenate(
        [dot(p, stage.eye)[f] for p, f in ((part, part_faces), (bed, bed_faces))]
    )
    normals = np.concatenate(
        [stage.corner_normals[part_front] @ turned.T, bed_corner_normals[bed_front]]
    )
    hits = rasterize(corners, depth, stage.size)
    is_part = hits.triangle < len(part_faces)
    colour = np.where(is_part[:, None], _PART, _BED)
    normal = normalized((normals[hits.triangle] * hits.weights[:, :, None]).sum(axis=1))
    light = shaded(normal, stage.eye, colour)
    shadow = coverage(_flat(shade, stage)[stage.faces], stage.size).astype(np.float64)
    shadow = blur(shadow, round(_SHADOW_BLUR * stage.size)).ravel()[hits.pixel]
    light = light * np.where(is_part, 1.0, 1.0 - _SHADOW * shadow)[:, None]

    image = np.broadcast_to(_PAPER, (stage.size**2, 3)).copy()
    image[hits.pixel] = light
    side = stage.size // _OVERSAMPLING
    blocks = image.reshape(side, _OVERSAMPLING, side, _OVERSAMPLING, 3).mean(axis=(1, 3))
    picture = Image.fromarray(np.clip(np.rint(to_srgb(blocks) * 255), 0, 255).astype(np.uint8))
    text = f"{frame.lean_deg:.1f}°"
    ImageDraw.Draw(picture).text(
        (side * 0.04, side * 0.035), text, fill=_INK, font=ImageFont.load_default(side / 16)
    )
    return picture


def _leaning(azimuth_deg: float, lean_deg: float) -> Float:
    """(3, 3) rotation from the level bed to the leaning one, which leans to the right."""
    azimuth = np.radians(azimuth_deg)
    lean = _turn(np.array([-np.sin(azimuth), np.cos(azimuth), 0.0]), lean_deg)
    to_the_right = _AZIMUTH_DEG + 90.0 - _SWING_DEG - azimuth_deg
    return np.asarray(_turn(np.array([0.0, 0.0, 1.0]), to_the_right) @ lean)


def _turn(axis: Float, angle_deg: float) -> Float:
    """(3, 3) rotation about a unit axis (3,) (Rodrigues)."""
    angle = np.radians(angle_deg)
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def _placed(vertices: Float, frame: Frame) -> Float:
    """(n, 3) mm, vertices (n, 3) at their place in a frame, over the level bed."""
    return np.asarray(vertices @ frame.rotation.T + frame.shift_mm)


def _flat(points: Float, stage: _Stage) -> Float:
    """(n, 2) pixels of points (n, 3) mm, x to the right and y down."""
    plane = np.column_stack([dot(points, stage.right), -dot(points, stage.up)])
    return plane * stage.scale + stage.shift


def _slab(middle: Float, radius: float) -> tuple[Float, Int]:
    """(b, 3) mm, vertices, and (c, 3), faces of a round plate whose upper side is the bed.

    middle : (3,) mm.  Rings of small triangles draw faster than few large ones.
    """
    radii = radius * np.array([*np.linspace(0.0, 1.0, 13), 1.0])
    heights = np.array([*np.zeros(13), -_BED_THICKNESS * radius])
    around = np.arange(96) * (2 * np.pi / 96)
    rings = np.stack(
        [
            middle[0] + radii[:, None] * np.cos(around),
            middle[1] + radii[:, None] * np.sin(around),
            np.broadcast_to(heights[:, None], (len(radii), len(around))),
        ],
        axis=-1,
    )
    inner = np.arange(rings[..., 0].size).reshape(rings.shape[:2])
    a, b = inner[:-1], inner[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    quads = np.stack([a, b, c, a, c, d], axis=-1)
    return rings.reshape(-1, 3), quads.reshape(-1, 3)


def _key_frames(film: Film, stills: int) -> list[int]:
    """Indices of frames for the stills: half up to the tipping point, half over the fall."""
    tilt = np.array([frame.tilt_deg for frame in film.frames])
    leaves = int(np.argmax(tilt > 2.0)) if (tilt > 2.0).any() else len(tilt) - 1
    before = stills // 2
    first = np.linspace(0, leaves, before)
    turns = np.linspace(tilt[leaves], tilt.max(), stills - before + 1)[1:]
    later = [int(np.argmax(tilt >= turn - 1e-9)) for turn in turns]
    return [*(round(at) for at in first), *later]


def _spread(count: int, wanted: int) -> list[int]:
    """Indices of about ``wanted`` frames, evenly spread over ``count``."""
    return sorted({round(at) for at in np.linspace(0, count - 1, wanted)})


def _beside(pictures: list[Picture]) -> Picture:
    """The pictures side by side in one."""
    from PIL import Image

    width, height = pictures[0].size
    row = Image.new("RGB", (width * len(pictures), height))
    for at, picture in enumerate(pictures):
        row.paste(picture, (width * at, 0))
    return row
