"""``printprep simulate``: simulate how a part stands in a physics engine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from printprep.cli.options import (
    check_picture,
    exit_code,
    lean_option,
    model_argument,
    output_form_options,
    overrides,
    path_option,
    placement_of,
    placement_options,
    profile_option,
    set_option,
)

_SUFFIXES = {"gif": (".gif",), "strip": (".png",)}

_EPILOG = """\b
Examples:
  printprep simulate out.3mf
  printprep simulate out.3mf --lean 15 --gif fall.gif
  printprep simulate scan.obj --up y --size 120 --strip fall.png --json
"""


@click.command("simulate", short_help="Simulate how a part stands and tips.", epilog=_EPILOG)
@model_argument
@profile_option
@set_option
@lean_option
@placement_options
@path_option(
    "--gif",
    metavar="OUT.gif",
    help="Draw an animation: the bed tilts toward the weakest edge until the part tips.",
)
@path_option(
    "--strip",
    metavar="OUT.png",
    help="Draw the same as six pictures side by side.",
)
@output_form_options("error")
def command(
    model: Path,
    profile: str,
    settings: tuple[str, ...],
    gif: Path | None,
    strip: Path | None,
    lean: str | None,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Simulate how MODEL (STL, OBJ, PLY, 3MF, GLB; or voxels: NPZ, NPY, PT) stands and tips.

    The part first stands freely on a level bed for ten seconds. Then the bed tilts slowly until
    the foot leaves it and the part falls over: toward eight azimuths, toward the weakest edge, and
    toward the azimuth of --lean. The angles are compared with the computed ones and with --lean.
    The model is not changed.
    """
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.pipeline.simulate import draw_fall, simulate
    from printprep.progress import for_terminal
    from printprep.report.json import simulate_json
    from printprep.report.terminal import show_simulation

    for picture, option in ((gif, "gif"), (strip, "strip")):
        check_picture(picture, option, _SUFFIXES[option])
    progress = for_terminal(quiet=quiet)
    found = simulate(
        model,
        profile=profile,
        overrides=overrides(settings),
        placement=placement_of(placement),
        lean=lean,
        progress=progress,
    )
    draw_fall(found, gif=gif, strip=strip, progress=progress)
    if as_json:
        print_json(simulate_json(found, model=str(model)))
    elif quiet:
        trouble_to_stderr(found.findings)
    else:
        show_simulation(stdout_console(), found, verbose=verbose)
    return exit_code(found.findings, fail_on)
