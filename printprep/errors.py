"""Everything printprep raises on purpose, each family with its exit code.

A message names the file or option, the fact, and, in ``hint``, the way out.  Anything else that
escapes is a defect of ours (exit code 70).
"""

from __future__ import annotations

from typing import ClassVar


class PrintprepError(Exception):
    """Base of all errors a user can meet.

    Parameters
    ----------
    message : one sentence that names what it is about and the fact.
    hint : what to do about it, or None when the message already says so.
    """

    exit_code: ClassVar[int] = 70
    code: ClassVar[str] = "defect"

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


class UsageError(PrintprepError):
    """An option, profile key or argument that cannot be meant."""

    exit_code = 2
    code = "usage"


class InputError(PrintprepError):
    """The input cannot be read, or is refused."""

    exit_code = 3
    code = "input"


class GeometryError(PrintprepError):
    """The input was read but cannot be made a solid."""

    exit_code = 4
    code = "geometry"


class OutputError(PrintprepError):
    """The result cannot be written where it was asked for."""

    exit_code = 5
    code = "output"


class ToolError(PrintprepError):
    """An external program (a slicer) is missing, failed or answered nonsense."""

    exit_code = 6
    code = "tool"
