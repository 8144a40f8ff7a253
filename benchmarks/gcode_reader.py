"""Measure how much time and memory a large G-code takes.

    python benchmarks/gcode_reader.py [--megabytes 100]

The file is a cuboid of short beads as PrusaSlicer writes them.  The measured volume must be the
cuboid's, to the digits of E.
"""

from __future__ import annotations

import argparse
import math
import resource
import sys
import tempfile
import time
from pathlib import Path

from printprep.gcode.measure import measure_gcode

_SIDE_MM, _WIDTH_MM, _HEIGHT_MM, _STEP_MM = 50.0, 0.5, 0.2, 1.0
_HEAD = f"M83\n;TYPE:Solid infill\n;WIDTH:{_WIDTH_MM}\n;HEIGHT:{_HEIGHT_MM}\n"
_TAIL = "; filament_diameter = 1.75\n; filament_density = 1.24\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--megabytes", type=float, default=100.0)
    megabytes = parser.parse_args().megabytes
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.gcode"
        layers, moves = write(path, megabytes * 1e6)
        before, begun, used = peak_mb(), time.perf_counter(), time.process_time()
        printed = measure_gcode(path)
        took, used = time.perf_counter() - begun, time.process_time() - used
        print(
            f"{path.stat().st_size / 1e6:.0f} MB, {moves} moves: {took:.1f} s ({used:.1f} s of "
            f"processor), {peak_mb():.0f} MB of memory at most, {before:.0f} MB before"
        )
    expected_mm3 = _SIDE_MM**2 * layers * _HEIGHT_MM
    return 0 if math.isclose(printed.volume_mm3, expected_mm3, rel_tol=1e-3) else 1


def write(path: Path, size: float) -> tuple[int, int]:
    """Write layers until the file is that large; returns how many, and how many moves."""
    e = _STEP_MM * _WIDTH_MM * _HEIGHT_MM / (math.pi / 4 * 1.75**2)
    steps, lines = round(_SIDE_MM / _STEP_MM), round(_SIDE_MM / _WIDTH_MM)
    body = []
    for line in range(lines):
        y = 80 + (line + 0.5) * _WIDTH_MM
        body.append(f"G1 X80 Y{y:.3f} F9000")
        body += [f"G1 X{80 + n * _STEP_MM:.3f} Y{y:.3f} E{e:.5f}" for n in range(1, steps + 1)]
    layer = "\n".join(body) + "\n"
    layers = 0
    with path.open("w", encoding="ascii") as file:
        file.write(_HEAD)
        while file.tell() < size:
            layers += 1
            file.write(f"G1 Z{layers * _HEIGHT_MM:.3f}\n{layer}")
        file.write(_TAIL)
    return layers, layers * lines * (steps + 1)


def peak_mb() -> float:
    """The peak memory of this process so far, in MB."""
    kilo = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * kilo / 1e6


if __name__ == "__main__":
    raise SystemExit(main())
