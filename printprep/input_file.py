"""Reads a file as a whole, within a limit, and only a plain one.

A device, a pipe or a link to one has no end, and a file can claim any size: both are told before a
byte is read.
"""

from __future__ import annotations

import stat
from pathlib import Path

from printprep.errors import InputError

# No model that printprep can work on is larger: 1 GiB are 20 million triangles of binary STL.
INPUT_BYTES_MAX = 1 << 30


def read_plain_file(path: Path, limit_bytes: int = INPUT_BYTES_MAX) -> bytes:
    """The content of a plain file, of one byte or more.

    Raises InputError for a file that is missing, unreadable, empty, no plain file (a folder, a
    device, a pipe, or a link to one), or larger than ``limit_bytes``; nothing of it is read then.
    """
    check_plain_file(path, limit_bytes)
    try:
        with path.open("rb") as file:
            data = file.read(limit_bytes + 1)
    except OSError as error:
        raise InputError(
            f"{path} cannot be read: {_reason_of(error)}.",
            "Check that you have permission to read the file.",
        ) from error
    if not data:
        raise InputError(f"{path} is empty: 0 bytes.", "Export or download the file again.")
    if len(data) > limit_bytes:  # it grew, or its size is not what the system says
        raise _too_large(path, len(data), limit_bytes)
    return data


def check_plain_file(path: Path, limit_bytes: int = INPUT_BYTES_MAX) -> None:
    """Raise InputError unless there is a plain file of at most ``limit_bytes`` at ``path``."""
    try:
        found = path.stat()
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Check the name and the folder.") from error
    except (OSError, ValueError) as error:  # ValueError: a name with a zero character
        reason = _reason_of(error) if isinstance(error, OSError) else "no file can have this name"
        raise InputError(f"{path} cannot be read: {reason}.", "Check the name.") from error
    if stat.S_ISDIR(found.st_mode):
        raise InputError(f"{path} is a folder, not a file.", "Name the model file inside it.")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(
            f"{path} is not a plain file but a device, a pipe or a socket, or a link to one.",
            "Copy its content into a file first.",
        )
    if found.st_size > limit_bytes:
        raise _too_large(path, found.st_size, limit_bytes)


def _too_large(path: Path, size: int, limit_bytes: int) -> InputError:
    return InputError(
        f"{path} has {size / 2**20:.0f} MiB; at most {limit_bytes / 2**20:.0f} MiB are read.",
        "Reduce the number of triangles in a modelling program.",
    )


def _reason_of(error: OSError) -> str:
    return error.strerror or type(error).__name__
