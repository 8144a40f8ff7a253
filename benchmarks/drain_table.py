"""Drain a catalogue's models, and have the real slicer's layers judge what they hold shut.

    python benchmarks/drain_table.py ../shared/models/catalogue.csv -p resin-standard -o table.md

The judge is PrusaSlicer's SLA export at 0.25 mm layers and pixels: trapped and cupped is what its
pictures hold shut of the cavities, with the drains and without.  Diameters are measured across the
holes of the final mesh.  With --json, rows that a former run has found are kept.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from typing import Any

import trimesh
from manifold3d import Manifold, OpType

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from drain_measures import hole_diameter_mm
from rows import catalogue, markdown_lines
from sl1_layers import judged_with_and_without

from printprep.errors import PrintprepError
from printprep.mesh.quantize import quantized, quantized_arrays
from printprep.pipeline.hollow import hollow
from printprep.stand.lean import tilt_toward

COLUMNS = (
    ("model", "model", "{}"),
    ("mass g", "mass_g", "{:.1f}"),
    ("cavities", "cavities", "{}"),
    ("outlets", "outlets", "{}"),
    ("vents", "vents", "{}"),
    ("hole mm", "holes_mm", "{}"),
    ("filled cm³", "filled_cm3", "{:.2f}"),
    ("closed cm³", "closed_cm3", "{:.2f}"),
    ("sealed: trapped cm³", "sealed_cm3", "{:.1f}"),
    ("sealed: cups", "sealed_cups", "{}"),
    ("drained: trapped mm³", "trapped_mm3", "{:.1f}"),
    ("drained: cups", "cups", "{}"),
    ("widest mm²", "widest_mm2", "{:.1f}"),
    ("watertight", "watertight", "{}"),
    ("tips at °", "tilt_deg", "{:.2f}"),
    ("stands", "stands", "{}"),
    ("cpu s", "cpu_seconds", "{:.1f}"),
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="markdown table")
    parser.add_argument("-p", "--profile", default="resin-standard")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--only", nargs="*", help="file stems, all without")
    parser.add_argument("--json", type=Path, help="the rows as JSON, kept from run to run")
    arguments = parser.parse_args()
    kept = {}
    if arguments.json and arguments.json.is_file():
        kept = {row["model"]: row for row in json.loads(arguments.json.read_text("utf-8"))}
    rows = []
    for path, up in catalogue(arguments.catalogue, arguments.only):
        row = kept.get(path.stem)
        if row is None or "error" in row:
            try:
                row = measure(path, up, arguments.size, arguments.profile)
            except (PrintprepError, ArithmeticError) as error:
                row = {"model": path.stem, "error": str(error)}
            sys.stderr.write(json.dumps(row) + "\n")
        rows.append(row)
        arguments.output.write_text(markdown(rows), encoding="utf-8")
        if arguments.json:
            arguments.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0 if all("error" not in row for row in rows) else 1


def measure(path: Path, up: str, size_mm: float, profile: str) -> dict[str, Any]:
    """One row of the table."""
    start = time.process_time()
    result = hollow(path, up=up, size_mm=size_mm, profile=profile)
    seconds = time.process_time() - start
    found = result.drainage
    assert found is not None
    tilt = tilt_toward(result.stability, result.lean)
    part, wanted = result.part, found.drains[0].diameter_mm if found.drains else None
    off = [abs(hole_diameter_mm(part.manifold, drain) - wanted) for drain in found.drains]
    row: dict[str, Any] = {
        "model": path.stem,
        "mass_g": result.mass_g,
        "cavities": len(part.cavities),
        "outlets": sum(drain.role == "outlet" for drain in found.drains),
        "vents": sum(drain.role == "vent" for drain in found.drains),
        "holes_mm": f"{wanted:g} ± {max(off):.3f}" if off else None,
        "filled_cm3": found.filled_mm3 / 1000,
        "closed_cm3": sum(found.closed_mm3) / 1000,
        "watertight": "yes" if watertight(part.manifold) else "no",
        "tilt_deg": tilt,
        "stands": stands(result.density.reachable_deg, tilt, result.lean_deg),
        "cpu_seconds": seconds,
    }
    if not part.cavities:
        return row
    undrained = quantized(Manifold.batch_boolean([part.outside, *part.cavities], OpType.Subtract))
    with_holes, without = judged_with_and_without(part.manifold, undrained)
    return row | {
        "sealed_cm3": without.trapped_mm3 / 1000,
        "sealed_cups": without.cups,
        "trapped_mm3": with_holes.trapped_mm3,
        "cups": with_holes.cups,
        "widest_mm2": with_holes.widest_mm2,
    }


def watertight(part: Manifold) -> bool:
    """By trimesh, from the coordinates that are written."""
    vertices, faces = quantized_arrays(part)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    return bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0)


def stands(reachable_deg: float | None, tilt_deg: float | None, lean_deg: float) -> str:
    if tilt_deg is not None and tilt_deg >= lean_deg:
        return "yes"
    return "no" if reachable_deg is None else "out of reach"


def markdown(rows: list[dict[str, Any]]) -> str:
    lines = markdown_lines(COLUMNS, rows)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
