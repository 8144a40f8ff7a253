"""Options that several commands share, so that they read and mean the same everywhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from printprep.errors import UsageError
from printprep.pipeline.options import Placement

if TYPE_CHECKING:
    from printprep.types import Finding, Severity

Command = TypeVar("Command", bound=Callable[..., Any])

UNITS = ("mm", "cm", "m", "in")
DEFAULT_PROFILE = "fdm-pla-0.4"


def _together(*options: Callable[[Command], Command]) -> Callable[[Command], Command]:
    def decorate(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def model_argument(command: Command) -> Command:
    """The file to work on; that it is there is the reader's to say (exit code 3)."""
    return click.argument("model", type=click.Path(path_type=Path), metavar="MODEL")(command)


def placement_options(command: Command) -> Command:
    """Unit, axis and size of the model."""
    return _together(
        click.option(
            "--units",
            type=click.Choice(UNITS),
            help="Unit of the file's numbers. Default: what the file says, else mm.",
        ),
        click.option(
            "--up",
            default="+z",
            show_default=True,
            metavar="AXIS",
            help="Axis of the file that points up: x, y or z, with an optional sign.",
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
    """What ``placement_options`` were given, as one value."""
    return Placement(**options, pose=pose)


def resolution_option(command: Command) -> Command:
    """How fine the optimization is."""
    return click.option(
        "--resolution",
        type=int,
        default=64,
        show_default=True,
        metavar="N",
        help="Voxels along the longest side, for the optimization; walls are exact at any.",
    )(command)


def base_option(command: Command) -> Command:
    """Whether a base is allowed."""
    return click.option(
        "--base",
        type=click.Choice(("auto", "never", "always")),
        default="auto",
        show_default=True,
        help="Add a base under the feet (seat them, grow their footprint); auto: where that saves "
        "material.",
    )(command)


def self_support_option(command: Command) -> Command:
    return click.option(
        "--self-support/--no-self-support",
        default=None,
        help="Carry the ceilings of cavities by vaults inside them, so that they print without "
        "support. Default: for filament.",
    )(command)


def profile_option(command: Command) -> Command:
    """Printer, material and limits."""
    return click.option(
        "-p",
        "--profile",
        default=DEFAULT_PROFILE,
        show_default=True,
        metavar="NAME|FILE",
        help="Printer, material and limits: a name from `printprep profiles`, or a TOML file.",
    )(command)


def profile_options(command: Command) -> Command:
    """Printer, material and limits, and single keys of them."""
    return _together(
        profile_option,
        set_option,
        click.option(
            "--wall", "wall_mm", type=float, metavar="MM", help="Thinnest wall (key wall_mm)."
        ),
        click.option(
            "--lean",
            "lean",
            metavar="DEG[@AZIMUTH]",
            help="Lean at which the part must still stand, in every direction, or toward one "
            "azimuth (15@90; from +x, counter-clockwise). Default: the profile's.",
        ),
    )(command)


def fail_on_option(default: str) -> Callable[[Command], Command]:
    """What counts as failing."""
    return click.option(
        "--fail-on",
        type=click.Choice(("none", "info", "warning", "error")),
        default=default,
        show_default=True,
        help="Exit with 1 when a finding is at least this severe; hollow then writes nothing.",
    )


def severity_of(fail_on: str) -> Severity | None:
    """The severity that --fail-on names, None for none."""
    return None if fail_on == "none" else cast("Severity", fail_on)


def exit_code(findings: Sequence[Finding], fail_on: str) -> int:
    """1 where a finding is at least as severe as --fail-on names, else 0."""
    from printprep.check import at_or_above

    severity = severity_of(fail_on)
    return 1 if severity is not None and at_or_above(findings, severity) else 0


def output_form_options(default_fail_on: str) -> Callable[[Command], Command]:
    """How to say what was found, and what counts as failing."""
    return _together(
        fail_on_option(default_fail_on),
        json_option,
        click.option("-q", "--quiet", is_flag=True, help="Only warnings and errors, on stderr."),
        click.option(
            "-v", "--verbose", is_flag=True, help="More figures; the traceback of a defect."
        ),
    )


def json_option(command: Command) -> Command:
    """One JSON object and nothing else on stdout."""
    return click.option(
        "--json", "as_json", is_flag=True, help="Print one JSON object, errors too."
    )(command)


def set_option(command: Command) -> Command:
    """Any key of the profile."""
    return click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="KEY=VALUE",
        help="Change a key of the profile, as printer.layer_height_mm=0.3. Repeatable.",
    )(command)


def check_picture(path: Path | None, option: str, suffixes: Sequence[str]) -> None:
    """Find out before the long work whether a picture can be written; None is no picture.

    Raises UsageError for another suffix, OutputError for a folder that is missing or not writable.
    """
    from printprep.output.limits import check_writable

    if path is None:
        return
    if path.suffix.lower() not in suffixes:
        known = " or ".join(suffixes)
        raise UsageError(
            f"{path}: --{option} writes {known}.", f"Name a file that ends in {known}."
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
                f"--set {setting}: there is no KEY=VALUE in it.",
                "For example --set printer.layer_height_mm=0.3.",
            )
        pairs.append((key.strip(), value.strip()))
    if wall_mm is not None:
        pairs.append(("wall_mm", wall_mm))
    pairs += (more or {}).items()
    changed = dict(pairs)
    if len(changed) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise UsageError(f"{twice} is set twice.", "Give it once, by --set or its own option.")
    return changed
