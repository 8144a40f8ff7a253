"""Reads parts of an untrusted zip: by name from memory, never extracted, never beyond a size limit.

Part names are compared as OPC asks (case, leading slash and dot segments do not matter) and only
looked up in the archive's list, so that no name can reach the file system.  Two parts whose names
differ by no more than that are ambiguous: programs would take different ones.
"""

from __future__ import annotations

import io
import lzma
import posixpath
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import IO, Self
from urllib.parse import unquote

from printprep.errors import InputError
from printprep.input_file import read_plain_file
from printprep.mislabelled import refuse_mislabelled
from printprep.wording import printable, shortened

# 512 MiB of XML hold five million triangles, as many as are read.  Real meshes deflate by a factor
# of up to 30; a part that inflates by far more, to a size that matters, is a zip bomb.
MODEL_BYTES_MAX = 512 << 20
RATIO_MAX = 150
RATIO_COUNTS_FROM_BYTES = 64 << 20
PARTS_MAX = 20_000
_AGAIN = "Download or export the file again."
SMALL_PART_BYTES_MAX = 8 << 20  # relationships and slicer configs, which are read as a whole

_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    OSError,
    NotImplementedError,  # a compression this Python does not know
    RuntimeError,  # an encrypted part
)


class Archive:
    """A zip, open for reading parts by name; a context manager.

    Raises InputError that names the file where it is not a zip, damaged, encrypted or a zip bomb.
    """

    def __init__(self, path: Path) -> None:
        self.name = path.name
        # Read as a whole: a zip on disk can change while it is read, bytes in memory cannot.
        content = read_plain_file(path)
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(content))
        except (*_DAMAGE, ValueError, struct.error) as error:
            refuse_mislabelled(content, ".3mf", self.name)
            raise InputError(
                f"{self.name} cannot be opened as a 3MF file: {shortened(str(error), 160)}.",
                "A 3MF is a zip archive: download or export it again.",
            ) from error
        entries = [
            entry
            for entry in self._zip.infolist()
            if entry.filename and not entry.filename.endswith("/")  # a folder, or no name at all
        ]
        if len(entries) > PARTS_MAX:
            raise InputError(f"{self.name} holds {len(entries)} parts, too many for a model.")
        self._entries: dict[str, zipfile.ZipInfo] = {}
        self._ambiguous: dict[str, str] = {}
        for entry in entries:
            other = self._entries.setdefault(_key(entry.filename), entry)
            if other is not entry:
                self._ambiguous[_key(entry.filename)] = f"{other.filename} and {entry.filename}"
        models = sum(entry.file_size for key, entry in self._entries.items() if _is_model(key))
        if models > MODEL_BYTES_MAX:
            raise InputError(
                f"{self.name}: its models unpack to {models / 2**20:.0f} MiB; at most "
                f"{MODEL_BYTES_MAX / 2**20:.0f} MiB are read.",
                "Reduce the number of triangles in a modelling program.",
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._zip.close()

    def __contains__(self, part: str) -> bool:
        return _key(part) in self._entries

    def with_suffix(self, suffix: str) -> tuple[str, ...]:
        """Names of the parts that end in `suffix`, sorted."""
        return tuple(sorted(key for key in self._entries if key.endswith(suffix)))

    @contextmanager
    def open(self, part: str) -> Iterator[IO[bytes]]:
        """A part as a stream; damage found while it is read is an InputError too."""
        entry = self._entries.get(_key(part))
        part = printable(part)
        if entry is None:
            raise InputError(f"{self.name}: the part {part} is missing.", _AGAIN)
        if _key(part) in self._ambiguous:
            raise InputError(
                f"{self.name} has two parts of one name, {printable(self._ambiguous[_key(part)])}: "
                "programs take different ones.",
                "Export the model again.",
            )
        size, packed = entry.file_size, max(entry.compress_size, 1)
        if size > MODEL_BYTES_MAX or (size > RATIO_COUNTS_FROM_BYTES and size > RATIO_MAX * packed):
            raise InputError(
                f"{self.name}: the part {part} unpacks to {size / 2**20:.0f} MiB, which is too "
                "large for a model."
            )
        try:
            stream = self._zip.open(entry)
        except (*_DAMAGE, ValueError, struct.error) as error:
            raise self._damaged(part, error) from error
        with stream:
            try:
                yield stream
            except _DAMAGE as error:
                raise self._damaged(part, error) from error

    def _damaged(self, part: str, error: Exception) -> InputError:
        fact = shortened(str(error), 160).rstrip(".") or type(error).__name__
        return InputError(f"{self.name}: the part {part} is damaged: {fact}.", _AGAIN)

    def read(self, part: str, limit_bytes: int = SMALL_PART_BYTES_MAX) -> bytes:
        """The content of a part; InputError where it is larger than `limit_bytes`."""
        with self.open(part) as stream:
            content = stream.read(limit_bytes + 1)
        if len(content) > limit_bytes:
            raise InputError(
                f"{self.name}: the part {printable(part)} is larger than {limit_bytes} bytes."
            )
        return content


def _is_model(key: str) -> bool:
    return key.endswith(".model")


def _key(part: str) -> str:
    plain = unquote(part).replace("\\", "/")
    return posixpath.normpath("/" + plain).lstrip("/").casefold()
