"""Hollow every model of a catalogue, judge the written parts, and table them.

    python benchmarks/dev_table.py ../shared/models/catalogue.csv -o table.md [--size 100] [--json]

Each model goes through the installed command.  Then lib3mf in strict mode, prusa-slicer (--info,
and a whole slice, whose G-code is measured) and libigl judge its 3MF: none of them is printprep.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

import igl
import judges
import verify_table
from rows import Row, markdown_lines, measured_rows, table_parser

from printprep.mesh.place import place
from printprep.mesh.read import read_mesh
from printprep.slicer.process import find_slicer
from printprep.verify.part_3mf import computed_part
from printprep.verify.run import settings_for, slice_and_measure

COLUMNS = (
    ("model", "model", "{}"),
    ("triangles", "triangles", "{}"),
    ("repair", "repair", "{}"),
    ("solid g", "solid_mass_g", "{:.1f}"),
    ("part g", "mass_g", "{:.2f}"),
    ("ratio", "mass_ratio", "{:.3f}"),
    ("tilt before °", "tilt_solid_deg", "{:.1f}"),
    ("tilt after °", "tilt_deg", "{:.1f}"),
    ("reachable °", "reachable_deg", "{:.1f}"),
    ("base", "base", "{}"),
    ("vaults g", "vaults", "{}"),
    ("wall mm", "judged_wall_mm", "{:.3f}"),
    ("outside moved mm", "outside_moved_mm", "{:.5f}"),
    ("cavities", "cavities", "{}"),
    ("lib3mf", "lib3mf", "{}"),
    ("manifold", "manifold", "{}"),
    ("sliced", "sliced", "{}"),
    ("seconds", "seconds", "{:.1f}"),
)


def main() -> int:
    parser = table_parser(__doc__)
    parser.add_argument("--no-slice", action="store_true")
    parser.add_argument("--no-self-support", action="store_true", help="no vaults inside")
    chosen = parser.parse_args()

    def one(model: Path, up: str, _: Row) -> Row:
        return measure(
            model,
            up,
            chosen.size,
            chosen.profile,
            slice_it=not chosen.no_slice,
            vaults=not chosen.no_self_support,
        )

    rows = measured_rows(chosen, one, markdown)
    return 0 if all("error" not in row for row in rows) else 1


def measure(
    model: Path, up: str, size_mm: float, profile: str, *, slice_it: bool, vaults: bool = True
) -> Row:
    """One row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.3mf"
        command = [sys.executable, "-m", "printprep", "hollow", str(model), "-o", str(part)]
        command += ["--up", up, "--size", str(size_mm), "--profile", profile, "--json"]
        command += [] if vaults else ["--no-self-support"]
        ran = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
        row: Row = {"model": model.stem, "exit": ran.returncode, "stderr": ran.stderr}
        if ran.returncode != 0:
            return {**row, "error": ran.stdout}
        told = json.loads(ran.stdout)
        row |= {key: told[key] for key in ("solid_mass_g", "mass_g", "mass_ratio", "tilt_deg")}
        row |= {key: told[key] for key in ("tilt_solid_deg", "reachable_deg", "wall_min_mm")}
        row["repair"] = told["repair"]["rung"]
        row["cavities"] = told["cavities"]["count"]
        held = told["supports"]
        row["unsupported_mm2"] = 0 if held is None else held["unsupported_mm2"]
        row["islands"] = 0 if held is None else held["islands"]
        row["vaults"] = None if held is None else f"{held['added_g']:.2f}"
        row["base"] = base_text(told["base"])
        row["seconds"] = sum(told["seconds"].values())
        row["stages"] = told["seconds"]
        row["errors"] = [f["rule"] for f in told["findings"] if f["severity"] == "error"]
        return row | judged(model, up, size_mm, part, slice_it)


def judged(model: Path, up: str, size_mm: float, part: Path, slice_it: bool) -> Row:
    """Judge the written file with other programs."""
    mesh, warnings = judges.read_strictly(part)
    placed = place(read_mesh(model), up=up, size_mm=size_mm)
    outside, _ = judges.outside_and_cavities(mesh)
    points = judges.samples(judges.Mesh(placed.vertices, placed.faces))
    squared, _, _ = igl.point_mesh_squared_distance(points, outside.vertices, outside.faces)
    # A base covers the input's outside, up to the seat's height.
    above = points[:, 2] > 1.05
    slicer = find_slicer()
    info = slicer.info(part)
    row = {
        "triangles": len(placed.faces),
        "judged_wall_mm": judges.thinnest_wall_mm(mesh),
        "outside_moved_mm": float(np.sqrt(squared[above].max())) if above.any() else 0.0,
        "lib3mf": "clean" if not warnings else "; ".join(warnings),
        "manifold": "yes" if info.manifold else "no",
        "sliced": "–",
    }
    if slice_it:
        carried = computed_part(part)
        settings = settings_for(carried, None)
        printed, _ = slice_and_measure(slicer, carried, settings, None, part.parent)
        row |= {"sliced": "yes", **verify_table.figures(carried, printed)}
    return row


def base_text(base: dict[str, Any] | None) -> str:
    if base is None:
        return "none"
    grown = f" + {base['growth_mm']:g} mm" if base["growth_mm"] else ""
    return f"seat{grown}, {base['mass_g']:.2f} g"


def markdown(rows: list[Row]) -> str:
    lines = markdown_lines(COLUMNS, rows)
    feasible = [row for row in rows if "error" not in row and row["reachable_deg"] is None]
    if feasible:
        ratio = np.mean([row["mass_ratio"] for row in feasible])
        lines.append("")
        lines.append(
            f"Feasible: {len(feasible)} of {len(rows)}; their mean mass ratio {ratio:.3f}."
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
