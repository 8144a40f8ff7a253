"""The journal of a batch: one JSON line a row, appended and forced to the disk as rows end.

A batch that is killed leaves at most a torn last line, which is not a row.
"""

from __future__ import annotations

import os
from pathlib import Path
from types import TracebackType
from typing import IO

from printprep.batches.item import Item, key_of, sha256_of
from printprep.batches.row import FINAL, Row
from printprep.errors import OutputError

NAME = "journal.jsonl"


class Journal:
    """Appends rows to the journal in a folder; use it as a context."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._file: IO[bytes] | None = None

    def __enter__(self) -> Journal:
        try:
            self._file = self._path.open("ab")
            if self._file.tell() and not _ends_line(self._path):
                self._file.write(b"\n")
        except OSError as error:
            raise _refused(self._path, error) from error
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        assert self._file is not None
        self._file.close()

    def append(self, row: Row) -> None:
        """Add a row and force it to the disk.  Raises OutputError where the disk refuses."""
        import json

        assert self._file is not None
        line = json.dumps(row.to_json(), allow_nan=False, separators=(",", ":"))
        try:
            self._file.write(line.encode("ascii") + b"\n")
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise _refused(self._path, error) from error


def rows_in(folder: Path) -> dict[str, Row]:
    """The last row of each output in a folder's journal; lines that are no row do not count."""
    path = folder / NAME
    rows: dict[str, Row] = {}
    try:
        with path.open("rb") as lines:
            for line in lines:
                try:
                    row = Row.from_json(line)
                except ValueError:
                    continue
                rows[row.output] = row
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise _refused(path, error) from error
    return rows


def is_complete(item: Item, row: Row | None, folder: Path) -> bool:
    """Whether a row stands for just this item and, where there is a part, for just that file."""
    if row is None or row.status not in FINAL or row.key != key_of(item.job) or not row.key:
        return False
    if row.status != "part":
        return True
    if item.job.report is not None and not item.job.report.is_file():
        return False
    try:
        return sha256_of(folder / item.output) == row.output_sha256
    except OSError:
        return False


def _ends_line(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read(1) == b"\n"


def _refused(path: Path, error: OSError) -> OutputError:
    reason = error.strerror or type(error).__name__
    return OutputError(f"{path} cannot be written: {reason}.", "Name another folder with -o.")
