"""Strips the files that a slicer loads of post_process, the one key that makes it run commands.

PrusaSlicer's post_process holds shell commands.  It stands in .ini files, in the comments at the
end of a G-code, and in the print config inside a 3MF.
"""

from __future__ import annotations

import re
import shutil
import stat
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path

from printprep.bgcode.blocks import MAGIC, is_binary
from printprep.bgcode.content import settings_of
from printprep.errors import InputError, UsageError
from printprep.files import reason_of
from printprep.threemf.plate import plate_text

_LINE = re.compile(rb"^[;#\s]*post_process\s*=")
_SLICED_PROJECT = ".gcode.3mf"
_KEY = re.compile(r"[a-z][a-z0-9_]*")
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")
_DENSITY = re.compile(rb"[;\s]*filament_density\s*=\s*([\d.,\s]+)")
_VALUE_BYTES = 256
_LINE_BYTES_MAX = 16 << 20
_PIECE_BYTES = 1 << 20
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
        if not _KEY.fullmatch(key) or _CONTROL.search(value):
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
        if suffix == ".3mf" and not _is_sliced(file):
            return _clean_3mf(file, folder / f"loaded-{file.name}")
        settings_only = suffix == ".ini" or _is_binary(file)
        target = folder / ("loaded.ini" if settings_only else "loaded.gcode")
        with target.open("wb") as sink:
            sink.writelines(line for line in _config_lines(file) if not _LINE.match(line))
        return target
    except (OSError, zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError) as error:
        raise InputError(f"{file.name} cannot be read: {error}.") from error


def sets_density(file: Path) -> bool:
    """Whether an .ini or a G-code sets the density of the filament, above 0.

    Raises InputError where it cannot be read.
    """
    try:
        found = (_DENSITY.match(line) for line in _config_lines(file))
        return any(match is not None and _has_positive(match[1]) for match in found)
    except OSError as error:
        raise InputError(f"{file} cannot be read: {reason_of(error)}.") from error


def _config_lines(file: Path) -> Iterator[bytes]:
    """The lines of an .ini, of G-code text or of the plate of a sliced project; or those that the
    settings of a binary G-code are in an .ini.

    Raises OSError, and InputError where it is damaged or has a line of more than 16 MiB.
    """
    if not stat.S_ISREG(file.stat().st_mode):
        raise InputError(f"{file} is not a plain file.", "Name an .ini or a G-code file.")
    with file.open("rb") as source:
        if _is_sliced(file):
            pieces = plate_text(source, file.name)
        elif _is_binary(file):
            pieces = iter([_as_ini(settings_of(source, file.name))])
        else:
            pieces = iter(lambda: source.read(_PIECE_BYTES), b"")
        rest = b""
        for piece in pieces:
            *lines, rest = (rest + piece).split(b"\n")
            yield from (line + b"\n" for line in lines)
            if len(rest) > _LINE_BYTES_MAX:
                raise InputError(
                    f"{file.name} has a line of more than {_LINE_BYTES_MAX >> 20} MiB: it is "
                    "neither an .ini nor G-code."
                )
        if rest:
            yield rest


def _is_sliced(file: Path) -> bool:
    return file.name.lower().endswith(_SLICED_PROJECT)


def _is_binary(file: Path) -> bool:
    with file.open("rb") as source:
        return is_binary(source.read(len(MAGIC)))


def _has_positive(values: bytes) -> bool:
    return any(float(value) > 0 for value in re.findall(rb"\d+\.?\d*|\.\d+", values[:_VALUE_BYTES]))


def _as_ini(settings: Mapping[str, str]) -> bytes:
    """Settings that a file carries, without post_process and what is no key, as text of an .ini."""
    lines = [
        f"{key} = {value}\n"
        for key, value in settings.items()
        if key != "post_process" and _KEY.fullmatch(key) and _CONTROL.search(value) is None
    ]
    return "".join(lines).encode("utf-8")


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
