"""The extruding moves of a G-code, read by other means than printprep's own reader."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Move:
    """A move that prints: start and end (x, y) mm, the slicer's type and width, filament used."""

    start: tuple[float, float]
    end: tuple[float, float]
    z_mm: float
    kind: str
    width_mm: float
    filament_mm: float


def extruding_moves(gcode: Path) -> Iterator[Move]:
    """Every extruding move that goes somewhere, as PrusaSlicer labels it (;TYPE:, ;WIDTH:)."""
    x = y = z = e = 0.0
    kind, width, relative = "", 0.45, False
    for line in gcode.read_text(encoding="utf-8").splitlines():
        if line.startswith(";TYPE:"):
            kind = line.removeprefix(";TYPE:")
        elif line.startswith(";WIDTH:"):
            width = float(line.removeprefix(";WIDTH:"))
        code, _, rest = line.partition(";")[0].partition(" ")
        if code in ("M82", "M83"):
            relative = code == "M83"
        elif code == "G92":
            e = next((float(word[1:]) for word in rest.split() if word[0] == "E"), e)
        elif code in ("G0", "G1"):
            words = {word[0]: float(word[1:]) for word in rest.split()}
            new_x, new_y, z = words.get("X", x), words.get("Y", y), words.get("Z", z)
            used = 0.0
            if "E" in words:
                used = words["E"] if relative else words["E"] - e
                e = words["E"]
            if used > 0 and (new_x, new_y) != (x, y):
                yield Move((x, y), (new_x, new_y), z, kind, width, used)
            x, y = new_x, new_y
