"""The curve of mass against lean as a picture: the same drawing as SVG and as PNG."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from printprep.pipeline.explore import Exploration

WIDTH, HEIGHT = 720, 440
LEFT, RIGHT, TOP, BOTTOM = 70, 24, 44, 56
INK, GRID, CURVE, MARK = "#222222", "#dddddd", "#c2410c", "#1d4ed8"
SCALE = 2  # PNG pixels for each unit of the drawing, so that lines are sharp


@dataclass
class Drawing:
    """Lines, dots and labels in a picture of WIDTH × HEIGHT, y downward.

    lines : points (x, y), colour, width;  dots : x, y, colour;
    labels : x, y, text, anchor ("start", "middle" or "end"), font size.
    """

    lines: list[tuple[list[tuple[float, float]], str, float]] = field(default_factory=list)
    dots: list[tuple[float, float, str]] = field(default_factory=list)
    labels: list[tuple[float, float, str, str, int]] = field(default_factory=list)

    def svg(self) -> bytes:
        """The drawing as SVG; labels stay text."""
        rows = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
            'font-family="sans-serif">',
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        ]
        for points, colour, width in self.lines:
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            rows.append(
                f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"/>'
            )
        rows += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{c}"/>' for x, y, c in self.dots]
        rows += [
            f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'fill="{INK}">{escape(text)}</text>'
            for x, y, text, anchor, size in self.labels
        ]
        return ("\n".join([*rows, "</svg>"]) + "\n").encode()

    def png(self) -> bytes:
        """The drawing as PNG."""
        from PIL import Image, ImageDraw, ImageFont

        image = Image.new("RGB", (WIDTH * SCALE, HEIGHT * SCALE), "white")
        pen = ImageDraw.Draw(image)
        for points, colour, width in self.lines:
            scaled = [(x * SCALE, y * SCALE) for x, y in points]
            pen.line(scaled, fill=colour, width=round(width * SCALE), joint="curve")
        for x, y, colour in self.dots:
            pen.ellipse([(v + d) * SCALE for d in (-4, 4) for v in (x, y)], fill=colour)
        anchors = {"start": "ls", "middle": "ms", "end": "rs"}
        for x, y, text, anchor, size in self.labels:
            font = ImageFont.load_default(size * SCALE)
            pen.text((x * SCALE, y * SCALE), text, INK, font, anchor=anchors[anchor])
        out = io.BytesIO()
        image.save(out, "PNG", optimize=False)
        return out.getvalue()


def write_chart(found: Exploration, path: Path) -> None:
    """Write the chart as SVG, or as PNG for any other suffix than .svg.

    Raises OutputError if the file cannot be written.
    """
    from printprep.files import write_atomically

    drawing = chart(found)
    write_atomically(path, drawing.svg() if path.suffix.lower() == ".svg" else drawing.png())


def chart(found: Exploration) -> Drawing:
    """Mass in g over lean in degrees: the optimal curve, and the marks to compare it with."""
    drawing = Drawing()
    marks = [mark for mark in found.marks if mark.tilt_deg is not None]
    leans = [point.lean_deg for point in found.points] + [mark.tilt_deg or 0 for mark in marks]
    masses = [point.mass_g for point in found.points] + [mark.mass_g for mark in marks]
    x_ticks = _ticks(min(0.0, *leans), max(1.0, *leans))
    y_ticks = _ticks(0.0, max(masses))

    def place(lean: float, mass: float) -> tuple[float, float]:
        across = (lean - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        up = (mass - y_ticks[0]) / (y_ticks[-1] - y_ticks[0])
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - up * (
            HEIGHT - TOP - BOTTOM
        )

    for tick in x_ticks:
        x, y = place(tick, y_ticks[0])
        drawing.lines.append(([(x, y), place(tick, y_ticks[-1])], GRID, 1))
        drawing.labels.append((x, y + 18, f"{tick:g}", "middle", 13))
    for tick in y_ticks:
        x, y = place(x_ticks[0], tick)
        drawing.lines.append(([(x, y), place(x_ticks[-1], tick)], GRID, 1))
        drawing.labels.append((x - 8, y + 4, f"{tick:g}", "end", 13))
    middle = (LEFT + WIDTH - RIGHT) / 2
    drawing.labels.append(
        (middle, HEIGHT - 14, "lean at which it tips over, degrees", "middle", 14)
    )
    drawing.labels.append((LEFT, TOP - 26, f"{found.name}: least mass, g", "start", 16))
    curve = [place(point.lean_deg, point.mass_g) for point in found.points]
    if curve:
        drawing.lines.append((curve, CURVE, 2.5))
        drawing.dots += [(x, y, CURVE) for x, y in curve]
    for mark in marks:
        x, y = place(mark.tilt_deg or 0, mark.mass_g)
        right = x < (LEFT + WIDTH) / 2
        drawing.dots.append((x, y, MARK))
        anchor = "start" if right else "end"
        drawing.labels.append((x + (9 if right else -9), y - 7, mark.name, anchor, 13))
    return drawing


def _ticks(low: float, high: float) -> list[float]:
    """Five to ten round numbers that span low to high."""
    span = high - low
    step = 10.0 ** np.floor(np.log10(span))
    step *= next(factor for factor in (0.1, 0.2, 0.5, 1.0, 2.0) if span / (step * factor) <= 9)
    first, last = np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9)
    return [float(f"{k * step:.6g}") for k in range(int(first), int(last) + 1)]
