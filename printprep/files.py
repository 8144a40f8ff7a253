"""Writing a file so that it is either whole or not there.

The bytes go to a temporary file beside the target, are forced to the disk, and take the target's
name in one step (POSIX ``rename``, Windows ``MoveFileEx``, both through ``os.replace``).  Whoever
reads the target sees the old file or the new one, never a part of it.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

from printprep.errors import OutputError


def write_atomically(path: Path, data: bytes) -> None:
    """Put ``data`` at ``path``, replacing a file that is there.

    Raises
    ------
    OutputError : the folder is missing or refuses to be written to, the target is a folder, or
        the disk is full.  The target is then as it was and nothing is left beside it.
    """
    path = Path(path)
    _refuse_hopeless(path)
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    except OSError as error:
        raise _refused(path, error) from error
    part = Path(name)
    try:
        with os.fdopen(handle, "wb") as out:
            out.write(data)
            out.flush()
            os.fsync(out.fileno())
        part.chmod(_permissions(path))
        part.replace(path)
    except OSError as error:
        raise _refused(path, error) from error
    finally:
        # After a success the name is gone already; after a failure (an interrupt too) it must be.
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def _refuse_hopeless(path: Path) -> None:
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
    """Mode bits of the file that is replaced, else what a plain ``open`` would have given.

    ``mkstemp`` makes files only their owner can read; a model written for others must not stay so.
    """
    with contextlib.suppress(OSError):
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _refused(path: Path, error: OSError) -> OutputError:
    reason = error.strerror or type(error).__name__
    return OutputError(
        f"{path} cannot be written: {reason}.",
        "Choose a folder you may write to, on a disk with room.",
    )
