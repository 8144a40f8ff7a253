"""``printprep simulate``: a part in the hands of a physics engine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import (
    check_picture,
    exit_code,
    model_argument,
    output_form_options,
    overrides,
    placement_of,
    placement_options,
    profile_options,
)

if TYPE_CHECKING:
    from printprep.pipeline.simulate import Simulated
    from printprep.progress import Progress

_EPILOG = """\b
Examples:
  printprep simulate out.3mf
  printprep simulate out.3mf --lean 15 --gif fall.gif
  printprep simulate scan.obj --up y --size 120 --strip fall.png --json
"""


@click.command("simulate", short_help="Let a part go, and tilt the bed.", epilog=_EPILOG)
@model_argument
@profile_options
@placement_options
@click.option(
    "--gif",
    type=click.Path(path_type=Path),
    metavar="OUT.gif",
    help="Draw the bed tilting toward the weakest edge until the part tips, as a moving picture.",
)
@click.option(
    "--strip",
    type=click.Path(path_type=Path),
    metavar="OUT.png",
    help="The same as six stills side by side.",
)
@output_form_options("error")
def command(
    model: Path,
    profile: str,
    settings: tuple[str, ...],
    wall_mm: float | None,
    gif: Path | None,
    strip: Path | None,
    lean: str | None,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Simulate how MODEL (STL, OBJ, PLY, 3MF or GLB) stands; the model is not changed.

    It is let go on a level bed for ten seconds; then the bed tilts slowly toward eight azimuths,
    the weakest edge's and the one that --lean names, until its foot leaves the bed and it goes
    over. The angles are set beside the computed ones, and against --lean.
    """
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.pipeline.simulate import simulate
    from printprep.progress import for_terminal
    from printprep.report.json import simulate_json
    from printprep.report.terminal import show_simulation

    for picture, option in ((gif, "gif"), (strip, "strip")):
        check_picture(picture, option, _SUFFIXES[option])
    progress = for_terminal(quiet=quiet)
    found = simulate(
        model,
        profile=profile,
        overrides=overrides(settings, wall_mm),
        placement=placement_of(placement),
        lean=lean,
        progress=progress,
    )
    _draw(found, gif, strip, progress)
    if as_json:
        print_json(simulate_json(found, model=str(model)))
    elif quiet:
        trouble_to_stderr(found.findings)
    else:
        show_simulation(stdout_console(), found, verbose=verbose)
    return exit_code(found.findings, fail_on)


_SUFFIXES = {"gif": (".gif",), "strip": (".png",)}


def _draw(found: Simulated, gif: Path | None, strip: Path | None, progress: Progress) -> None:
    if gif is None and strip is None:
        return
    from printprep.files import write_atomically
    from printprep.render import animation
    from printprep.stand.fall import film

    part, first_layer = found.solid.manifold, found.profile.printer.first_layer_mm
    with progress.stage("draw"):
        if gif is not None:
            moving = film(part, first_layer, animation.GIF_FRAMES_PER_S)
            write_atomically(gif, animation.gif_bytes(moving))
        if strip is not None:
            stills = film(part, first_layer, animation.STRIP_FRAMES_PER_S)
            write_atomically(strip, animation.strip_bytes(stills))
