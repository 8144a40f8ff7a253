"""Writes a file so that it is either whole or not there; folders for temporary files.

The bytes go to a temporary file in the target's folder, are forced to the disk, and take the
target's name in one step (POSIX ``rename``, Windows ``MoveFileEx``, both through ``os.replace``).
A reader of the target sees the old file or the new one, never a part of it.  On Linux the temporary
file has no name (``O_TMPFILE``), so that a program that is killed leaves none behind.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from printprep.errors import OutputError

_PART, _PART_SUFFIX = ".printprep-", ".part"


def write_atomically(path: Path, data: bytes) -> None:
    """Put ``data`` at ``path``, in place of a file that is there.

    Raises
    ------
    OutputError : as ``refuse_impossible_target``, or the disk is full.  The target is unchanged
        then, and no temporary file is left beside it.
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

    The new file has the permission bits of the one it replaces, where the system allows it.  A
    link stays a link: the file it points to is replaced.  After an error (an interrupt too) the
    target is unchanged, and no temporary file is left beside it.

    Raises OSError as the system reports it; the caller knows what to say about it.
    """
    path = Path(os.path.realpath(path))
    handle, part = _temporary_in(path.parent)
    try:
        with os.fdopen(handle, "wb") as out:
            yield out
            out.flush()
            # A result is not lost because a file system has no permission bits.
            with contextlib.suppress(OSError):
                os.fchmod(out.fileno(), _permissions(path))
            os.fsync(out.fileno())
            if part is None:
                part = _named(out.fileno(), path)
        if part is not None:
            part.replace(path)
    finally:
        # After a success the temporary name no longer exists; after any failure it must not.
        if part is not None:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)


@contextlib.contextmanager
def scratch_folder() -> Iterator[Path]:
    """A new folder for temporary files, removed when the block ends.

    Its name holds the number of this process: what a process leaves that dies can be told.

    Raises OutputError where there is no place for it.
    """
    try:
        folder = tempfile.TemporaryDirectory(
            prefix=scratch_prefix(os.getpid()), ignore_cleanup_errors=True
        )
    except OSError as error:
        raise OutputError(
            f"There is no place for temporary files: {reason_of(error)}.",
            "Free some space, or name a folder in the variable TMPDIR.",
        ) from error
    with folder as name:
        yield Path(name)


def scratch_prefix(process: int) -> str:
    """How the names of a process's folders for temporary files begin."""
    return f"printprep-{process}-"


def _temporary_in(folder: Path) -> tuple[int, Path | None]:
    """A new file in a folder: its descriptor, and its name where it has one."""
    if hasattr(os, "O_TMPFILE"):
        # Not every file system has files without a name, nor is /proc always there to name them.
        with contextlib.suppress(OSError):
            handle = os.open(folder, os.O_TMPFILE | os.O_RDWR | os.O_CLOEXEC, 0o600)
            if Path(f"/proc/self/fd/{handle}").exists():
                return handle, None
            os.close(handle)
    handle, name = tempfile.mkstemp(dir=folder, prefix=_PART, suffix=_PART_SUFFIX)
    return handle, Path(name)


def _named(handle: int, path: Path) -> Path | None:
    """Give a file without a name the name ``path``, or where that exists another one beside it.

    Returns that other name, None where it has got ``path``.
    """
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY)
    try:
        # Only with a folder does Python ask the system to follow the link that /proc holds.
        source = f"/proc/self/fd/{handle}"
        try:
            os.link(source, path.name, src_dir_fd=folder, dst_dir_fd=folder)
            return None
        except FileExistsError:
            name = f"{_PART}{secrets.token_hex(8)}{_PART_SUFFIX}"
            os.link(source, name, src_dir_fd=folder, dst_dir_fd=folder)
            return path.parent / name
    finally:
        os.close(folder)


def reason_of(error: OSError) -> str:
    """Why the system refused, in its own words ("No space left on device")."""
    return error.strerror or type(error).__name__


def refuse_impossible_target(path: Path) -> None:
    """Raise OutputError for a target that cannot be written, before any work.

    That is a folder, a device, a read-only file, a name that is too long or in no folder, or one in
    a folder that is not writable.
    """
    try:
        there = _mode_of(path)
        folder = Path(os.path.realpath(path)).parent
        folder_there = folder.is_dir()
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written: {reason_of(error)}.", "Name another file."
        ) from error
    if there is not None and stat.S_ISDIR(there):
        raise OutputError(
            f"{path} is a folder, not a file.", "Name a file inside it, for example out.3mf."
        )
    if there is not None and not stat.S_ISREG(there):
        raise OutputError(
            f"{path} is no plain file, and is not replaced.", "Name a file, for example out.3mf."
        )
    if there is not None and not (there & 0o222 and os.access(path, os.W_OK)):
        raise OutputError(
            f"{path} is read-only, and is not replaced.",
            "Name another file, or allow writing to this one.",
        )
    if not folder_there:
        raise OutputError(
            f"{path} cannot be written: the folder {folder} does not exist.",
            "Make the folder first, or name another one.",
        )
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputError(
            f"{path} cannot be written: the folder {folder} is not writable.",
            "Name a folder that you may write to.",
        )


def _mode_of(path: Path) -> int | None:
    """Type and mode bits of what a path names, None where nothing is there yet."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def _permissions(path: Path) -> int:
    """Mode bits of the file that is replaced, else those that a plain ``open`` would give.

    ``mkstemp`` makes files that only their owner can read; a model is often written for others.
    """
    with contextlib.suppress(OSError):
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
