"""Drain a catalogue's models, and let the real slicer's layers judge what they trap.

    python benchmarks/drain_table.py ../shared/models/catalogue.csv -p resin-standard -o table.md

The judge is PrusaSlicer's SLA export at 0.25 mm layers and pixels: its pictures show what the
cavities trap and where they are cups, with the drains and without.  Diameters are measured across
the holes of the final mesh.  --json keeps the rows of earlier runs.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import trimesh
from manifold3d import Manifold, OpType

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from drain_measures import hole_diameter_mm
from rows import Row, markdown_lines, measured_rows, table_parser
from sl1_layers import judged_with_and_without

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
    chosen = table_parser(__doc__, profile="resin-standard").parse_args()

    def one(path: Path, up: str, _: Row) -> Row:
        return measure(path, up, chosen.size, chosen.profile)

    rows = measured_rows(chosen, one, markdown)
    return 0 if all("error" not in row for row in rows) else 1


def measure(path: Path, up: str, size_mm: float, profile: str) -> Row:
    """One row of the table."""
    start = time.process_time()
    result = hollow(path, up=up, size_mm=size_mm, profile=profile)
    seconds = time.process_time() - start
    found = result.drainage
    assert found is not None
    tilt = tilt_toward(result.stability, result.lean)
    part, wanted = result.part, found.drains[0].diameter_mm if found.drains else None
    off = [abs(hole_diameter_mm(part.manifold, drain) - wanted) for drain in found.drains]
    row: Row = {
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
    """Whether trimesh finds the written coordinates watertight."""
    vertices, faces = quantized_arrays(part)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    return bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0)


def stands(reachable_deg: float | None, tilt_deg: float | None, lean_deg: float) -> str:
    if tilt_deg is not None and tilt_deg >= lean_deg:
        return "yes"
    return "no" if reachable_deg is None else "out of reach"


def markdown(rows: list[Row]) -> str:
    return "\n".join(markdown_lines(COLUMNS, rows)) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
