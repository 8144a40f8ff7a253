"""Vault a catalogue's models for the printer, and let slicers and a full overhang rule judge them.

    python benchmarks/vaults_table.py ../shared/models/catalogue.csv -o table.md \
        --slicer prusa-slicer --slicer /path/to/another/prusa-slicer

The vaults are those of the whole hollowable volume, before any of it is filled for stability; the
added share is a share of that volume.  Flagged area and islands follow the printer's rule word by
word on the written part, at layer phases that the building does not all use.

The last slicer prints the part three ways in the same settings: as it is, and the model with walls
as thick and 15 % gyroid or lightning.  Every slicer slices the part with supports on, in every
style that it has, at the automatic threshold and at 45° in turn: support inside the cavities, and
support outside beside that of the same part without cavities and without a support blocker.  The
file of --json keeps the rows, and later runs go on there.
"""

from __future__ import annotations

import resource
import sys
import tempfile
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from manifold3d import Manifold

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from rows import Row, markdown_lines, measured_rows, table_parser
from support_inside import supports_g

from printprep.check.walls import united
from printprep.errors import ToolError
from printprep.gcode.measure import measure_gcode
from printprep.mesh.measure import shells
from printprep.mesh.write import to_bytes
from printprep.output.prusa_keys import wall_keys, without_columns
from printprep.overhang.limits import printer_acceptance
from printprep.overhang.rule import unsupported_overhangs
from printprep.pipeline.hollow import hollow_with
from printprep.pipeline.hollowable import hollowable
from printprep.pipeline.options import FillOptions, Placement
from printprep.pipeline.prepare import prepare
from printprep.profiles import Profile, load_profile
from printprep.progress import SILENT
from printprep.result import HollowResult
from printprep.slicer.process import Slicer, find_slicer
from printprep.slicer.prusa_ini import profile_settings

JUDGED_PHASES = (0.0, 0.2, 0.7)
AROUND_MM = 3.0
INFILLS = ("gyroid", "lightning")
STYLES = ("grid", "snug", "organic")
THRESHOLDS_DEG = (0, 45)
# What is compared with which infill.
COMPARED = (("g", "lightning"), ("h", "gyroid"), ("h", "lightning"), ("cpu", "gyroid"))
# Outside supports lighter than this are compared with it: a few lines more or less.
LEAST_G = 0.5


def main() -> int:
    parser = table_parser(__doc__)
    parser.add_argument("--slicer", type=Path, action="append", help="a PrusaSlicer; repeatable")
    parser.add_argument(
        "--every-style", action="store_true", help="every style at every threshold, not in turn"
    )
    parser.add_argument("--no-supports", action="store_true", help="slice without supports only")
    chosen = parser.parse_args()
    profile = load_profile(chosen.profile)
    slicers = [find_slicer(path) for path in chosen.slicer or (None,)]

    def one(path: Path, up: str, kept: Row) -> Row:
        return measured(path, up, chosen, profile, slicers, kept)

    def done(row: Row) -> bool:
        wanted = [f"{slicers[-1].name}:done_prints"]
        if not chosen.no_supports:
            wanted += [f"{slicer.name}:done_supports" for slicer in slicers]
        return "error" not in row and all(key in row for key in wanted)

    def markdown(rows: list[Row]) -> str:
        return table(rows, [slicer.name for slicer in slicers])

    rows = measured_rows(chosen, one, markdown, done=done)
    return 0 if all("error" not in row for row in rows) else 1


def measured(
    path: Path, up: str, chosen: Namespace, profile: Profile, slicers: list[Slicer], kept: Row
) -> Row:
    """One row of the table; what the row kept holds already is not measured again."""
    placement = Placement(up=up, size_mm=chosen.size)
    result = hollow_with(path, profile, placement, FillOptions())
    row: Row = {"model": path.stem, **{k: v for k, v in kept.items() if k != "error"}}
    if "share" not in row:
        row |= vault_figures(path, profile, placement, result)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for slicer in slicers:
            if slicer is slicers[-1] and f"{slicer.name}:done_prints" not in row:
                row |= prefixed(slicer, prints(slicer, result, path, placement, folder))
            if not chosen.no_supports and f"{slicer.name}:done_supports" not in row:
                row |= prefixed(slicer, supports(slicer, result, every=chosen.every_style))
    return row


def prefixed(slicer: Slicer, row: Row) -> Row:
    return {f"{slicer.name}:{key}": value for key, value in row.items()}


def vault_figures(path: Path, profile: Profile, placement: Placement, result: HollowResult) -> Row:
    """The vaults in the whole hollowable volume, and the written part by the printer's rule."""
    prepared = prepare(path, profile, placement, SILENT)
    volume = hollowable(prepared, FillOptions(vaults="none"), SILENT).manifold.volume()
    row: Row = {
        "hollowable_cm3": volume / 1000,
        "asked_deg": result.lean_deg,
        "tilt_deg": result.tilt_deg,
        "reachable": result.density.reachable_deg is None,
        "ballast": any(plane is not None for plane in result.density.planes or ()),
        "blocker_triangles": None if result.blocker is None else result.blocker.num_tri(),
        "seconds": sum(result.seconds.values()),
        "share": None,
    }
    vaults = result.supports
    if vaults is None:
        return row
    row |= {
        "capitals": vaults.capitals,
        "columns": vaults.columns,
        "share": vaults.added_mm3 / volume,
    }
    rule = printer_acceptance(profile)
    blocks = [_around(void) - void for void in shells(result.part.manifold)[1]]
    found = [
        [unsupported_overhangs(block, rule, phase) for block in blocks] for phase in JUDGED_PHASES
    ]
    row["flagged_mm2"] = max(sum(item.area_mm2 for item in phase) for phase in found)
    row["islands"] = max(sum(item.islands for item in phase) for phase in found)
    return row


def prints(
    slicer: Slicer, result: HollowResult, path: Path, placement: Placement, folder: Path
) -> Row:
    """Grams, hours and the slicer's processor seconds: the part, and the model with infill.

    For a part with ballast also the grams of the print with infill that stands at the same lean.
    A model that touches the bed in a point has no first layer, so no slicer prints it as it is.
    """
    profile = result.profile
    part, model = folder / "part.3mf", folder / "model.stl"
    result.write(part)
    x, y, _ = profile.printer.bed_mm
    model.write_bytes(to_bytes(result.solid.manifold.translate((x / 2, y / 2, 0)), ".stl"))
    settings = profile_settings(profile)
    row = {f"part_{key}": value for key, value in sliced(slicer, part, settings, folder).items()}
    for pattern in INFILLS:
        infill = {
            **without_columns(settings),
            **wall_keys(profile),
            "fill_density": "15%",
            "fill_pattern": pattern,
        }
        try:
            found = sliced(slicer, model, infill, folder)
        except ToolError:
            found = {}
        row |= {f"{pattern}_{key}": value for key, value in found.items()}
    if any(plane is not None for plane in result.density.planes or ()):
        options = FillOptions(fill="infill", slicer=slicer.executable)
        row["infill_g"] = hollow_with(path, profile, placement, options).mass_g
    return {**row, "done_prints": True}


def sliced(slicer: Slicer, file: Path, settings: Mapping[str, str], folder: Path) -> Row:
    """Grams, hours, and processor seconds of one slice."""
    gcode, before = folder / "print.gcode", _children_cpu_seconds()
    slicer.slice(file, gcode, settings)
    seconds = _children_cpu_seconds() - before
    printed = measure_gcode(gcode)
    assert printed.slicer_summary.seconds is not None
    return {
        "g": printed.mass_g,
        "h": printed.slicer_summary.seconds / 3600,
        "cpu": seconds,
    }


def supports(slicer: Slicer, result: HollowResult, *, every: bool) -> Row:
    """Grams of support inside and outside, in every style, the thresholds in turn.

    every : in every style at every threshold.  What is supported depends on the threshold, and how,
    on the style; only the organic style decides on both.  Each combination has three figures:
    inside, outside, and outside the same part without cavities and without a blocker.
    """
    row: Row = {"inside_g": 0.0, "outside_off": 0.0, "done_supports": True}
    if not result.part.cavities:
        return row
    part, cavities = result.part.manifold, united(result.part.cavities)
    for style, threshold_deg in _combinations(slicer, every=every):
        how = (cavities, result.profile, threshold_deg)
        inside, outside = supports_g(slicer, part, *how, style=style, blocker=result.blocker)
        within, bare = supports_g(slicer, result.part.outside, *how, style=style)
        assert within == 0.0  # there is no cavity
        row[f"{style}_{threshold_deg}"] = [inside, outside, bare]
        row["inside_g"] = max(row["inside_g"], inside)
        row["outside_off"] = max(row["outside_off"], abs(outside - bare) / max(bare, LEAST_G))
    return row


def _combinations(slicer: Slicer, *, every: bool) -> Iterator[tuple[str, int]]:
    for number, style in enumerate(STYLES):
        if style != "organic" or slicer.version >= (2, 6, 0):
            turn = THRESHOLDS_DEG[number % 2]
            yield from ((style, angle) for angle in THRESHOLDS_DEG if every or angle == turn)


def _children_cpu_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _around(void: Manifold) -> Manifold:
    """A block on the bed, with enough material around a void."""
    low, high = np.reshape(void.bounding_box(), (2, 3))
    low, high = low - AROUND_MM, high + AROUND_MM
    low[2] = 0.0
    return Manifold.cube((high - low).tolist()).translate(low.tolist())


def columns_for(name: str) -> tuple[tuple[str, str, str], ...]:
    """The columns of one slicer."""
    return (
        ("g", f"{name}:part_g", "{:.1f}"),
        ("gyroid g", f"{name}:gyroid_g", "{:.1f}"),
        ("lightning g", f"{name}:lightning_g", "{:.1f}"),
        ("infill with ballast g", f"{name}:infill_g", "{:.1f}"),
        ("h", f"{name}:part_h", "{:.2f}"),
        ("gyroid h", f"{name}:gyroid_h", "{:.2f}"),
        ("lightning h", f"{name}:lightning_h", "{:.2f}"),
        ("slicing s", f"{name}:part_cpu", "{:.0f}"),
        ("of gyroid s", f"{name}:gyroid_cpu", "{:.0f}"),
        ("support inside g", f"{name}:inside_g", "{:.3f}"),
        ("outside off", f"{name}:outside_off", "{:.2%}"),
    )


COLUMNS = (
    ("model", "model", "{}"),
    ("capitals", "capitals", "{}"),
    ("columns", "columns", "{}"),
    ("added share", "share", "{:.3f}"),
    ("flagged mm²", "flagged_mm2", "{:.3f}"),
    ("islands", "islands", "{}"),
    ("blocker triangles", "blocker_triangles", "{}"),
)


def table(rows: Sequence[Row], names: Sequence[str]) -> str:
    """A table of the vaults, one for each slicer, and what they come to."""
    lines = markdown_lines(COLUMNS, rows)
    for name in names:
        lines += ["", f"**{name}**", ""]
        lines += markdown_lines((COLUMNS[0], *columns_for(name)), rows)
    return "\n".join([*lines, "", *summary(rows, names)]) + "\n"


def summary(rows: Sequence[Row], names: Sequence[str]) -> list[str]:
    """Means over the models, apart for those whose parts need ballast."""
    shares = [row["share"] for row in rows if row.get("share") is not None]
    lines = (
        [f"- Added share: mean {np.mean(shares):.4f} over {len(shares)} models."] if shares else []
    )
    for name in names:
        printed = [row for row in rows if f"{name}:part_g" in row]
        plain = [row for row in printed if not row["ballast"] and f"{name}:lightning_g" in row]
        if plain:
            grams, hours, quick, cpu = (
                [row[f"{name}:part_{key}"] / row[f"{name}:{other}_{key}"] for row in plain]
                for key, other in (
                    ("g", "lightning"),
                    ("h", "gyroid"),
                    ("h", "lightning"),
                    ("cpu", "gyroid"),
                )
            )
            lines.append(
                f"- {name}, {len(plain)} models without ballast: {np.mean(grams):.3f} × the grams "
                f"of lightning and {np.mean(hours):.3f} × the hours of gyroid on the mean; "
                f"lightning's hours are met by {sum(r <= 1 for r in quick)}; slicing takes "
                f"{np.median(cpu):.1f} × as long as gyroid at the median."
            )
        heavy = [row for row in printed if row["ballast"]]
        if heavy:
            ratio = [row[f"{name}:part_g"] / row[f"{name}:infill_g"] for row in heavy]
            lines.append(
                f"- {name}, {len(heavy)} models with ballast: {np.mean(ratio):.3f} × the grams of "
                "infill with ballast that stands at the same lean, on the mean."
            )
        supported = [row for row in rows if f"{name}:inside_g" in row]
        if supported:
            worst = max(row[f"{name}:inside_g"] for row in supported)
            off = max(row[f"{name}:outside_off"] for row in supported)
            lines.append(
                f"- {name}: at most {worst:.3f} g of support inside, and outside {off:.2%} more or "
                f"less than without the blocker, over {len(supported)} models."
            )
    return lines


if __name__ == "__main__":
    raise SystemExit(main())
