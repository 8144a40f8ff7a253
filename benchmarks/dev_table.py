"""Hollow every model of a catalogue, judge what was written, and make a table of it.

    python benchmarks/dev_table.py ../shared/models/catalogue.csv -o table.md [--size 100] [--json]

Each model goes through the installed command; its 3MF is then judged by lib3mf in strict mode, by
prusa-slicer (--info, and a whole slice, whose G-code is measured) and by libigl, none of which is
printprep.
"""

from __future__ import annotations

import argparse
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
from rows import catalogue, markdown_lines

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
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="markdown table")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--profile", default="fdm-pla-0.4")
    parser.add_argument("--only", nargs="*", help="file stems, all without")
    parser.add_argument("--no-slice", action="store_true")
    parser.add_argument("--no-self-support", action="store_true", help="no vaults inside")
    parser.add_argument("--json", type=Path, help="the rows as JSON too")
    arguments = parser.parse_args()
    rows = []
    for model, up in catalogue(arguments.catalogue, arguments.only):
        row = measure(
            model,
            up,
            arguments.size,
            arguments.profile,
            slice_it=not arguments.no_slice,
            vaults=not arguments.no_self_support,
        )
        rows.append(row)
        sys.stderr.write(json.dumps(row) + "\n")
    arguments.output.write_text(markdown(rows), encoding="utf-8")
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0 if all(row["exit"] == 0 for row in rows) else 1


def measure(
    model: Path, up: str, size_mm: float, profile: str, *, slice_it: bool, vaults: bool = True
) -> dict[str, Any]:
    """One row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.3mf"
        command = [sys.executable, "-m", "printprep", "hollow", str(model), "-o", str(part)]
        command += ["--up", up, "--size", str(size_mm), "--profile", profile, "--json"]
        command += [] if vaults else ["--no-self-support"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        row: dict[str, Any] = {"model": model.stem, "exit": ran.returncode, "stderr": ran.stderr}
        if ran.returncode != 0:
            return {**row, "error": ran.stdout}
        said = json.loads(ran.stdout)
        row |= {key: said[key] for key in ("solid_mass_g", "mass_g", "mass_ratio", "tilt_deg")}
        row |= {key: said[key] for key in ("tilt_solid_deg", "reachable_deg", "wall_min_mm")}
        row["repair"] = said["repair"]["rung"]
        row["cavities"] = said["cavities"]["count"]
        held = said["supports"]
        row["unsupported_mm2"] = 0 if held is None else held["unsupported_mm2"]
        row["islands"] = 0 if held is None else held["islands"]
        row["vaults"] = None if held is None else f"{held['added_g']:.2f}"
        row["base"] = base_text(said["base"])
        row["seconds"] = sum(said["seconds"].values())
        row["stages"] = said["seconds"]
        row["errors"] = [f["rule"] for f in said["findings"] if f["severity"] == "error"]
        return row | judged(model, up, size_mm, part, slice_it)


def judged(model: Path, up: str, size_mm: float, part: Path, slice_it: bool) -> dict[str, Any]:
    """What others say of the written file."""
    mesh, warnings = judges.read_strictly(part)
    placed = place(read_mesh(model), up=up, size_mm=size_mm)
    outside, _ = judges.outside_and_cavities(mesh)
    points = judges.samples(judges.Mesh(placed.vertices, placed.faces))
    squared, _, _ = igl.point_mesh_squared_distance(points, outside.vertices, outside.faces)
    # Where a base was added, the input's outside is buried in it, up to the seat's height.
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


def markdown(rows: list[dict[str, Any]]) -> str:
    lines = markdown_lines(COLUMNS, rows)
    feasible = [row for row in rows if row["exit"] == 0 and row["reachable_deg"] is None]
    if feasible:
        ratio = np.mean([row["mass_ratio"] for row in feasible])
        lines.append("")
        lines.append(
            f"Feasible: {len(feasible)} of {len(rows)}; their mean mass ratio {ratio:.3f}."
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
