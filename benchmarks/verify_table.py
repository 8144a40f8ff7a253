"""Hollow models of a catalogue, slice each with the real slicer, and table what would be printed.

    python benchmarks/verify_table.py ../shared/models/catalogue.csv -o table.md [--size 100]

Every model goes through the library as `printprep hollow` and `printprep verify` take it; the
figures beside the computed ones are measured from PrusaSlicer's G-code.  Models whose walls the
domain cannot hold apart, or whose lean is out of reach, are in the table like all others.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rows import catalogue, markdown_lines

from printprep import hollow
from printprep.gcode.printed import Printed
from printprep.gcode.stability import tilt_as_printed
from printprep.verify.part_3mf import ComputedPart
from printprep.verify.rules import centre_limit_mm, centre_offset_mm, contact_offset_mm
from printprep.verify.run import verify

MODELS = (
    "spot_low_resolution", "koala_low_resolution", "goathead", "bunny", "bottle_A_brown",
    "penguin", "rabbit", "stuffedtoy", "cow", "fish_low_resolution", "teapot", "suzanne",
)  # fmt: skip
COLUMNS = (
    ("model", "model", "{}"),
    ("computed g", "computed_g", "{:.2f}"),
    ("printed g", "printed_g", "{:.2f}"),
    ("mass off %", "mass_off_percent", "{:+.1f}"),
    ("centre off mm", "centre_off_mm", "{:.2f}"),
    ("allowed mm", "centre_limit_mm", "{:.2f}"),
    ("contact off mm", "contact_off_mm", "{:.2f}"),
    ("tilt computed °", "tilt_computed_deg", "{:.2f}"),
    ("tilt printed °", "tilt_printed_deg", "{:.2f}"),
    ("in cavities mm³", "in_cavities_mm3", "{:.2f}"),
    ("support inside mm³", "support_in_cavities_mm3", "{:.2f}"),
    ("filament count off %", "filament_off_percent", "{:+.2f}"),
    ("findings", "findings", "{}"),
    ("print h", "print_hours", "{:.1f}"),
    ("seconds", "seconds", "{:.0f}"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="markdown table")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--profile", default="fdm-pla-0.4")
    parser.add_argument("--only", nargs="*", default=MODELS, help="file stems")
    parser.add_argument("--bare", action="store_true", help="without supports inside cavities")
    parser.add_argument("--json", type=Path, help="the rows as JSON, kept from run to run")
    chosen = parser.parse_args(arguments)
    kept: dict[str, dict[str, Any]] = {}
    if chosen.json and chosen.json.is_file():
        kept = {row["model"]: row for row in json.loads(chosen.json.read_text(encoding="utf-8"))}
    rows = []
    for model, up in catalogue(chosen.catalogue, chosen.only):
        row = kept.get(model.stem)
        if row is None:
            row = measure(model, up, chosen.size, chosen.profile, bare=chosen.bare)
            sys.stderr.write(json.dumps(row) + "\n")
        rows.append(row)
        chosen.output.write_text(markdown(rows), encoding="utf-8", newline="\n")
        if chosen.json:
            chosen.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0 if rows and all(agrees(row) for row in rows) else 1


def measure(
    model: Path, up: str, size_mm: float, profile: str, *, bare: bool = False
) -> dict[str, Any]:
    """One row: the whole way from the model to the measured G-code, timed."""
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.3mf"
        made = hollow(model, up=up, size_mm=size_mm, profile=profile, self_support=not bare)
        made.write(part)
        found = verify(part)
    return {
        "model": model.stem,
        "slicer": found.slicer,
        **figures(found.part, found.printed),
        "support_in_cavities_mm3": None
        if found.supported is None
        else found.supported.support_in_cavities_mm3,
        "findings": ", ".join(item.rule for item in found.findings) or "none",
        "seconds": time.perf_counter() - begun,
    }


def figures(part: ComputedPart, printed: Printed) -> dict[str, Any]:
    """A part's figures, computed and printed, and how far they are apart."""
    said = printed.slicer_summary.filament_mm3
    return {
        "bodies": len(part.bodies),
        "lean_deg": part.lean.angle_deg,
        "computed_g": part.mass_g,
        "printed_g": printed.mass_g,
        "mass_off_percent": 100 * (printed.mass_g / part.mass_g - 1),
        "centre_off_mm": centre_offset_mm(part, printed),
        "centre_limit_mm": centre_limit_mm(part),
        "contact_off_mm": contact_offset_mm(part, printed),
        "tilt_computed_deg": part.tilt_deg,
        "tilt_printed_deg": tilt_as_printed(printed, part.lean),
        "in_cavities_mm3": printed.in_cavities_mm3,
        "filament_off_percent": None if not said else 100 * (printed.filament_mm3 / said - 1),
        "print_hours": None
        if printed.slicer_summary.seconds is None
        else printed.slicer_summary.seconds / 3600,
    }


def agrees(row: dict[str, Any]) -> bool:
    """Whether the print is what was computed: what `printprep verify` finds nothing against."""
    return row["findings"] == "none"


def markdown(rows: Sequence[dict[str, Any]]) -> str:
    """The rows as a table."""
    lines = markdown_lines(COLUMNS, rows)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
