"""``printprep verify``: compare what the slicer prints with what was computed."""

from __future__ import annotations

from pathlib import Path

import click

from printprep.cli.options import (
    exit_code,
    fail_on_option,
    json_option,
    path_option,
    quiet_option,
    slicer_option,
    traceback_option,
)

_EPILOG = """\b
Examples:
  printprep verify out.3mf
  printprep verify out.3mf --load my-printer.ini --json
  printprep verify out.3mf --compare model.stl --fail-on warning
"""


@click.command("verify", short_help="Slice a part and measure its G-code.", epilog=_EPILOG)
@click.argument("part", type=click.Path(path_type=Path), metavar="PART.3mf")
@slicer_option("PrusaSlicer to use. Default: PRINTPREP_SLICER, or the one installed.")
@path_option(
    "--load",
    metavar="CONFIG.ini",
    help="Slice with these settings (an .ini, or a G-code file that carries them) instead of the "
    "profile's.",
)
@path_option(
    "--compare",
    "compare_with",
    metavar="MODEL",
    help="The model that the part was made from. It is sliced too, with 15 % gyroid infill and "
    "with lightning infill, and with walls of the same thickness.",
)
@fail_on_option("error")
@json_option
@quiet_option
@traceback_option
def command(
    part: Path,
    slicer: Path | None,
    load: Path | None,
    compare_with: Path | None,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Slice PART.3mf, made by `printprep hollow`, and measure the G-code.

    It compares mass, centre of mass, contact and tilt angle of the print with the figures in the
    file. It also tells whether anything is printed inside cavities, and whether supports go there
    when they are switched on. No file is written.
    """
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.progress import for_terminal
    from printprep.report.verification import show_verified, verify_json
    from printprep.verify.run import verify

    del verbose  # read where errors are reported
    found = verify(
        part,
        slicer=slicer,
        load=load,
        compare_with=compare_with,
        progress=for_terminal(quiet=quiet),
    )
    if as_json:
        print_json(verify_json(found, part=str(part)))
    elif quiet:
        trouble_to_stderr(found.findings)
    else:
        show_verified(stdout_console(), found)
    return exit_code(found.findings, fail_on)
