"""Parts of a zip that a stranger made: looked up, never extracted, never larger than agreed.

Part names are compared as OPC asks (without regard to case, leading slash, or dot segments) and
only ever looked up in the archive's own list, so that no name can reach the file system.
"""

from __future__ import annotations

import io
import lzma
import posixpath
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import IO, Self
from urllib.parse import unquote

from printprep.errors import InputError

# A model part of 1 GiB holds some ten million triangles.  Meshes were seen to deflate by up to 30;
# a part that inflates more than that by far, and to a size that matters, is a bomb.
PART_BYTES_MAX = 1 << 30
RATIO_MAX = 150
RATIO_COUNTS_FROM_BYTES = 64 << 20
PARTS_MAX = 20_000
SMALL_PART_BYTES_MAX = 8 << 20  # relationships and slicer configs, which are held as a whole

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
    """A zip opened for reading parts by name; use it as a context manager.

    Raises InputError that names the file where it is no zip, damaged, encrypted or a bomb.
    """

    def __init__(self, path: Path) -> None:
        self.name = path.name
        try:
            # read whole: a zip on disk can change under the reader, bytes in memory cannot
            self._zip = zipfile.ZipFile(io.BytesIO(path.read_bytes()))
        except _DAMAGE as error:
            raise InputError(
                f"{self.name}: not a 3MF file that can be opened ({error})",
                "a 3MF is a zip archive; download or export it again",
            ) from error
        entries = [entry for entry in self._zip.infolist() if not entry.is_dir()]
        if len(entries) > PARTS_MAX:
            raise InputError(f"{self.name}: holds {len(entries)} parts, too many to be a model")
        self._entries = {_key(entry.filename): entry for entry in reversed(entries)}

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
        """A part as a stream; damage met while it is read is an InputError too."""
        entry = self._entries.get(_key(part))
        if entry is None:
            raise InputError(f"{self.name}: the part {part} is missing")
        size, packed = entry.file_size, max(entry.compress_size, 1)
        if size > PART_BYTES_MAX or (size > RATIO_COUNTS_FROM_BYTES and size > RATIO_MAX * packed):
            raise InputError(
                f"{self.name}: the part {part} unpacks to {size / 2**20:.0f} MiB, refused"
            )
        try:
            with self._zip.open(entry) as stream:
                yield stream
        except _DAMAGE as error:
            raise InputError(f"{self.name}: the part {part} is damaged ({error})") from error

    def read(self, part: str, limit_bytes: int = SMALL_PART_BYTES_MAX) -> bytes:
        """A whole part; InputError where it is larger than `limit_bytes`."""
        with self.open(part) as stream:
            content = stream.read(limit_bytes + 1)
        if len(content) > limit_bytes:
            raise InputError(f"{self.name}: the part {part} is larger than {limit_bytes} bytes")
        return content


def _key(part: str) -> str:
    plain = unquote(part).replace("\\", "/")
    return posixpath.normpath("/" + plain).lstrip("/").casefold()
