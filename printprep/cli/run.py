"""From arguments to an exit code: every way a run can end, in one place.

An error is one line on stderr and a hint, or with --json one object on stdout.  Only an unexpected
exception is called a defect; -v shows its traceback.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence

import click

from printprep.errors import OutputError, PrintprepError, UsageError

_INTERRUPTED = 130
_DEFECT = 70


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the program and exit with its exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a pipe in a code page must not break on a degree sign
            stream.reconfigure(errors="replace")
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run the command line ``arguments`` (without the program's name); return the exit code."""
    from printprep.cli.app import printprep

    # Read here and not by click: an error in the arguments must be reported in this form too.
    options = [*arguments, "--"]
    options = options[: options.index("--")]
    as_json = "--json" in options
    verbose = any(re.fullmatch(r"-[a-z]*v[a-z]*|--verbose", option) for option in options)
    try:
        code = printprep.main(list(arguments), prog_name="printprep", standalone_mode=False)
        return code if isinstance(code, int) else 0
    except PrintprepError as error:
        return _report(error.code, error.message, error.hint, error.exit_code, as_json)
    except click.FileError as error:
        return _report("output", error.format_message(), None, OutputError.exit_code, as_json)
    except click.ClickException as error:
        return _report("usage", *_usage(error), UsageError.exit_code, as_json)
    except (click.Abort, KeyboardInterrupt):
        return _report("interrupted", "Interrupted.", None, _INTERRUPTED, as_json)
    except Exception as error:  # the outermost boundary: anything else is a defect of printprep
        if verbose:
            import traceback

            traceback.print_exc()
        name = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        hint = None if verbose else "Run it again with -v for the traceback, and report it."
        return _report("defect", f"This is a defect of printprep: {name}", hint, _DEFECT, as_json)


def _usage(error: click.ClickException) -> tuple[str, str | None]:
    context = getattr(error, "ctx", None)
    hint = None if context is None else f"`{context.command_path} --help` shows the usage."
    return error.format_message(), hint


def _report(code: str, message: str, hint: str | None, exit_code: int, as_json: bool) -> int:
    message = " ".join(message.split())
    if as_json:
        from printprep.output.numbers import to_text

        click.echo(to_text({"error": {"code": code, "message": message, "hint": hint}}))
        return exit_code
    click.echo(f"printprep: error: {message}", err=True)
    if hint:
        click.echo(f"  {hint}", err=True)
    return exit_code
