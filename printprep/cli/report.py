"""``printprep report``: a page about a part that printprep wrote."""

from __future__ import annotations

from pathlib import Path

import click

from printprep.cli.options import path_option, quiet_option, slicer_option, traceback_option

_EPILOG = """\b
Examples:
  printprep report out.3mf
  printprep report out.3mf -o out.html --verify --compare model.stl
"""


@click.command("report", short_help="Write a page about a part.", epilog=_EPILOG)
@click.argument("part", type=click.Path(path_type=Path), metavar="PART.3mf")
@path_option(
    "-o",
    "--output",
    metavar="OUT.html",
    help="File to write. An existing file is replaced. Default: PART.html in the current folder.",
)
@click.option(
    "--verify",
    "verify_it",
    is_flag=True,
    help="Also slice the part, and show the print beside the computed figures.",
)
@path_option(
    "--compare",
    "compare_with",
    metavar="MODEL",
    help="With --verify: the model that the part was made from; its hours with usual infills are "
    "shown too.",
)
@slicer_option("PrusaSlicer for --verify. Default: PRINTPREP_SLICER, or the one installed.")
@quiet_option
@traceback_option
def command(
    part: Path,
    output: Path | None,
    verify_it: bool,
    compare_with: Path | None,
    slicer: Path | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Write a page about PART.3mf, made by `printprep hollow`.

    The page is one file that needs no network. It shows the part in three dimensions, opened along
    any plane: cavities, vaults, drain holes, base and ballast; how it stands on a bed that leans;
    the thickness of its walls; and all its figures and findings.
    """
    from printprep.cli.shown_command import shown_command
    from printprep.errors import UsageError
    from printprep.output.limits import check_page
    from printprep.page.build import page_of_part, source_of
    from printprep.page.document import write_page
    from printprep.progress import for_terminal
    from printprep.verify.run import verify

    del verbose  # read where errors are reported
    for given, name in ((compare_with, "--compare"), (slicer, "--slicer")):
        if given is not None and not verify_it:
            raise UsageError(f"{name} has no effect without --verify.", "Add --verify.")
    target = Path(f"{part.stem}.html") if output is None else output
    check_page(target, "output")
    progress = for_terminal(quiet=quiet)
    verified = None
    if verify_it:
        verified = verify(part, slicer=slicer, compare_with=compare_with, progress=progress)
    with progress.stage("page"):
        page = page_of_part(part, source_of(part, shown_command()), verified)
        write_page(page, target)
    if not quiet:
        click.echo(f"Written: {target}")
    return 0
