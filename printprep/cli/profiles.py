"""``printprep profiles``: list the profiles, show one, or export one for a slicer."""

from __future__ import annotations

from pathlib import Path

import click

from printprep.cli.options import json_option, overrides, path_option, set_option
from printprep.errors import UsageError


@click.group("profiles", short_help="List, show or export profiles.", invoke_without_command=True)
@json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """List the profiles (the same as `profiles list`), show one, or export one.

    A profile holds a printer, a material and their limits. Instead of a profile's name you can
    give the path of a TOML file.
    """
    if ctx.invoked_subcommand is None:
        _list(as_json)
    elif as_json:
        name = ctx.invoked_subcommand
        raise UsageError(f"--json must come after {name}: printprep profiles {name} --json.")


@command.command("list")
@json_option
def list_command(as_json: bool) -> None:
    """List the profiles that come with printprep, the default first."""
    _list(as_json)


@command.command("show")
@click.argument("name")
@json_option
def show_command(name: str, as_json: bool) -> None:
    """Show profile NAME as TOML, with the source of every figure.

    The --set of other commands takes these keys, as TABLE.KEY for a key in a table.
    """
    from printprep.cli.console import print_json
    from printprep.profiles import load_profile, profile_source

    profile = load_profile(name)
    if as_json:
        print_json(profile.model_dump(mode="json"))
    else:
        click.echo(profile_source(name), nl=False)


@command.command("export", short_help="Export a profile for PrusaSlicer.")
@click.argument("name")
@path_option(
    "-o",
    "--output",
    metavar="FILE",
    help="The .ini file to write; an existing file is replaced. Default: stdout.",
)
@set_option
def export_command(name: str, output: Path | None, settings: tuple[str, ...]) -> None:
    """Export profile NAME as an .ini for PrusaSlicer (File > Import > Import Config).

    It holds the settings that a 3MF cannot carry: first layer, nozzle, line widths, filament.
    """
    from printprep.profiles import load_profile
    from printprep.slicer.prusa_ini import profile_ini

    text = profile_ini(load_profile(name, overrides(settings)))
    if output is None:
        click.echo(text, nl=False)
        return
    from printprep.files import write_atomically

    source = Path(name)
    if output.exists() and source.exists() and output.samefile(source):
        raise UsageError(
            f"{output} is the profile, which would be replaced.", "Name another file with --output."
        )
    write_atomically(output, text.encode())
    click.echo(f"Written: {output}")


def _list(as_json: bool) -> None:
    from printprep.cli.console import print_json, stdout_console
    from printprep.profiles import load_profile, profile_names

    profiles = [load_profile(name) for name in profile_names()]
    if as_json:
        print_json({"profiles": [item.model_dump(mode="json") for item in profiles]})
        return
    from printprep.report.terminal import show_profiles

    show_profiles(stdout_console(), profiles)
