"""How the time of `hollow` grows with the triangles of the model and with --resolution.

    python benchmarks/growth_table.py samples/spot.stl -o growth.md

The model is subdivided, each triangle into four, so that it keeps its shape.  Each run is a process
of its own.  The exponent p of time ~ nᵖ is fitted to the logarithms of all rows.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import trimesh
from rows import Row, markdown_lines
from speed_table import run

from printprep.mesh.read import read_mesh

RESOLUTIONS = (64, 128, 256, 512)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="Markdown table")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--most", type=int, default=2_000_000, help="most triangles")
    chosen = parser.parse_args()
    raw = read_mesh(chosen.model)
    vertices, faces = np.asarray(raw.vertices), np.asarray(raw.faces)
    triangles, resolutions = [], []
    with tempfile.TemporaryDirectory() as name:
        while len(faces) <= chosen.most:
            file = Path(name) / "model.stl"
            trimesh.Trimesh(vertices, faces, process=False).export(file)
            triangles.append({"n": len(faces), **timed(file, chosen.size)})
            vertices, faces = trimesh.remesh.subdivide(vertices, faces)
        for resolution in RESOLUTIONS:
            more = ("--resolution", str(resolution))
            resolutions.append({"n": resolution, **timed(chosen.model, chosen.size, *more)})
    lines = [f"{platform.machine()}, {os.cpu_count()} processors", ""]
    for title, rows in (("triangles", triangles), ("--resolution", resolutions)):
        lines += [*table(title, rows), ""]
    chosen.output.write_text("\n".join(lines), encoding="utf-8", newline="\n")
    return 0


def timed(model: Path, size_mm: float, *more: str) -> Row:
    """Seconds, stages and memory of one run."""
    with tempfile.TemporaryDirectory() as name:
        out = Path(name) / "part.3mf"
        arguments = ["hollow", str(model), "--size", str(size_mm), "--json", "-o", str(out), *more]
        seconds, mib, report = run(arguments)
    stages = json.loads(report)["seconds"]
    return {"s": seconds, "mib": mib, **{f"stage_{key}": value for key, value in stages.items()}}


def table(title: str, rows: Sequence[Row]) -> list[str]:
    """The rows, and the fitted exponent."""
    stages = list(dict.fromkeys(key for row in rows for key in row if key.startswith("stage_")))
    columns = [
        (title, "n", "{:,}"),
        ("s", "s", "{:.1f}"),
        ("MiB", "mib", "{:.0f}"),
        *((key.removeprefix("stage_"), key, "{:.2f}") for key in stages),
    ]
    n, s = (np.log([row[key] for row in rows]) for key in ("n", "s"))
    power = float(np.polyfit(n, s, 1)[0])
    return [*markdown_lines(columns, rows), "", f"Time grows as n to the {power:.2f}."]


if __name__ == "__main__":
    raise SystemExit(main())
