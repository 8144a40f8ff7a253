"""Vault every room of a catalogue's models, and have the real slicer judge what is inside.

    python benchmarks/self_support.py ../shared/models/catalogue.csv -o table.md [--size 100]

The whole room is vaulted, before any of it is filled for stability: the hardest case.  Added share
is of that room; flagged area and islands are judged word by word, at places of the layers that the
building did not all look at; grams of support are PrusaSlicer's, inside the cavity, at its
automatic threshold and at 45°; the thinnest member is measured across the axis of each column's
solid.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from manifold3d import Manifold

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from dev_hollowable import hollowable_of
from rows import catalogue, markdown_lines
from support_inside import support_inside_g

from printprep.errors import PrintprepError
from printprep.mesh.measure import shells
from printprep.mesh.quantize import quantized
from printprep.overhang.limits import acceptance
from printprep.overhang.rule import unsupported_overhangs
from printprep.profiles import Profile, load_profile
from printprep.supports import vaulted

COLUMNS = (
    ("model", "model", "{}"),
    ("room cm³", "room_cm3", "{:.1f}"),
    ("capitals", "capitals", "{}"),
    ("columns", "columns", "{}"),
    ("added share", "share", "{:.3f}"),
    ("added g", "added_g", "{:.2f}"),
    ("flagged mm²", "flagged_mm2", "{:.3f}"),
    ("islands", "islands", "{}"),
    ("support auto g", "support_0_g", "{:.3f}"),
    ("support 45° g", "support_45_g", "{:.3f}"),
    ("thinnest mm", "thinnest_mm", "{:.3f}"),
    ("seconds", "seconds", "{:.1f}"),
    ("cpu s", "cpu_seconds", "{:.1f}"),
)
JUDGED_PHASES = (0.0, 0.2, 0.7)
AROUND_MM = 3.0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="markdown table")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--profile", default="fdm-pla-0.4")
    parser.add_argument("--only", nargs="*", help="file stems, all without")
    parser.add_argument("--no-slice", action="store_true")
    parser.add_argument("--json", type=Path, help="the rows as JSON too; those in it are kept")
    arguments = parser.parse_args()
    profile = load_profile(arguments.profile)
    kept = arguments.json is not None and arguments.json.exists()
    rows = json.loads(arguments.json.read_text(encoding="utf-8")) if kept else []
    done = {row["model"] for row in rows}
    for path, up in catalogue(arguments.catalogue, arguments.only):
        if path.stem in done:
            continue
        try:
            row = measure(path, up, arguments.size, profile, not arguments.no_slice)
        except (PrintprepError, ArithmeticError) as error:
            row = {"model": path.stem, "error": str(error)}
        rows.append(row)
        sys.stderr.write(json.dumps(row) + "\n")
        arguments.output.write_text(markdown(rows), encoding="utf-8")
        if arguments.json:
            arguments.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0 if all("error" not in row for row in rows) else 1


def measure(
    path: Path, up: str, size_mm: float, profile: Profile, slice_it: bool
) -> dict[str, Any]:
    """One row of the table."""
    solid, hollowable_volume = hollowable_of(path, up, size_mm, profile)
    if hollowable_volume.is_empty():
        return {"model": path.stem, "room_cm3": 0.0}
    wall, cpu = time.perf_counter(), time.process_time()
    vaults = vaulted(hollowable_volume, profile)
    row: dict[str, Any] = {
        "model": path.stem,
        "seconds": time.perf_counter() - wall,
        "cpu_seconds": time.process_time() - cpu,
        "room_cm3": hollowable_volume.volume() / 1000,
        "capitals": vaults.capitals,
        "columns": vaults.columns,
        "share": vaults.added_mm3 / hollowable_volume.volume(),
        "added_g": vaults.added_mm3 * profile.material.density_g_cm3 / 1000,
        "thinnest_mm": vaults.thinnest_mm,
    }
    if vaults.cavity.is_empty():
        return row
    written = quantized(solid - vaults.cavity)
    rule = acceptance(profile)
    blocks = [_around(void) - void for void in shells(written)[1]]
    found = [
        [unsupported_overhangs(block, rule, phase) for block in blocks] for phase in JUDGED_PHASES
    ]
    row["flagged_mm2"] = max(sum(item.area_mm2 for item in phase) for phase in found)
    row["islands"] = max(sum(item.islands for item in phase) for phase in found)
    if slice_it:
        for threshold in (0, 45):
            grams = support_inside_g(solid, vaults.cavity, profile, threshold)
            row[f"support_{threshold}_g"] = grams
    return row


def _around(void: Manifold) -> Manifold:
    """A block from the bed on, with material to spare around a void."""
    low, high = np.reshape(void.bounding_box(), (2, 3))
    low, high = low - AROUND_MM, high + AROUND_MM
    low[2] = 0.0
    return Manifold.cube((high - low).tolist()).translate(low.tolist())


def markdown(rows: list[dict[str, Any]]) -> str:
    lines = markdown_lines(COLUMNS, rows)
    shares = [row["share"] for row in rows if "share" in row]
    if shares:
        lines += ["", f"Mean added share {np.mean(shares):.4f} of {len(shares)} rooms."]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
