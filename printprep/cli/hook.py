"""``printprep hook``: a post-processing script for the slicer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import (
    path_option,
    placement_of,
    placement_options,
    profile_option_with,
    slicer_option,
    traceback_option,
)
from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.pipeline.options import Placement
    from printprep.types import Finding

_EPILOG = """\b
Examples:
  printprep hook --print-setting --strict
  printprep hook --part out.3mf part.gcode
  printprep hook --reslice --model model.stl part.gcode
"""


@click.command("hook", short_help="Measure G-code in the slicer's post-processing.", epilog=_EPILOG)
@click.argument("gcode", type=click.Path(path_type=Path), metavar="GCODE", required=False)
@click.option(
    "--strict",
    is_flag=True,
    help="Fail on an error, such as a print that tips over, so that the slicer reports it.",
)
@path_option(
    "--part",
    metavar="OUT.3mf",
    help="Compare the print with the figures of this part, made by `printprep hollow`.",
)
@click.option(
    "--reslice",
    is_flag=True,
    help="Hollow --model with the settings of the G-code, slice it, and replace GCODE.",
)
@path_option(
    "--model",
    metavar="MODEL",
    help="The model that was sliced, for --reslice.",
)
@slicer_option("PrusaSlicer for --reslice. Default: PRINTPREP_SLICER, or the one installed.")
@profile_option_with(
    "Profile for the lean, and for --reslice, where the settings of the G-code come first."
)
@click.option(
    "--lean",
    metavar="DEG[@AZIMUTH]",
    help="Lean at which the print must still stand. Default: the part's, else the profile's.",
)
@placement_options
@click.option(
    "--print-setting",
    is_flag=True,
    help="Print the line to paste into the slicer's post-processing scripts, with the given "
    "options, and do nothing else.",
)
@traceback_option
def command(
    gcode: Path | None,
    strict: bool,
    part: Path | None,
    reslice: bool,
    model: Path | None,
    slicer: Path | None,
    profile: str,
    lean: str | None,
    print_setting: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Measure GCODE as a slicer's post-processing script, and write the figures at its end.

    GCODE is text, binary G-code (.bgcode) or a sliced project of one plate (.gcode.3mf). The hook
    warns if the print tips over at less than --lean. GCODE is changed in a single step at the end;
    after any failure it is unchanged. The hook uses no network and writes no other file.
    """
    from printprep.cli.console import trouble_to_stderr
    from printprep.hook.judge import already_running, judge_and_annotate

    _check_combination(part, reslice, model)
    if print_setting:
        from printprep.hook.command_line import setting_line

        click.echo(setting_line(_options_given(click.get_current_context())))
        return 0
    if gcode is None:
        raise UsageError("GCODE is missing.", "The slicer passes it as the last argument.")
    if already_running():
        return 0
    if reslice:
        assert model is not None  # checked above
        findings = _reslice(gcode, model, slicer, profile, lean, placement_of(placement))
    else:
        findings = judge_and_annotate(
            gcode, profile=profile, lean=lean, part=part, strict=strict
        ).findings
        trouble_to_stderr(findings)
    failed = [item for item in findings if item.severity == "error"]
    return 1 if strict and failed else 0


def _check_combination(part: Path | None, reslice: bool, model: Path | None) -> None:
    if reslice and model is None:
        raise UsageError("--reslice needs the model.", "Name it with --model.")
    if reslice and part is not None:
        raise UsageError("--reslice and --part exclude each other.", "Leave out one of them.")
    if model is not None and not reslice:
        raise UsageError("--model has no effect without --reslice.", "Add --reslice.")


def _reslice(
    gcode: Path,
    model: Path,
    slicer: Path | None,
    profile: str,
    lean: str | None,
    placement: Placement,
) -> Sequence[Finding]:
    from printprep.cli.console import trouble_to_stderr
    from printprep.hook.reslice import reslice
    from printprep.progress import for_terminal

    done = reslice(
        gcode,
        model,
        slicer=slicer,
        profile=profile,
        lean=lean,
        placement=placement,
        progress=for_terminal(),
    )
    trouble_to_stderr(done.after.findings)
    click.echo(
        f"printprep: The print weighs {done.after.printed.mass_g:.1f} g instead of "
        f"{done.before.mass_g:.1f} g.",
        err=True,
    )
    return done.after.findings


def _options_given(context: click.Context) -> list[str]:
    """The options of this call, with absolute paths: a slicer may run scripts in any folder."""
    words = []
    for parameter in context.command.params:
        name = parameter.name or ""
        given = context.get_parameter_source(name) == click.core.ParameterSource.COMMANDLINE
        if not (isinstance(parameter, click.Option) and given) or name == "print_setting":
            continue
        words.append(parameter.opts[-1])
        value = context.params[name]
        if isinstance(value, Path):
            words.append(str(value.absolute()))
        elif not parameter.is_flag:
            words.append(str(value))
    return words
