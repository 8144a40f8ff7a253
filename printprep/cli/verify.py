"""``printprep verify``: what the slicer prints, against what was computed."""

from __future__ import annotations

from pathlib import Path

import click

from printprep.cli.options import exit_code, fail_on_option, json_option

_EPILOG = """\b
Examples:
  printprep verify out.3mf
  printprep verify out.3mf --load my-printer.ini --json
  printprep verify out.3mf --compare model.stl --fail-on warning
"""


@click.command("verify", short_help="Slice a part and measure its G-code.", epilog=_EPILOG)
@click.argument("part", type=click.Path(path_type=Path), metavar="PART.3mf")
@click.option(
    "--slicer",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="The PrusaSlicer to use. Default: PRINTPREP_SLICER, else the one on this machine.",
)
@click.option(
    "--load",
    type=click.Path(path_type=Path),
    metavar="CONFIG.ini",
    help="Slice with these settings (an .ini, or a G-code that carries them), not the profile's.",
)
@click.option(
    "--compare",
    "compare_with",
    type=click.Path(path_type=Path),
    metavar="MODEL",
    help="The model the part was made of: slice it too, with 15 % gyroid and with lightning "
    "infill, at walls as thick.",
)
@fail_on_option("error")
@json_option
@click.option("-q", "--quiet", is_flag=True, help="Only warnings and errors, on stderr.")
@click.option("-v", "--verbose", is_flag=True, help="The traceback of a defect.")
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

    Mass, centre of mass, contact and tilt angle as printed, against the figures the file carries;
    whether anything is printed inside cavities, and, with supports switched on, whether they go
    there. Nothing is written.
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
