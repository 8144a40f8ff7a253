"""What layers of PrusaSlicer's SLA export hold shut: a judge that shares nothing with printprep.

An .sl1 is a zip of PNG layers, the lowest first.  Empty pixels that no way through layers joins to
the side of the picture are trapped; those that no way through layers up to their own joins are a
cup while that layer prints, or a pool when the part is poured out upright.  The plate is closed.
"""

from __future__ import annotations

import io
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from manifold3d import Manifold
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import generate_binary_structure, label

from printprep.mesh.quantize import quantized
from printprep.mesh.write import to_bytes
from printprep.slicer.child import run_child
from printprep.slicer.process import find_slicer

Bool = NDArray[np.bool_]

# A display this much wider than any part here, at pixels of PIXEL_MM.
DISPLAY_MM = 180
PIXEL_MM = 0.25
LAYER_MM = 0.25
MARGIN = 3
# Smaller regions are the pixels' corners, and one layer alone tells apart floors that differ by
# hundredths of a millimetre.
LEAST_MM2 = 2.0
LEAST_MM3 = 1.0
LEAST_LAYERS = 2


@dataclass(frozen=True)
class Shut:
    """What is shut in a part, by its layers.

    trapped_mm3 : joined to the outside through no layers at all.
    cups : regions shut toward the plate, wider than 2 mm² in some layer, above 1 mm³, over two
        layers and more.
    widest_mm2 : of all regions that are shut toward the plate, be they ever so small.
    """

    trapped_mm3: float
    cups: int
    widest_mm2: float


def empty_in_layers(part: Manifold) -> Bool:
    """(layers, rows, columns) pixels without material, cropped to the part and a margin.

    Parts of one outline give pictures that lie on each other.
    """
    pixels = round(DISPLAY_MM / PIXEL_MM)
    settings = {
        "printer_technology": "SLA",
        "bed_shape": f"0x0,{DISPLAY_MM}x0,{DISPLAY_MM}x{DISPLAY_MM},0x{DISPLAY_MM}",
        "display_width": DISPLAY_MM,
        "display_height": DISPLAY_MM,
        "display_pixels_x": pixels,
        "display_pixels_y": pixels,
        "display_orientation": "landscape",
        "max_print_height": DISPLAY_MM,
        "layer_height": LAYER_MM,
        "initial_layer_height": LAYER_MM,
        "supports_enable": 0,
        "pad_enable": 0,
        "elefant_foot_compensation": 0,
        "relative_correction": "1,1",
        "absolute_correction": 0,
    }
    with tempfile.TemporaryDirectory() as name:
        ini, stl, sl1 = (Path(name) / f"part.{suffix}" for suffix in ("ini", "stl", "sl1"))
        lines = [f"{key} = {value}" for key, value in settings.items()]
        ini.write_text("\n".join(lines) + "\n", encoding="utf-8")
        stl.write_bytes(to_bytes(quantized(part), ".stl"))
        arguments = ["--export-sla", "--load", str(ini), "--post-process", "", "--output", str(sl1)]
        done = run_child(find_slicer().executable, [*arguments, str(stl)], Path(name), 600)
        assert sl1.is_file(), done.stdout
        with zipfile.ZipFile(sl1) as archive:
            names = sorted(item for item in archive.namelist() if item.endswith(".png"))
            layers = [
                np.asarray(Image.open(io.BytesIO(archive.read(item))).convert("L")) < 128
                for item in names
            ]
    empty = np.stack(layers)
    rows, columns = (np.flatnonzero(~empty.all(axis=axes)) for axes in ((0, 2), (0, 1)))
    return empty[
        :,
        rows[0] - MARGIN : rows[-1] + MARGIN + 1,
        columns[0] - MARGIN : columns[-1] + MARGIN + 1,
    ]


def sealed(empty: Bool) -> Bool:
    """Empty pixels that are joined to the sides, above or below through no layers.

    What opens to the plate alone is shut by nothing but the plate: it is the model's own recess.
    """
    piece, _ = label(empty)
    outer = np.zeros(empty.shape, dtype=bool)
    outer[[0, -1]] = outer[:, [0, -1]] = outer[:, :, [0, -1]] = True
    reached = np.zeros(int(piece.max()) + 1, dtype=bool)
    reached[piece[outer]] = True
    return empty & ~reached[piece]


def shut_toward_plate(empty: Bool) -> Bool:
    """Empty pixels that no way through layers up to their own joins to the sides."""
    shut = np.zeros(empty.shape, dtype=bool)
    side = np.zeros(empty.shape[1:], dtype=bool)
    side[[0, -1]] = side[:, [0, -1]] = True
    below = np.zeros_like(side)
    for layer, pixels in enumerate(empty):
        piece, count = label(pixels)
        reached = np.zeros(count + 1, dtype=bool)
        reached[piece[(side | below) & pixels]] = True
        below = reached[piece]
        shut[layer] = pixels & ~below
    return shut


def judged(empty: Bool, region: Bool | None = None) -> Shut:
    """What is shut of a region of a part's pixels, all of them without."""
    within = empty if region is None else empty & region
    pixel = PIXEL_MM**2
    shut = shut_toward_plate(empty) & within
    piece, count = label(shut, structure=generate_binary_structure(3, 3))
    cells = np.bincount(piece.ravel(), minlength=count + 1)
    widest = np.zeros(count + 1, dtype=int)
    high = np.zeros(count + 1, dtype=int)
    for layer in piece:
        area = np.bincount(layer.ravel(), minlength=count + 1)
        widest, high = np.maximum(widest, area), high + (area > 0)
    cells[0] = widest[0] = 0
    real = (widest * pixel >= LEAST_MM2) & (cells * pixel * LAYER_MM >= LEAST_MM3)
    real &= high >= LEAST_LAYERS
    return Shut(
        trapped_mm3=float((sealed(empty) & within).sum()) * pixel * LAYER_MM,
        cups=int(real.sum()),
        widest_mm2=float(widest.max()) * pixel,
    )


def judged_with_and_without(drained: Manifold, undrained: Manifold) -> tuple[Shut, Shut]:
    """What is shut of the cavities of a part that drains, and of the same without its holes.

    What the model itself holds shut, as a mug does, counts in neither.
    """
    with_holes, without = empty_in_layers(drained), empty_in_layers(undrained)
    cavities = sealed(without)
    return judged(with_holes, cavities | (with_holes & ~without)), judged(without, cavities)
