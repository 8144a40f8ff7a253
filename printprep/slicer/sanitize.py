"""Strips the files that a slicer loads of post_process, the one key that makes it run commands.

PrusaSlicer's post_process holds shell commands.  It stands in .ini files, in the comments at the
end of a G-code, and in the print config inside a 3MF.
"""

from __future__ import annotations

import re
import shutil
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from printprep.errors import InputError, UsageError

_LINE = re.compile(rb"^[;#\s]*post_process\s*=")
_CONFIG_SUFFIXES = (".config", ".ini", ".xml")
_CONFIG_BYTES_MAX = 64 << 20


def settings_ini(settings: Mapping[str, str]) -> str:
    """Settings as the text of an .ini, keys sorted.

    Raises UsageError for post_process, and for keys or values that would add further lines.
    """
    lines = []
    for key in sorted(settings):
        value = settings[key]
        if key == "post_process":
            raise UsageError("post_process is not passed on to a slicer: it runs commands.")
        if not re.fullmatch(r"[a-z][a-z0-9_]*", key) or re.search(r"[\x00-\x1f\x7f]", value):
            raise UsageError(f"{key!r} = {value!r} is not a setting of a slicer.")
        lines.append(f"{key} = {value}\n")
    return "".join(lines)


def without_commands(file: Path, folder: Path) -> Path:
    """`file` itself where it cannot carry commands, else a copy in `folder` without them.

    The copy has the suffix by which a slicer knows the format; a G-code under its temporary name
    (.gcode.pp) becomes a .gcode.  Raises InputError where the file cannot be read.
    """
    suffix = file.suffix.lower()
    try:
        if suffix in (".stl", ".obj"):
            return file
        if suffix == ".3mf":
            return _clean_3mf(file, folder / f"loaded-{file.name}")
        target = folder / ("loaded.ini" if suffix == ".ini" else "loaded.gcode")
        with file.open("rb") as source, target.open("wb") as sink:
            sink.writelines(line for line in source if not _LINE.match(line))
        return target
    except (OSError, zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError) as error:
        raise InputError(f"{file.name} cannot be read: {error}.") from error


def _clean_3mf(file: Path, target: Path) -> Path:
    with zipfile.ZipFile(file) as source:
        dirty = {}
        for entry in source.infolist():
            if entry.filename.lower().endswith(_CONFIG_SUFFIXES):
                if entry.file_size > _CONFIG_BYTES_MAX:
                    raise InputError(
                        f"{file.name} holds {entry.filename}, which is too large for a config."
                    )
                content = source.read(entry)
                if b"post_process" in content:
                    dirty[entry.filename] = content
        if not dirty:
            return file
        with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as sink:
            for entry in source.infolist():
                if entry.filename in dirty:
                    sink.writestr(entry.filename, _without_key(dirty[entry.filename]))
                else:
                    with source.open(entry) as part, sink.open(entry.filename, "w") as copy:
                        shutil.copyfileobj(part, copy)
    return target


def _without_key(config: bytes) -> bytes:
    lines = [line for line in config.splitlines(keepends=True) if not _LINE.match(line)]
    return re.sub(rb"<metadata\b[^>]*\bpost_process\b[^>]*/>", b"", b"".join(lines))
