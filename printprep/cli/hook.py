"""``printprep hook``: the slicer's post-processing script."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import DEFAULT_PROFILE, placement_of, placement_options
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


@click.command("hook", short_help="Post-process G-code, from the slicer.", epilog=_EPILOG)
@click.argument("gcode", type=click.Path(path_type=Path), metavar="GCODE", required=False)
@click.option(
    "--strict", is_flag=True, help="Fail, so that the slicer reports it, when the print would tip."
)
@click.option(
    "--part",
    type=click.Path(path_type=Path),
    metavar="OUT.3mf",
    help="Compare with the figures of this part, made by `printprep hollow`.",
)
@click.option(
    "--reslice",
    is_flag=True,
    help="Hollow --model with the G-code's settings, slice it, and put that G-code in place.",
)
@click.option(
    "--model",
    type=click.Path(path_type=Path),
    metavar="MODEL",
    help="The model that was sliced, for --reslice.",
)
@click.option(
    "--slicer",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="The PrusaSlicer for --reslice. Default: PRINTPREP_SLICER, else the one on this machine.",
)
@click.option(
    "-p",
    "--profile",
    default=DEFAULT_PROFILE,
    show_default=True,
    metavar="NAME|FILE",
    help="Limits for --reslice, under the G-code's own settings; the lean, unless --lean.",
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
    help="Print the line to paste into the slicer's post-processing scripts, with the options "
    "given, and do nothing else.",
)
@click.option("-v", "--verbose", is_flag=True, help="The traceback of a defect.")
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
    """Measure GCODE as a slicer's post-processing script does, and write the figures at its end.

    Warns when the print would tip at the lean. GCODE is changed in one step at the very end; on
    any failure it is byte for byte what it was. No network, and nothing is written elsewhere.
    """
    from printprep.hook.judge import already_running

    _check(part, reslice, model)
    if print_setting:
        from printprep.hook.command_line import setting_line

        click.echo(setting_line(_options_given(click.get_current_context())))
        return 0
    if gcode is None:
        raise UsageError("GCODE is missing.", "The slicer gives it as the last argument.")
    if already_running():
        return 0
    if reslice:
        assert model is not None  # checked above
        findings = _reslice(gcode, model, slicer, profile, lean, placement_of(placement))
    else:
        findings = _judge(gcode, part, profile, lean, strict=strict)
    failed = [item for item in findings if item.severity == "error"]
    return 1 if strict and failed else 0


def _check(part: Path | None, reslice: bool, model: Path | None) -> None:
    if reslice and model is None:
        raise UsageError("--reslice needs the model.", "Name it with --model.")
    if reslice and part is not None:
        raise UsageError("--reslice and --part exclude each other.")
    if model is not None and not reslice:
        raise UsageError("--model means nothing without --reslice.")


def _judge(
    gcode: Path, part: Path | None, profile: str, lean: str | None, *, strict: bool
) -> Sequence[Finding]:
    """Judge and annotate; with --strict, a print that would tip is left as it was."""
    from printprep.cli.console import trouble_to_stderr
    from printprep.hook.gcode_file import annotate
    from printprep.hook.judge import judge, notes
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of

    asked = lean_of(lean, load_profile(profile).stability.lean_deg)
    found = judge(gcode, lean=asked, part=part)
    trouble_to_stderr(found.findings)
    if not (strict and any(item.severity == "error" for item in found.findings)):
        annotate(gcode, notes(found))
    return found.findings


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
        f"printprep: {done.before.mass_g:.1f} g became {done.after.printed.mass_g:.1f} g", err=True
    )
    return done.after.findings


def _options_given(context: click.Context) -> list[str]:
    """The options of this very call, paths made absolute: a slicer runs scripts anywhere."""
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
