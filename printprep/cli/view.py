"""``printprep view``: look at a model before hollowing it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import click

from printprep.cli.options import (
    model_argument,
    overrides,
    path_option,
    placement_of,
    placement_options,
    profile_options,
    quiet_option,
    traceback_option,
)

_EPILOG = """\b
Examples:
  printprep view model.stl
  printprep view scan.obj --up y --size 120 -o scan.html --no-browser
  printprep view figure.stl --serve
"""


@click.command("view", short_help="Look at a model, and try settings.", epilog=_EPILOG)
@model_argument
@profile_options
@placement_options
@path_option(
    "-o",
    "--output",
    metavar="OUT.html",
    help="File for the page. Default: a temporary file, which is opened in the browser.",
)
@click.option(
    "--serve",
    is_flag=True,
    help="Run a server for this machine alone, where wall, lean, fill, drain holes and pose can be "
    "changed: the model runs again, and the page follows. Ctrl-C ends it.",
)
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="PORT",
    help="Port for --serve. Default: one that is free.",
)
@click.option("--no-browser", is_flag=True, help="Do not open the page in the browser.")
@quiet_option
@traceback_option
def command(
    model: Path,
    profile: str,
    settings: tuple[str, ...],
    wall_mm: float | None,
    lean: str | None,
    output: Path | None,
    serve: bool,
    port: int | None,
    no_browser: bool,
    quiet: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Show MODEL in the browser: its findings, the thickness of its walls, and how it stands.

    The page also shows the poses in which the model could stand, and what each degree of lean would
    cost. It is one file that needs no network.
    """
    from printprep.cli.shown_command import shown_command
    from printprep.errors import UsageError
    from printprep.output.limits import check_page
    from printprep.page.build import page_of_checked, source_of
    from printprep.page.document import write_page
    from printprep.pipeline.look import look
    from printprep.progress import for_terminal

    del verbose  # read where errors are reported
    if serve and output is not None:
        raise UsageError("--serve writes no page.", "Leave out --output, or leave out --serve.")
    if port is not None and not serve:
        raise UsageError("--port has no effect without --serve.", "Add --serve.")
    if no_browser and output is None and not serve:
        raise UsageError(
            "--no-browser would leave a page that no one sees.", "Name a file with --output."
        )
    if output is not None:
        check_page(output, "output")
    changed, placed = overrides(settings, wall_mm), placement_of(placement)
    progress = for_terminal(quiet=quiet)
    found = look(
        model, profile=profile, overrides=changed, placement=placed, lean=lean, progress=progress
    )
    if serve:
        from printprep.serve.server import serve_model
        from printprep.serve.trial import Trials

        trials = Trials(model, profile, changed, placed, lean, found)
        serve_model(trials, port=port or 0, browser=not no_browser, tell=click.echo)
        return 0
    with progress.stage("page"):
        page = page_of_checked(
            found.checked,
            source_of(model, shown_command()),
            name=found.name,
            poses=found.poses,
            points=found.points,
        )
        target = _temporary(found.name) if output is None else output
        write_page(page, target)
    if not quiet:
        click.echo(f"Written: {target}")
    if not no_browser:
        import webbrowser

        webbrowser.open(target.resolve().as_uri())
    return 0


def _temporary(name: str) -> Path:
    """A file that outlives the command: the browser reads it later."""
    safe = "".join(letter if letter.isalnum() else "-" for letter in name)[:60] or "model"
    return Path(tempfile.mkdtemp(prefix="printprep-view-")) / f"{safe}.html"
