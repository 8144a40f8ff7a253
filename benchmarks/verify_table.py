"""Hollow models of a catalogue, slice each with the real slicer, and table the prints.

    python benchmarks/verify_table.py ../shared/models/catalogue.csv -o table.md [--size 100]

Every model goes through the library as in `printprep hollow` and `printprep verify`.  The figures
beside the computed ones are measured from PrusaSlicer's G-code.  Models with walls too thin for the
domain, or with a lean out of reach, are in the table like all others.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from rows import Row, markdown_lines, measured_rows, table_parser

from printprep import hollow
from printprep.gcode.printed import Printed
from printprep.gcode.stability import tilt_as_printed
from printprep.types import VaultChoice
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
    parser = table_parser(__doc__, only=MODELS)
    parser.add_argument("--bare", action="store_true", help="without supports inside cavities")
    chosen = parser.parse_args(arguments)

    def one(model: Path, up: str, _: Row) -> Row:
        return measure(model, up, chosen.size, chosen.profile, bare=chosen.bare)

    rows = measured_rows(chosen, one, markdown)
    return 0 if rows and all(agrees(row) for row in rows) else 1


def measure(model: Path, up: str, size_mm: float, profile: str, *, bare: bool = False) -> Row:
    """One row, from the model to the measured G-code, with the time."""
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.3mf"
        vaults: VaultChoice = "none" if bare else "printer"
        made = hollow(model, up=up, size_mm=size_mm, profile=profile, vaults=vaults)
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


def figures(part: ComputedPart, printed: Printed) -> Row:
    """The figures of a part, computed and printed, and their differences."""
    counted = printed.slicer_summary.filament_mm3
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
        "filament_off_percent": None if not counted else 100 * (printed.filament_mm3 / counted - 1),
        "print_hours": None
        if printed.slicer_summary.seconds is None
        else printed.slicer_summary.seconds / 3600,
    }


def agrees(row: Row) -> bool:
    """Whether the print agrees with the computed part: `printprep verify` has no findings."""
    return row.get("findings") == "none"


def markdown(rows: Sequence[Row]) -> str:
    """The rows as a table."""
    return "\n".join(markdown_lines(COLUMNS, rows)) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
