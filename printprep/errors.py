"""The exceptions that printprep raises on purpose, each family with its exit code.

A message names the file or option and the fact; ``hint`` says what to do.  Both are sentences: a
capital letter (or a name) first, a full stop last.  Any other exception that reaches the user is a
defect of printprep (exit code 70).
"""

from __future__ import annotations

from typing import ClassVar


class PrintprepError(Exception):
    """Base of all errors a user can meet.

    Parameters
    ----------
    message : one sentence that names the file or option and the fact.
    hint : what to do about it, or None where the message already says so.
    """

    exit_code: ClassVar[int] = 70
    code: ClassVar[str] = "defect"

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


class UsageError(PrintprepError):
    """An invalid option, argument or profile key."""

    exit_code = 2
    code = "usage"


class InputError(PrintprepError):
    """A file that cannot be read, or is refused."""

    exit_code = 3
    code = "input"


class GeometryError(PrintprepError):
    """A model that was read but cannot be made a solid."""

    exit_code = 4
    code = "geometry"


class OutputError(PrintprepError):
    """A result that cannot be written to the path given."""

    exit_code = 5
    code = "output"


class ToolError(PrintprepError):
    """An external program (a slicer) that is missing, failed, or gave unusable output."""

    exit_code = 6
    code = "tool"
