"""Compare infill with ballast to other ways to print a model, all weighed in G-code.

    python benchmarks/infill_table.py ../shared/models/catalogue.csv -o table.md [--size 100]

Each model is sliced four ways with the same profile: with `--fill infill`; with the same walls and
uniform lightning, and 15 % gyroid, without base or ballast; and hollow, with vaults inside.  The
file of --json keeps the rows, and later runs read them from it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rows import Row, markdown_lines, measured_rows, table_parser
from verify_table import MODELS

from printprep import hollow
from printprep.cavity.carve import make_part
from printprep.errors import ToolError
from printprep.gcode.measure import measure_gcode
from printprep.gcode.stability import tilt_as_printed
from printprep.infill.trial_print import TrialSlicer, Weighed
from printprep.mesh.measure import bodies
from printprep.profiles import Profile, load_profile
from printprep.slicer.process import Slicer, find_slicer
from printprep.slicer.prusa_ini import profile_settings
from printprep.stand.stability import least_stable
from printprep.types import Solid
from printprep.verify.run import verify

COLUMNS = (
    ("model", "model", "{}"),
    ("infill g", "infill_g", "{:.2f}"),
    ("stands to °", "infill_deg", "{:.1f}"),
    ("asked °", "asked_deg", "{:.1f}"),
    ("of it ballast g", "ballast_g", "{:.2f}"),
    ("base g", "base_g", "{:.2f}"),
    ("slices", "slices", "{}"),
    ("lightning g", "lightning_g", "{:.2f}"),
    ("stands to °", "lightning_deg", "{:.1f}"),
    ("15 % gyroid g", "gyroid_g", "{:.2f}"),
    ("stands to °", "gyroid_deg", "{:.1f}"),
    ("hollow g", "hollow_g", "{:.2f}"),
    ("stands to °", "hollow_deg", "{:.1f}"),
    ("infill / lightning", "ratio", "{:.3f}"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = table_parser(__doc__, only=MODELS)
    parser.add_argument("--lean", type=float, help="degrees asked for, instead of the profile's")
    parser.add_argument("--base", default="auto", help="of the parts, as in `printprep hollow`")
    parser.add_argument("--no-infill", action="store_true", help="leave out all but hollow parts")
    parser.add_argument("--no-hollow", action="store_true", help="leave out the hollow part")
    chosen = parser.parse_args(arguments)
    parts = [] if chosen.no_infill else [infill_figures]
    parts += [] if chosen.no_hollow else [hollow_figures]
    options = {"size_mm": chosen.size, "lean": chosen.lean, "base": chosen.base}

    def one(model: Path, up: str, kept: Row) -> Row:
        row = {"model": model.stem, **kept}
        row.pop("error", None)
        for figures in parts:
            if figures.__name__ not in row:
                row |= figures(model, load_profile(chosen.profile), {"up": up, **options})
                row[figures.__name__] = True
        return row

    rows = measured_rows(
        chosen, one, markdown, done=lambda row: all(part.__name__ in row for part in parts)
    )
    return 0 if rows and all("error" not in r and r.get("stands", True) for r in rows) else 1


def infill_figures(model: Path, profile: Profile, options: dict[str, Any]) -> Row:
    """With ballast, as ``verify`` measures it in its own slice, and with uniform infill."""
    with tempfile.TemporaryDirectory() as folder:
        made = hollow(model, profile=profile, fill="infill", **options)
        made.write(Path(folder) / "infill.3mf")
        found = verify(Path(folder) / "infill.3mf")
    assert made.infill is not None
    tilt = tilt_as_printed(found.printed, made.lean)
    base_mm3 = made.part.outside.volume() - made.solid.manifold.volume()
    row: Row = {
        "slicer": found.slicer,
        "infill_g": found.printed.mass_g,
        "infill_deg": tilt,
        "asked_deg": made.lean_deg,
        "reachable_deg": made.density.reachable_deg,
        "stands": tilt >= made.lean_deg,
        "told_g": made.mass_g,
        "told_deg": made.stability.tilt_deg,
        "findings": ", ".join(item.rule for item in (*made.findings, *found.findings)) or "none",
        "estimated": made.infill.slicer is None,
        "slices": made.infill.slices,
        "ballast_g": made.infill.ballast_g,
        "base_g": base_mm3 * profile.material.density_g_cm3 / 1000,
        "solid_g": made.solid_mass_g,
        "seconds": sum(made.seconds.values()),
    }
    slicer = find_slicer()
    for pattern in ("lightning", "gyroid"):
        weighed = uniform(made.solid, slicer, profile, pattern)
        row[f"{pattern}_g"] = None if weighed is None else grams(weighed, profile)
        row[f"{pattern}_deg"] = (
            None if weighed is None else least_stable(weighed.stabilities).tilt_deg
        )
    row["ratio"] = None if row["lightning_g"] is None else row["infill_g"] / row["lightning_g"]
    return row


def hollow_figures(model: Path, profile: Profile, options: dict[str, Any]) -> Row:
    """With a cavity whose ceilings stand on vaults."""
    with tempfile.TemporaryDirectory() as folder:
        made = hollow(model, profile=profile, vaults="printer", **options)
        part, gcode = Path(folder) / "hollow.3mf", Path(folder) / "hollow.gcode"
        made.write(part)
        find_slicer().slice(part, gcode, profile_settings(profile))
        printed = measure_gcode(gcode, bodies=bodies(made.part.manifold))
    return {
        "hollow_g": printed.mass_g,
        "hollow_told_g": made.mass_g,
        "hollow_deg": tilt_as_printed(printed, made.lean),
        "vaults_g": None
        if made.supports is None
        else made.supports.added_mm3 * profile.material.density_g_cm3 / 1000,
    }


def uniform(solid: Solid, slicer: Slicer, profile: Profile, pattern: str) -> Weighed | None:
    """The model with 15 % of one infill throughout; None where it cannot be sliced.

    (A model that touches the bed in a point has no first layer.)
    """
    assert profile.infill is not None
    infill = profile.infill.model_copy(update={"pattern": pattern, "density": 0.15})
    trial_slicer = TrialSlicer(slicer, profile.model_copy(update={"infill": infill}))
    try:
        return trial_slicer.weigh(make_part(solid, None, ()), (), bodies(solid.manifold))
    except ToolError:
        return None


def grams(weighed: Weighed, profile: Profile) -> float:
    return float(weighed.moments[:, 0].sum()) * profile.material.density_g_cm3 / 1000


def markdown(rows: Sequence[Row]) -> str:
    """The rows as a table, with their summary."""
    lines = markdown_lines(COLUMNS, rows)
    return "\n".join([*lines, "", *summary(rows)]) + "\n"


def summary(rows: Sequence[Row]) -> list[str]:
    """Means over the models whose lean is feasible, and how many fall short otherwise."""
    rows = [row for row in rows if "infill_g" in row]
    reached = [row for row in rows if row["reachable_deg"] is None]
    both = [row for row in reached if row["lightning_g"] is not None]
    lines = [
        f"- With ballast {sum(r['infill_deg'] >= r['asked_deg'] for r in rows)} of {len(rows)} "
        "stand at the lean asked for."
    ]
    for way in ("lightning", "gyroid", "hollow"):
        tried = [row for row in rows if f"{way}_g" in row]
        short = [r for r in tried if r[f"{way}_g"] is None or r[f"{way}_deg"] < r["asked_deg"]]
        there = [r for r in tried if r in reached and r[f"{way}_g"] is not None]
        if there:
            mean = np.mean([r["infill_g"] / r[f"{way}_g"] for r in there])
            lines.append(
                f"- {way}: {len(short)} of {len(tried)} fall short; with ballast "
                f"{mean:.3f} × its grams on average over the {len(there)} that can stand."
            )
    if both:
        lines.append(f"- Largest ratio to lightning: {max(r['ratio'] for r in both):.3f}.")
    return lines


if __name__ == "__main__":
    raise SystemExit(main())
