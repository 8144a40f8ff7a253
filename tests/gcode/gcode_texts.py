"""G-code of closed form: a cuboid of parallel beads, in the way each slicer would say it."""

from __future__ import annotations

import math

AREA_175 = math.pi / 4 * 1.75**2
WIDTH, HEIGHT = 0.5, 0.2


def beads(
    *,
    length: float = 20.0,
    lines: int = 40,
    layers: int = 50,
    relative: bool = True,
    label: str = ";TYPE:Solid infill",
    width: str = ";WIDTH:{:g}",
    height: str = ";HEIGHT:{:g}",
    per_mm: float = WIDTH * HEIGHT / AREA_175,
    at: tuple[float, float] = (100.0, 100.0),
) -> str:
    """A cuboid length × lines · WIDTH × layers · HEIGHT, its low corner at ``at``.

    Every bead is a box of WIDTH × HEIGHT: E is that volume over the filament's area.
    """
    x, y = at
    e = 0.0
    text = ["G21", "G90", "M83" if relative else "M82", "G92 E0", label]
    text += [form.format(value) for form, value in ((width, WIDTH), (height, HEIGHT)) if form]
    for layer in range(layers):
        text.append(f"G1 Z{(layer + 1) * HEIGHT:.3f} F600")
        for line in range(lines):
            across = y + (line + 0.5) * WIDTH
            text.append(f"G1 X{x:.3f} Y{across:.3f}")
            e = length * per_mm if relative else e + length * per_mm
            text.append(f"G1 X{x + length:.3f} E{e:.8f} ; a bead")
        if not relative and layer % 7 == 6:
            text.append("G92 E0")
            e = 0.0
    return "\n".join(text) + "\n"


FILAMENT = "; filament_diameter = 1.75\n; filament_density = 1.25\n"
