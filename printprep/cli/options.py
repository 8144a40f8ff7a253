"""Options that several commands share, so that they have the same name and meaning everywhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from printprep.errors import UsageError
from printprep.pipeline.options import Placement
from printprep.types import VAULT_CHOICES

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from printprep.types import Finding, Severity

Command = TypeVar("Command", bound=Callable[..., Any])

UNITS = ("mm", "cm", "m", "in")
DEFAULT_PROFILE = "fdm-pla-0.4"


def together(*options: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Several options as one decorator, in the order of --help."""

    def decorate(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def model_argument(command: Command) -> Command:
    """The file to work on; the reader reports a missing one (exit code 3)."""
    return click.argument("model", type=click.Path(path_type=Path), metavar="MODEL")(command)


def placement_options(command: Command) -> Command:
    """What to take from the file; unit, axis and size of the model."""
    return together(
        click.option(
            "--plate",
            type=click.IntRange(1),
            metavar="N",
            help="Plate of a 3MF project to read; needed where it has several.",
        ),
        click.option(
            "--object",
            "item",
            metavar="NAME|N",
            help="The one object of a 3MF to read, by its name or its number. Default: all.",
        ),
        click.option(
            "--partial",
            is_flag=True,
            help="Take the facets that are there from an STL or PLY file that is cut short.",
        ),
        click.option(
            "--units",
            type=click.Choice(UNITS),
            help="Unit of the numbers in the file. Default: the one named in the file, or mm.",
        ),
        click.option(
            "--up",
            default="+z",
            show_default=True,
            metavar="AXIS",
            help="Axis of the file that points up: x, y or z, with a sign if you like.",
        ),
        click.option("--scale", type=float, metavar="FACTOR", help="Scale by this factor."),
        click.option(
            "--height", "height_mm", type=float, metavar="MM", help="Scale to this height."
        ),
        click.option(
            "--size", "size_mm", type=float, metavar="MM", help="Scale to this longest side."
        ),
    )(command)


def placement_of(options: Mapping[str, Any], pose: int | None = None) -> Placement:
    """The values of ``placement_options``, as one value."""
    return Placement(**options, pose=pose)


def resolution_option(command: Command) -> Command:
    """How fine the optimization is."""
    return click.option(
        "--resolution",
        type=int,
        default=64,
        show_default=True,
        metavar="N",
        help="Voxels along the longest side, for the optimization. Walls are exact at any "
        "resolution.",
    )(command)


def base_option(command: Command) -> Command:
    """Whether a base is allowed."""
    return click.option(
        "--base",
        type=click.Choice(("auto", "never", "always")),
        default="auto",
        show_default=True,
        help="Whether to add a base under the feet, which seats them on the bed and grows their "
        "footprint. auto: where that saves material.",
    )(command)


def max_memory_option(command: Command) -> Command:
    """How much memory a run may take."""
    return click.option(
        "--max-memory",
        "max_memory_mib",
        type=click.FloatRange(min=0, min_open=True),
        metavar="MIB",
        help="Refuse a model that would take more memory than this, by an estimate made once it is "
        "read. Default: what the machine has free.",
    )(command)


def voids_option(command: Command) -> Command:
    """What becomes of the model's own sealed voids."""
    return click.option(
        "--voids",
        type=click.Choice(("fill", "keep")),
        default="fill",
        show_default=True,
        help="What becomes of sealed voids that the model brings. fill: they are filled before "
        "anything is hollowed, but for those that hold a body of their own (a rattle). keep: all "
        "of them stay, with vaults and drain holes where the process needs them.",
    )(command)


def vaults_option(command: Command) -> Command:
    """Which vaults carry the ceilings of cavities."""
    return together(
        click.option(
            "--vaults",
            type=click.Choice(VAULT_CHOICES),
            help="Vaults that carry the ceilings of cavities from inside. printer: as steep as the "
            "printer lays them; the 3MF tells PrusaSlicer to keep its supports out. slicer: so "
            "steep that no slicer puts supports there. none: no vaults. Default: printer for "
            "filament, slicer if the file cannot keep supports out, none for resin and powder.",
        ),
        click.option(
            "--no-self-support",
            "vaults",
            flag_value="none",
            help="The same as --vaults none.",
        ),
    )(command)


def complete_profile(
    ctx: click.Context, parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """What a shell completes a profile to: names that begin so, and files.

    The files come first: click's script for bash forgets what came before them.
    """
    from click.shell_completion import CompletionItem

    from printprep.profile_folders import profile_names, user_profile_names

    del ctx, parameter
    names = (*profile_names(), *user_profile_names())
    found = [CompletionItem(name) for name in names if name.startswith(incomplete)]
    return [CompletionItem(incomplete, type="file"), *found]


def profile_option_with(description: str) -> Callable[[Command], Command]:
    """Printer, material and limits, with a command's own description."""
    return click.option(
        "-p",
        "--profile",
        default=DEFAULT_PROFILE,
        show_default=True,
        metavar="NAME|FILE",
        shell_complete=complete_profile,
        help=description,
    )


def profile_option(command: Command) -> Command:
    """Printer, material and limits."""
    return profile_option_with(
        "Printer, material and limits: a name from `printprep profiles`, or a TOML file."
    )(command)


def profile_options(command: Command) -> Command:
    """Printer, material and limits, and single keys of them."""
    return together(
        profile_option,
        set_option,
        click.option(
            "--wall",
            "wall_mm",
            type=float,
            metavar="MM",
            help="Thinnest wall (profile key wall_mm).",
        ),
        lean_option,
    )(command)


def lean_option(command: Command) -> Command:
    """The lean that the part must stand."""
    return click.option(
        "--lean",
        "lean",
        metavar="DEG[@AZIMUTH]",
        help="Lean at which the part must still stand: in every direction (15), or toward one "
        "azimuth (15@90; counter-clockwise from +x). Default: the profile's.",
    )(command)


def path_option(*names: str, metavar: str, help: str) -> Callable[[Command], Command]:
    """An option that takes a path, which need not exist.  names : as click takes them."""
    return click.option(*names, type=click.Path(path_type=Path), metavar=metavar, help=help)


def slicer_option(description: str) -> Callable[[Command], Command]:
    """The slicer to run, with what a command needs it for."""
    return path_option("--slicer", metavar="PATH", help=description)


def fail_on_option(default: str, consequence: str = "") -> Callable[[Command], Command]:
    """Which findings count as a failure; ``consequence`` says what else follows."""
    return click.option(
        "--fail-on",
        type=click.Choice(("none", "info", "warning", "error")),
        default=default,
        show_default=True,
        help=f"Exit with code 1 if a finding is at least this severe.{consequence}",
    )


def severity_of(fail_on: str) -> Severity | None:
    """The severity that --fail-on names, None for none."""
    return None if fail_on == "none" else cast("Severity", fail_on)


def exit_code(findings: Sequence[Finding], fail_on: str) -> int:
    """1 if a finding is at least as severe as --fail-on names, else 0."""
    from printprep.check import at_or_above

    severity = severity_of(fail_on)
    return 1 if severity is not None and at_or_above(findings, severity) else 0


def output_form_options(
    default_fail_on: str, consequence: str = ""
) -> Callable[[Command], Command]:
    """How results are printed, and which findings count as a failure."""
    return together(
        fail_on_option(default_fail_on, consequence),
        json_option,
        quiet_option,
        click.option(
            "-v",
            "--verbose",
            is_flag=True,
            help="Print more figures, and the traceback of a defect.",
        ),
    )


def json_option(command: Command) -> Command:
    """One JSON object and nothing else on stdout."""
    return click.option(
        "--json", "as_json", is_flag=True, help="Print one JSON object; errors are JSON too."
    )(command)


def dry_run_option(command: Command) -> Command:
    """Say what would be done, and do nothing."""
    return click.option(
        "--dry-run",
        is_flag=True,
        help="Check options and files, read and place the model, and print what would be done. "
        "Nothing is hollowed or written.",
    )(command)


def force_option(command: Command) -> Command:
    """Whether a file of the user's may be replaced."""
    return click.option("--force", is_flag=True, help="Replace a profile of yours that is there.")(
        command
    )


def quiet_option(command: Command) -> Command:
    """No progress and no summary."""
    return click.option(
        "-q", "--quiet", is_flag=True, help="Print only warnings and errors, on stderr."
    )(command)


def traceback_option(command: Command) -> Command:
    """-v for commands without more figures; ``cli.run`` reads it from the arguments."""
    return click.option("-v", "--verbose", is_flag=True, help="Print the traceback of a defect.")(
        command
    )


def set_option(command: Command) -> Command:
    """Single keys of the profile."""
    return click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="KEY=VALUE",
        help="Change a profile key, for example printer.layer_height_mm=0.3. Repeatable.",
    )(command)


def check_picture(path: Path | None, option: str, suffixes: Sequence[str]) -> None:
    """Check before the long work that a picture can be written; None means no picture.

    Raises UsageError for another suffix, OutputError for a folder that is missing or not writable.
    """
    from printprep.output.limits import check_writable

    if path is None:
        return
    if path.suffix.lower() not in suffixes:
        known = " or ".join(suffixes)
        raise UsageError(
            f"{path}: --{option} writes only {known}.", f"Name a file that ends in {known}."
        )
    check_writable(path)


def overrides(
    settings: Sequence[str],
    wall_mm: float | None = None,
    more: Mapping[str, object] | None = None,
) -> Mapping[str, object]:
    """The profile keys that --set, --wall and a command's own options change.

    Raises UsageError for a --set without a key, and for a key given twice.
    """
    pairs: list[tuple[str, object]] = []
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not (key.strip() and equals):
            raise UsageError(
                f"--set {setting} is not of the form KEY=VALUE.",
                "An example: --set printer.layer_height_mm=0.3.",
            )
        pairs.append((key.strip(), value.strip()))
    if wall_mm is not None:
        pairs.append(("wall_mm", wall_mm))
    pairs += (more or {}).items()
    changed = dict(pairs)
    if len(changed) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise UsageError(
            f"{twice} is set twice.", "Set it once, with --set or with its own option."
        )
    return changed
