"""Vault the hollowable volumes of a catalogue's models, and let the real slicer judge them.

    python benchmarks/self_support.py ../shared/models/catalogue.csv -o table.md [--size 100]

The whole hollowable volume is vaulted, before any of it is filled for stability: the hardest case.
The added share is a share of that volume.  Flagged area and islands follow the rule word by word,
at layer phases that the building does not all use.  Grams of support are PrusaSlicer's, inside the
cavity, at its automatic threshold and at 45°.  The thinnest member is measured across the axis of
each column's solid.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from manifold3d import Manifold

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from dev_hollowable import hollowable_of
from rows import Row, markdown_lines, measured_rows, table_parser
from support_inside import support_inside_g

from printprep.mesh.measure import shells
from printprep.mesh.quantize import quantized
from printprep.overhang.limits import acceptance
from printprep.overhang.rule import unsupported_overhangs
from printprep.profiles import Profile, load_profile
from printprep.supports import vaulted

COLUMNS = (
    ("model", "model", "{}"),
    ("hollowable cm³", "hollowable_cm3", "{:.1f}"),
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
    parser = table_parser(__doc__)
    parser.add_argument("--no-slice", action="store_true")
    chosen = parser.parse_args()
    profile = load_profile(chosen.profile)

    def one(path: Path, up: str, _: Row) -> Row:
        return measure(path, up, chosen.size, profile, not chosen.no_slice)

    rows = measured_rows(chosen, one, markdown)
    return 0 if all("error" not in row for row in rows) else 1


def measure(path: Path, up: str, size_mm: float, profile: Profile, slice_it: bool) -> Row:
    """One row of the table."""
    solid, hollowable_volume = hollowable_of(path, up, size_mm, profile)
    if hollowable_volume.is_empty():
        return {"model": path.stem, "hollowable_cm3": 0.0}
    wall, cpu = time.perf_counter(), time.process_time()
    vaults = vaulted(hollowable_volume, profile)
    row: Row = {
        "model": path.stem,
        "seconds": time.perf_counter() - wall,
        "cpu_seconds": time.process_time() - cpu,
        "hollowable_cm3": hollowable_volume.volume() / 1000,
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
    """A block on the bed, with enough material around a void."""
    low, high = np.reshape(void.bounding_box(), (2, 3))
    low, high = low - AROUND_MM, high + AROUND_MM
    low[2] = 0.0
    return Manifold.cube((high - low).tolist()).translate(low.tolist())


def markdown(rows: list[Row]) -> str:
    lines = markdown_lines(COLUMNS, rows)
    shares = [row["share"] for row in rows if "share" in row]
    if shares:
        lines += [
            "",
            f"Mean added share {np.mean(shares):.4f} over {len(shares)} models.",
        ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
