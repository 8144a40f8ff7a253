"""What a run would do, for a person and as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table

from printprep.errors import PrintprepError
from printprep.output.numbers import number
from printprep.pipeline.dry_run import DryRun
from printprep.wording import counted, printable

if TYPE_CHECKING:
    from printprep.batches.item import Item

NOTHING_WRITTEN = "Nothing was written (--dry-run)."


def show_dry_run(console: Console, planned: DryRun) -> None:
    """Print what ``hollow`` would do."""
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    for label, text in _facts(planned):
        table.add_row(label, printable(text))
    console.print(table)
    console.print(f"\n{NOTHING_WRITTEN}")


def dry_run_json(planned: DryRun) -> dict[str, Any]:
    """What a run would do, as data."""
    job, options = planned.job, planned.job.options
    return {
        "dry_run": True,
        "model": str(job.model),
        "size_mm": [number(side) for side in planned.size_mm],
        "triangles": planned.triangles,
        "profile": planned.profile.name,
        "settings": planned.profile.model_dump(mode="json", exclude={"name"}),
        "fill": options.fill,
        "lean_deg": number(planned.lean.angle_deg),
        "lean_azimuth_deg": number(planned.lean.azimuth_deg),
        "vaults": planned.vaults,
        "base": options.base,
        "simulate": job.simulate,
        "verify": job.verify,
        "output": str(job.output),
        "plugs": None if job.plugs is None else str(job.plugs),
        "report": None if job.report is None else str(job.report),
        "written_for": job.written_for,
    }


def follow_dry_run(
    ended: Iterator[tuple[Item, DryRun | PrintprepError]], *, as_json: bool, quiet: bool
) -> int:
    """Print a line for each model of a batch; return how many cannot be hollowed."""
    total = refused = 0
    for item, found in ended:
        total += 1
        known = isinstance(found, DryRun)
        refused += not known
        if as_json:
            _print(json.dumps(_row_json(item, found), allow_nan=False))
        elif not (quiet and known):
            _print(printable(f"{item.name}: {_line(found)}"))
    if not (as_json or quiet):
        _print(f"\n{counted(total, 'model')}, {refused} refused. {NOTHING_WRITTEN}")
    return refused


def _facts(planned: DryRun) -> Iterator[tuple[str, str]]:
    job, profile, options = planned.job, planned.profile, planned.job.options
    yield "model", f"{job.model}, {counted(planned.triangles, 'triangle')}"
    yield "size", f"{_size(planned)} after placement"
    yield "profile", f"{profile.name}: {profile.process}, {profile.material.name}"
    yield "wall", f"{profile.wall_mm:g} mm, layers of {profile.printer.layer_height_mm:g} mm"
    yield "fill", options.fill
    yield "should stand", f"at {planned.lean}"
    if planned.vaults is not None:
        yield "vaults", planned.vaults
    drain = profile.drain
    if drain.count and drain.diameter_mm is not None:
        yield "drain holes", f"{drain.count} or more a cavity, {drain.diameter_mm:g} mm wide"
    yield "base", options.base
    then = [word for word, asked in (("simulate", job.simulate), ("verify", job.verify)) if asked]
    if then:
        yield "then", ", ".join(then)
    for label, path in (("output", job.output), ("plugs", job.plugs), ("page", job.report)):
        if path is not None:
            yield label, f"{path}{', replacing the file there' if path.exists() else ''}"


def _size(planned: DryRun) -> str:
    return f"{' × '.join(f'{side:.4g}' for side in planned.size_mm)} mm"


def _line(found: DryRun | PrintprepError) -> str:
    if isinstance(found, PrintprepError):
        return f"{found.code}: {found.message}"
    vaults = "" if found.vaults is None else f", vaults {found.vaults}"
    return (
        f"{_size(found)}, {found.profile.name}, {found.job.options.fill}{vaults} → "
        f"{found.job.output}"
    )


def _row_json(item: Item, found: DryRun | PrintprepError) -> dict[str, Any]:
    if isinstance(found, DryRun):
        return {"name": item.name, "status": "ready", **dry_run_json(found)}
    error = {"code": found.code, "message": found.message, "hint": found.hint}
    return {"name": item.name, "status": found.code, "dry_run": True, "error": error}


def _print(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
