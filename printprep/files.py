"""Writes a file so that it is either whole or not there.

The bytes go to a temporary file beside the target, are forced to the disk, and take the target's
name in one step (POSIX ``rename``, Windows ``MoveFileEx``, both through ``os.replace``).  A reader
of the target sees the old file or the new one, never a part of it.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from printprep.errors import OutputError


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
