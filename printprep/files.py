"""Reads a file within limits, and writes one so that it is either whole or not there.

A file that is read must be a plain file: a device, a pipe or a link to one has no end.

The bytes go to a temporary file beside the target, are forced to the disk, and take the target's
name in one step (POSIX ``rename``, Windows ``MoveFileEx``, both through ``os.replace``).  A reader
of the target sees the old file or the new one, never a part of it.
"""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from printprep.errors import InputError, OutputError

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
            f"{path} cannot be read: {reason_of(error)}.",
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
        reason = reason_of(error) if isinstance(error, OSError) else "no file can have this name"
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


def write_atomically(path: Path, data: bytes) -> None:
    """Put ``data`` at ``path``, in place of a file that is there.

    Raises
    ------
    OutputError : the folder is missing or read-only, the target is a folder, or the disk is full.
        The target is unchanged then, and no temporary file is left beside it.
    """
    path = Path(path)
    refuse_impossible_target(path)
    try:
        with replacing(path) as out:
            out.write(data)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written: {reason_of(error)}.",
            "Choose a folder you can write to, on a disk with free space.",
        ) from error


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """An empty binary file that takes the place of ``path`` when the block ends without an error.

    The new file has the permission bits of the one it replaces.  After an error (an interrupt too)
    the target is unchanged, and no temporary file is left beside it.

    Raises OSError as the system reports it; the caller knows what to say about it.
    """
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    part = Path(name)
    try:
        with os.fdopen(handle, "wb") as out:
            yield out
            out.flush()
            os.fsync(out.fileno())
        part.chmod(_permissions(path))
        part.replace(path)
    finally:
        # After a success the temporary name no longer exists; after any failure it must not.
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def reason_of(error: OSError) -> str:
    """Why the system refused, in its own words ("No space left on device")."""
    return error.strerror or type(error).__name__


def refuse_impossible_target(path: Path) -> None:
    """Raise OutputError for a target that no file can have: a folder, or a name in none."""
    if path.is_dir():
        raise OutputError(
            f"{path} is a folder, not a file.", "Name a file inside it, for example out.3mf."
        )
    if not path.parent.is_dir():
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} does not exist.",
            "Make the folder first, or name another one.",
        )


def _permissions(path: Path) -> int:
    """Mode bits of the file that is replaced, else those that a plain ``open`` would give.

    ``mkstemp`` makes files that only their owner can read; a model is often written for others.
    """
    with contextlib.suppress(OSError):
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
