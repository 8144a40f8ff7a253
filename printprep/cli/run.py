"""From arguments to an exit code: every way a run can end, in one place.

An error is one line on stderr and a hint, or with --json one object on stdout.  Only an unexpected
exception is called a defect; -v shows its traceback.
"""

from __future__ import annotations

import errno
import re
import signal
import sys
import warnings
from collections.abc import Sequence

import click

from printprep.cli.signals import sentence_of
from printprep.cli.streams import StreamError, guard_streams
from printprep.errors import InputError, OutputError, PrintprepError, UsageError
from printprep.wording import did_you_mean, printable

_INTERRUPTED = 130
_DEFECT = 70
_NO_SPACE = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS})
_MORE_SPACE = "Free some space, or name a folder for temporary files in the variable TMPDIR."
_LESS_MEMORY = (
    "Use a model with fewer triangles or a lower --resolution, or a machine with more memory."
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the program and exit with its exit code."""
    guard_streams()
    arguments = sys.argv[1:] if arguments is None else arguments
    if not _forms(arguments)[1]:  # libraries warn of their own code, which tells a user nothing
        warnings.simplefilter("ignore")
    code = run(arguments)
    try:
        sys.stdout.flush()
    except StreamError as error:
        code = _report(error.code, error.message, error.hint, error.exit_code, as_json=False)
    sys.exit(code)


def run(arguments: Sequence[str]) -> int:
    """Run the command line ``arguments`` (without the program's name); return the exit code."""
    from printprep.cli.app import printprep

    as_json, verbose = _forms(arguments)
    try:
        code = printprep.main(
            list(arguments), prog_name="printprep", standalone_mode=False, obj=tuple(arguments)
        )
        return code if isinstance(code, int) else 0
    except StreamError as error:
        return _report(error.code, error.message, error.hint, error.exit_code, as_json=False)
    except PrintprepError as error:
        return _report(error.code, error.message, error.hint, error.exit_code, as_json)
    except click.FileError as error:
        return _report("output", error.format_message(), None, OutputError.exit_code, as_json)
    except click.ClickException as error:
        return _report("usage", *_usage(error), UsageError.exit_code, as_json)
    except (click.Abort, KeyboardInterrupt):
        return _report("interrupted", "Interrupted.", None, _INTERRUPTED, as_json)
    except MemoryError:
        return _out_of_memory(as_json)
    except Exception as error:  # the outermost boundary: anything else is a defect of printprep
        if isinstance(error, OSError) and error.errno in _NO_SPACE:
            message = f"There is no space for a file: {error.strerror}."
            return _report("output", message, _MORE_SPACE, OutputError.exit_code, as_json)
        if isinstance(error, ImportError | OSError) and _is_about_memory(error):
            return _out_of_memory(as_json)
        if verbose:
            import traceback

            traceback.print_exc()
        name = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        hint = None if verbose else "Run it again with -v for the traceback, and report it."
        return _report("defect", f"This is a defect of printprep: {name}", hint, _DEFECT, as_json)


def report_signal(number: int, arguments: Sequence[str]) -> int:
    """Tell that a signal ended the run; return the exit code."""
    return _report("interrupted", sentence_of(number), None, 128 + number, _forms(arguments)[0])


def report_crash(code: int, arguments: Sequence[str]) -> int:
    """Tell that a library or the system ended the run; return the exit code.

    code : how it ended, negative for a signal.
    """
    as_json, _ = _forms(arguments)
    # The system kills what takes too much memory; libraries that get too little give up.
    if code == -signal.SIGKILL or _memory_is_limited():
        return _out_of_memory(as_json)
    how = f"it crashed ({signal.Signals(-code).name})" if code < 0 else f"it ended with code {code}"
    message = f"This is a defect of printprep or of a library: {how}."
    return _report("defect", message, "Report it, with the model.", _DEFECT, as_json)


def _forms(arguments: Sequence[str]) -> tuple[bool, bool]:
    """Whether the arguments ask for JSON, and for tracebacks.

    Read here and not by click: an error in the arguments must be reported in this form too.
    """
    options = [*arguments, "--"]
    options = options[: options.index("--")]
    verbose = any(re.fullmatch(r"-[a-z]*v[a-z]*|--verbose", option) for option in options)
    return "--json" in options, verbose


def _memory_is_limited() -> bool:
    """Whether this process may not take all the memory there is (ulimit -v)."""
    try:
        import resource
    except ImportError:  # Windows has no such limits
        return False
    limits = (resource.RLIMIT_AS, resource.RLIMIT_DATA)
    return any(resource.getrlimit(limit)[0] != resource.RLIM_INFINITY for limit in limits)


def _is_about_memory(error: Exception) -> bool:
    """Whether a library could not be loaded for want of memory; the loader says so in words."""
    if isinstance(error, OSError) and error.errno == errno.ENOMEM:
        return True
    return re.search(r"cannot allocate memory|failed to map segment", str(error), re.I) is not None


def _out_of_memory(as_json: bool) -> int:
    message = "The memory of this machine, or of its limit, is not enough for this run."
    return _report("input", message, _LESS_MEMORY, InputError.exit_code, as_json)


def _usage(error: click.ClickException) -> tuple[str, str | None]:
    context = getattr(error, "ctx", None)
    hint = None if context is None else f"`{context.command_path} --help` shows the usage."
    if isinstance(error, click.NoSuchOption) and context is not None:
        options = [name for item in context.command.get_params(context) for name in item.opts]
        close = did_you_mean(error.option_name, [name for name in options if name[:2] == "--"])
        return f"There is no option {error.option_name}.", f"{close} {hint}" if close else hint
    return error.format_message(), hint


def _report(code: str, message: str, hint: str | None, exit_code: int, as_json: bool) -> int:
    message = printable(" ".join(message.split()))
    hint = None if hint is None else printable(hint)
    if as_json:
        from printprep.output.numbers import to_text

        click.echo(to_text({"error": {"code": code, "message": message, "hint": hint}}))
        return exit_code
    click.echo(f"printprep: error: {message}", err=True)
    if hint:
        click.echo(f"  {hint}", err=True)
    return exit_code
