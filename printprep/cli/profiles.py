"""``printprep profiles``: list the profiles, show, export, or make one."""

from __future__ import annotations

from pathlib import Path

import click

from printprep.cli.group import LazyGroup
from printprep.cli.options import (
    DEFAULT_PROFILE,
    complete_profile,
    force_option,
    json_option,
    overrides,
    path_option,
    set_option,
)
from printprep.errors import UsageError


@click.group(
    "profiles",
    cls=LazyGroup,
    short_help="List, show or make profiles.",
    invoke_without_command=True,
)
@json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """List the profiles (the same as `profiles list`), show one, export one, or make your own.

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
    """List the profiles that come with printprep, the default first, and your own."""
    _list(as_json)


@command.command("show")
@click.argument("name", shell_complete=complete_profile)
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
@click.argument("name", shell_complete=complete_profile)
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


@command.command("new", short_help="Write a profile of your own.")
@click.argument("name")
@click.option(
    "--from",
    "base",
    default=DEFAULT_PROFILE,
    show_default=True,
    metavar="NAME|FILE",
    shell_complete=complete_profile,
    help="The profile to begin with.",
)
@force_option
@json_option
def new_command(name: str, base: str, force: bool, as_json: bool) -> None:
    """Write profile NAME into the folder of your own profiles, for you to edit.

    It begins as a copy of --from, with its comments. Every --profile then takes NAME. The folder is
    that of the variable PRINTPREP_PROFILES, or printprep/profiles in the folder for your
    configuration (~/.config on Linux).
    """
    from printprep.cli.console import print_json
    from printprep.profile_new import copied_text, write_user_profile

    path = write_user_profile(name, copied_text(name, base), replace=force)
    if as_json:
        print_json({"name": name, "file": str(path), "from": base})
        return
    click.echo(f"Written: {path}")
    click.echo(f"Edit it, then use it with --profile {name}.")


@command.command("import", short_help="Make a profile from a slicer's settings.")
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILES..."
)
@click.argument("name")
@click.option(
    "--from",
    "base",
    default=DEFAULT_PROFILE,
    show_default=True,
    metavar="NAME|FILE",
    shell_complete=complete_profile,
    help="The profile that gives what the files lack.",
)
@click.option(
    "--section",
    "sections",
    multiple=True,
    metavar="KIND:NAME",
    help="Section of a config bundle to take, for example 'print:0.20mm QUALITY'; needed where it "
    "has several of one kind (print, filament, printer). Repeatable.",
)
@force_option
@json_option
def import_command(
    files: tuple[Path, ...],
    name: str,
    base: str,
    sections: tuple[str, ...],
    force: bool,
    as_json: bool,
) -> None:
    """Make profile NAME, one of your own, from your settings in a slicer.

    FILES is an .ini of PrusaSlicer or SuperSlicer (File > Export > Export Config, or a config
    bundle), or JSON of OrcaSlicer or Bambu Studio: process, filament and machine, one or several.
    Layers, line width, nozzle, bed and material are taken from them; it is listed what was.
    """
    from printprep.cli.console import print_json, stdout_console
    from printprep.profile_folders import user_profile_path
    from printprep.profile_import.run import import_profile
    from printprep.profile_new import check_may_write, write_user_profile
    from printprep.report.profiles import import_json, show_import

    check_may_write(user_profile_path(name), replace=force)
    done = import_profile(name, files, base, sections)
    path = write_user_profile(name, done.text, replace=force)
    if as_json:
        print_json(import_json(done, path))
    else:
        show_import(stdout_console(), done, path)


def _list(as_json: bool) -> None:
    from printprep.cli.console import print_json, stdout_console
    from printprep.profile_folders import user_folder
    from printprep.profiles import load_profile, profile_names, user_profile_names

    shipped = [load_profile(name) for name in profile_names()]
    own, refused = [], {}
    for name in user_profile_names():
        try:
            own.append(load_profile(name))
        except UsageError as error:
            refused[name] = error.message
    if as_json:
        print_json(
            {
                "profiles": [item.model_dump(mode="json") for item in (*shipped, *own)],
                "own": {
                    "folder": str(user_folder()),
                    "names": [item.name for item in own],
                    "refused": [{"name": name, "message": refused[name]} for name in refused],
                },
            }
        )
        return
    from printprep.report.profiles import show_profiles

    show_profiles(stdout_console(), shipped, own, refused, user_folder())
