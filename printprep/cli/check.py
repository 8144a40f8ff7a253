"""``printprep check``: run the rules on any file, whichever program made it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from printprep.cli.options import (
    exit_code,
    max_memory_option,
    model_argument,
    output_form_options,
    overrides,
    placement_of,
    placement_options,
    profile_options,
)

_EPILOG = """\b
Examples:
  printprep check out.3mf
  printprep check part.stl -p sls-pa12 --fail-on warning
  printprep check scan.obj --up y --size 120 --json
"""


@click.command("check", short_help="Check a file against a profile.", epilog=_EPILOG)
@model_argument
@profile_options
@placement_options
@max_memory_option
@output_form_options("error")
def command(
    model: Path,
    profile: str,
    settings: tuple[str, ...],
    wall_mm: float | None,
    lean: str | None,
    max_memory_mib: float | None,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Check MODEL (STL, OBJ, PLY, 3MF, GLB; or voxels: NPZ, NPY, PT) against a profile.

    It checks the triangles of the file, walls, pins and gaps, ceilings and overhangs, sealed
    cavities, pools and suction cups, the tilt angle against --lean, contact with the bed, and
    whether the part fits into the printer. No file is written.
    """
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.pipeline.check import check
    from printprep.progress import for_terminal
    from printprep.report.json import check_json
    from printprep.report.terminal import show_check

    found = check(
        model,
        profile=profile,
        overrides=overrides(settings, wall_mm),
        placement=placement_of(placement),
        lean=lean,
        max_memory_mib=max_memory_mib,
        progress=for_terminal(quiet=quiet),
    )
    if as_json:
        print_json(check_json(found, model=str(model)))
    elif quiet:
        trouble_to_stderr(found.findings)
    else:
        show_check(stdout_console(), found, verbose=verbose)
    return exit_code(found.findings, fail_on)
