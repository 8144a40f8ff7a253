"""How long whole runs take on a catalogue's models, beside a slicer that slices the same model.

    python benchmarks/speed_table.py ../shared/models/catalogue.csv -o table.md --slicer PRUSA

Each command is a process of its own, timed from its start to its end: `hollow` with the default
profile, without vaults, and for resin with drain holes; `check` of the first part; and the slicer,
of the model with walls as thick and 15 % gyroid, and of the part.  The stages are those that
`hollow --json` reports.  Beside them, what prints: hours and grams by the slicer's G-code, for the
model with 15 % gyroid and lightning, for `--fill infill`, and for the part.  The file of --json
keeps the rows, and later runs go on there.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from argparse import Namespace
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rows import Row, markdown_lines, measured_rows, table_parser

from printprep.errors import PrintprepError, ToolError
from printprep.gcode.measure import measure_gcode
from printprep.mesh.write import to_bytes
from printprep.output.prusa_keys import wall_keys, without_columns
from printprep.pipeline.options import Placement
from printprep.pipeline.prepare import prepare
from printprep.profiles import Profile, load_profile
from printprep.progress import SILENT
from printprep.slicer.process import Slicer, find_slicer
from printprep.slicer.prusa_ini import profile_settings
from printprep.threemf.read import read_3mf

if TYPE_CHECKING:
    from manifold3d import Manifold

# What is to be at most so many times what: the goals of the table's last lines.
RATIOS = (
    ("hollow", "hollow_s", "gyroid_s", 0.5),
    ("without vaults", "plain_s", "gyroid_s", 0.3),
    ("resin with drains", "resin_s", "gyroid_s", 0.75),
    ("check", "check_s", "gyroid_s", 0.25),
    ("slicing the part", "part_s", "gyroid_s", 2.0),
)


def main() -> int:
    parser = table_parser(__doc__)
    parser.add_argument("--slicer", type=Path, help="the PrusaSlicer to compare with")
    chosen = parser.parse_args()
    profile = load_profile(chosen.profile)
    slicer = find_slicer(chosen.slicer)

    def one(path: Path, up: str, kept: Row) -> Row:
        row = kept if "hollow_s" in kept else measured(path, up, chosen, profile, slicer)
        return row | other_prints(path, up, chosen, profile, slicer)

    rows = measured_rows(
        chosen, one, lambda rows: table(rows, slicer.name), done=lambda row: "infill_h" in row
    )
    return 0 if all("error" not in row for row in rows) else 1


def measured(path: Path, up: str, chosen: Namespace, profile: Profile, slicer: Slicer) -> Row:
    """One row of the table."""
    row: Row = {"model": path.stem}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        part, model = folder / "part.3mf", folder / "model.stl"
        common = [str(path), "--up", up, "--size", str(chosen.size), "--json"]
        hollow = ["hollow", *common, "-p", chosen.profile]
        seconds, mib, report = run([*hollow, "-o", str(part)])
        figures = json.loads(report)
        row |= {"hollow_s": seconds, "hollow_mib": mib}
        row |= {f"stage_{key}": value for key, value in figures["seconds"].items()}
        plain = [*hollow, "--vaults", "none", "-o", str(folder / "plain.3mf")]
        row["plain_s"], _, _ = run(plain)
        resin = ["hollow", *common, "-p", "resin-standard", "-o", str(folder / "resin.3mf")]
        row["resin_s"], _, _ = run(resin)
        row["check_s"], _, _ = run(["check", str(part), "-p", chosen.profile])
        prepared = prepare(path, profile, Placement(up=up, size_mm=chosen.size), SILENT)
        row["triangles_in"] = prepared.solid.manifold.num_tri()
        row["triangles"] = len(read_3mf(part).faces)
        row["file_mib"] = part.stat().st_size / 2**20

        row |= sliced("part", slicer, part, profile_settings(profile), folder)
        plate(prepared.solid.manifold, profile, model)
        with contextlib.suppress(ToolError):  # a foot that is a point has no layer
            row |= sliced("gyroid", slicer, model, uniform(profile, "gyroid"), folder)
    return row


def other_prints(path: Path, up: str, chosen: Namespace, profile: Profile, slicer: Slicer) -> Row:
    """Hours and grams of the model with lightning, and with infill as printprep plans it."""
    row: Row = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        part, model = folder / "part.3mf", folder / "model.stl"
        common = ["--up", up, "--size", str(chosen.size), "-p", chosen.profile]
        own = [] if chosen.slicer is None else ["--slicer", str(chosen.slicer)]
        run(["hollow", str(path), *common, "--fill", "infill", *own, "-o", str(part)])
        row |= sliced("infill", slicer, part, profile_settings(profile), folder)
        prepared = prepare(path, profile, Placement(up=up, size_mm=chosen.size), SILENT)
        plate(prepared.solid.manifold, profile, model)
        with contextlib.suppress(ToolError):
            row |= sliced("lightning", slicer, model, uniform(profile, "lightning"), folder)
    return row


def plate(solid: Manifold, profile: Profile, file: Path) -> None:
    """Write a solid as STL, in the middle of the bed."""
    x, y, _ = profile.printer.bed_mm
    file.write_bytes(to_bytes(solid.translate((x / 2, y / 2, 0)), ".stl"))


def uniform(profile: Profile, pattern: str) -> dict[str, str]:
    """A slicer's settings for walls as thick as the part's, and 15 % of one infill."""
    return {
        **without_columns(profile_settings(profile)),
        **wall_keys(profile),
        "fill_density": "15%",
        "fill_pattern": pattern,
    }


# A process counts the memory of the one that starts it as its own: this one is small.
_STARTER = """
import os, subprocess, sys, time
start = time.perf_counter()
child = subprocess.Popen(sys.argv[1:])
_, status, usage = os.wait4(child.pid, 0)
seconds = time.perf_counter() - start
print(os.waitstatus_to_exitcode(status), seconds, usage.ru_maxrss / 1024, file=sys.stderr)
"""


def run(arguments: Sequence[str]) -> tuple[float, float, str]:
    """Wall seconds, most memory in MiB, and standard output of one command of printprep."""
    command = [sys.executable, "-c", _STARTER, sys.executable, "-m", "printprep", *arguments]
    # As installed: modules are compiled once, not in every run
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False, env=kept)
    *said, last = done.stderr.splitlines()
    code, seconds, mib = last.split()
    if int(code) not in (0, 1):
        raise PrintprepError("\n".join(said)[-500:])
    return float(seconds), float(mib), done.stdout


def sliced(name: str, slicer: Slicer, file: Path, settings: Mapping[str, str], folder: Path) -> Row:
    """Wall seconds, grams and hours of one slice."""
    gcode = folder / "print.gcode"
    start = time.perf_counter()
    slicer.slice(file, gcode, settings)
    seconds = time.perf_counter() - start
    printed = measure_gcode(gcode)
    assert printed.slicer_summary.seconds is not None
    return {
        f"{name}_s": seconds,
        f"{name}_g": printed.mass_g,
        f"{name}_h": printed.slicer_summary.seconds / 3600,
    }


COLUMNS = (
    ("model", "model", "{}"),
    ("triangles in", "triangles_in", "{}"),
    ("out", "triangles", "{}"),
    ("MiB", "file_mib", "{:.2f}"),
    ("hollow s", "hollow_s", "{:.1f}"),
    ("memory MiB", "hollow_mib", "{:.0f}"),
    ("no vaults s", "plain_s", "{:.1f}"),
    ("resin s", "resin_s", "{:.1f}"),
    ("check s", "check_s", "{:.1f}"),
    ("slicer: gyroid s", "gyroid_s", "{:.1f}"),
    ("part s", "part_s", "{:.1f}"),
    ("part / gyroid", "part_ratio", "{:.2f}"),
)
PRINTS = (
    COLUMNS[0],
    *((f"{name} h", f"{name}_h", "{:.2f}") for name in ("gyroid", "lightning", "infill", "part")),
    *((f"{name} g", f"{name}_g", "{:.1f}") for name in ("gyroid", "lightning", "infill", "part")),
)


def table(rows: Sequence[Row], slicer: str) -> str:
    """The runs, their stages, and ratios to the slicer."""
    stages = list(dict.fromkeys(key for row in rows for key in row if key.startswith("stage_")))
    rows = [
        row | ({"part_ratio": row["part_s"] / row["gyroid_s"]} if "gyroid_s" in row else {})
        for row in rows
    ]
    columns = [COLUMNS[0], *((key.removeprefix("stage_"), key, "{:.2f}") for key in stages)]
    lines = [f"{platform.machine()}, {os.cpu_count()} processors, {slicer}", ""]
    lines += markdown_lines(COLUMNS, rows)
    lines += ["", "What prints, by the slicer:", "", *markdown_lines(PRINTS, rows)]
    lines += ["", "Seconds of each stage of `hollow`:", "", *markdown_lines(columns, rows), ""]
    for title, ours, other, goal in RATIOS:
        found = {row["model"]: row[ours] / row[other] for row in rows if row.get(other)}
        if found:
            worst = max(found, key=lambda model: found[model])
            lines.append(
                f"- {title}: {np.median(list(found.values())):.2f} × the slicer with 15 % gyroid "
                f"at the median (goal {goal:g}), at most {found[worst]:.2f} × ({worst})."
            )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
