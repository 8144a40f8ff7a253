"""Finds PrusaSlicer, asks it about a model, and slices with it, as a child process.

Every call empties --post-process, and every loaded file is stripped of that key first: an .ini, a
G-code or a 3MF can carry commands, and some versions run them without asking.  Every call has a
time limit, a closed standard input and a settings folder of its own, so that neither a question
nor the user's settings change the result.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from printprep.errors import InputError, OutputError, ToolError
from printprep.files import reason_of, replacing, scratch_folder
from printprep.slicer.child import INSTALL_HINT, SLICER_VARIABLE, last_lines, run_child
from printprep.slicer.sanitize import settings_ini, without_commands
from printprep.wording import printable

_ON_PATH = ("prusa-slicer", "prusa-slicer-console", "PrusaSlicer", "prusaslicer")
_IN_APP = Path("Contents", "MacOS", "PrusaSlicer")
_VERSION = re.compile(r"^(\w*Slicer)-(\d+)\.(\d+)\.(\d+)", re.MULTILINE)
_ASK_SECONDS = 30.0
_COPY_BYTES = 1 << 20
_WARNINGS_MAX, _WARNING_MAX = 100, 300  # how many are kept, and characters of each


@dataclass(frozen=True)
class ModelInfo:
    """What the slicer reports about a model, summed over the objects of the file.

    parts : number of shells (an inverted cavity shell is one);  size_mm : (x, y, z) of the whole.
    """

    manifold: bool
    parts: int
    volume_mm3: float
    size_mm: tuple[float, float, float]


@dataclass(frozen=True)
class Sliced:
    """A finished G-code and the slicer's warnings."""

    gcode: Path
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Slicer:
    """A PrusaSlicer that runs on this machine; version as (major, minor, patch)."""

    executable: Path
    name: str
    version: tuple[int, int, int]

    def info(self, file: Path, *, timeout_seconds: float = 120.0) -> ModelInfo:
        """Ask about a model (STL, OBJ, 3MF).  Raises ToolError where the slicer cannot load it."""
        with scratch_folder() as folder:
            safe = _model(file, folder)
            done = run_child(self.executable, ["--info", str(safe)], folder, timeout_seconds)
        return _parse_info(done.stdout, file)

    def slice(
        self,
        file: Path,
        out_gcode: Path,
        settings: Mapping[str, str] | None = None,
        load: Path | None = None,
        *,
        timeout_seconds: float = 1800.0,
    ) -> Sliced:
        """Slice `file` without moving it on the bed, into `out_gcode`, replaced only when complete.

        load : .ini or G-code with print settings;  settings : keys that override them.  The
        settings of an object in a 3MF override both.

        Raises ToolError where the slicer fails, takes too long, or exits with 0 and no G-code;
        OutputError where `out_gcode` cannot be written.
        """
        with scratch_folder() as folder:
            made = folder / "sliced.gcode"
            arguments = ["--export-gcode", "--dont-arrange", "--output", str(made)]
            if self.version >= (2, 4, 0):  # else a bad value is replaced without a warning
                arguments += ["--config-compatibility", "disable"]
            if load is not None:
                arguments += ["--load", str(without_commands(load, folder))]
            if settings:
                own = folder / "settings.ini"
                own.write_text(settings_ini(settings), encoding="utf-8")
                arguments += ["--load", str(own)]
            arguments.append(str(_model(file, folder)))
            done = run_child(self.executable, arguments, folder, timeout_seconds)
            if not made.is_file() or made.stat().st_size == 0:
                raise ToolError(
                    f"{self.name} ended without an error, but wrote no G-code of {file.name}.",
                    last_lines(done) or "Slice it by hand once, to see the slicer's questions.",
                )
            try:
                with made.open("rb") as source, replacing(out_gcode) as out:
                    shutil.copyfileobj(source, out, _COPY_BYTES)
            except OSError as error:
                raise OutputError(f"{out_gcode} cannot be written: {reason_of(error)}.") from error
        return Sliced(out_gcode, _warnings(done.stdout + done.stderr))


def find_slicer(path: Path | None = None) -> Slicer:
    """The slicer at `path`, or the one installed.  Raises ToolError that says how to get one.

    Without `path` it is the one in the variable PRINTPREP_SLICER, on the search path, or in the
    usual places of macOS and Windows, in this order.
    """
    if path is None and os.environ.get(SLICER_VARIABLE):
        path = Path(os.environ[SLICER_VARIABLE])
    if path is not None:
        if path.is_dir() and (path / _IN_APP).is_file():
            path = path / _IN_APP
        found = shutil.which(str(path))
        if found is None:
            raise ToolError(f"There is no program {path}.", INSTALL_HINT)
        return _identified(_console(Path(found)))
    for name in _ON_PATH:
        found = shutil.which(name)
        if found is not None:
            return _identified(_console(Path(found)))
    for place in _usual_places():
        if place.is_file():
            return _identified(place)
    raise ToolError("PrusaSlicer was not found.", INSTALL_HINT)


def slicer_if_any(path: Path | None = None) -> Slicer | None:
    """The slicer at a path, or one that is found; None where none is found.

    Raises ToolError where a slicer that was named does not answer.
    """
    try:
        return find_slicer(path)
    except ToolError:
        if path is not None or os.environ.get(SLICER_VARIABLE):
            raise
        return None


def _usual_places() -> list[Path]:
    if sys.platform == "darwin":
        roots = [Path("/Applications"), Path.home() / "Applications"]
        folders = [folder for root in roots for folder in (root, root / "Original Prusa Drivers")]
        return [folder / "PrusaSlicer.app" / _IN_APP for folder in folders]
    if sys.platform == "win32":
        roots = [
            Path(os.environ[key]) for key in ("ProgramW6432", "ProgramFiles") if key in os.environ
        ]
        return [root / "Prusa3D" / "PrusaSlicer" / "prusa-slicer-console.exe" for root in roots]
    return []


def _console(path: Path) -> Path:
    """On Windows the console program beside the one with a window, which prints no output."""
    beside = path.with_name("prusa-slicer-console.exe")
    return beside if path.name.lower() == "prusa-slicer.exe" and beside.is_file() else path


def _identified(path: Path) -> Slicer:
    """The slicer at a path, with the name and version that its help prints."""
    with scratch_folder() as folder:
        done = run_child(path, ["--help"], folder, _ASK_SECONDS)
    match = _VERSION.search(done.stdout)
    if match is None:
        raise ToolError(f"{path} is not PrusaSlicer: its --help names no version.", INSTALL_HINT)
    name, *numbers = match.groups()
    major, minor, patch = (int(number) for number in numbers)
    return Slicer(path, f"{name} {major}.{minor}.{patch}", (major, minor, patch))


def _model(file: Path, folder: Path) -> Path:
    if not file.is_file():
        raise InputError(f"{file} does not exist.", "Check the name and the folder.")
    if file.suffix.lower() not in (".3mf", ".stl", ".obj"):
        raise InputError(
            f"{file.name} is not a model for a slicer: its suffix is {file.suffix or 'missing'}.",
            "Use 3MF, STL or OBJ.",
        )
    # An absolute path never begins with a dash, so that no name is taken for an option.
    return without_commands(file.absolute(), folder)


def _parse_info(text: str, file: Path) -> ModelInfo:
    blocks: dict[str, list[str]] = {}
    for key, value in re.findall(r"^(\w+) *= *(\S+)\s*$", text, re.MULTILINE):
        blocks.setdefault(key, []).append(value)
    try:
        low = [min(map(float, blocks[f"min_{axis}"])) for axis in "xyz"]
        high = [max(map(float, blocks[f"max_{axis}"])) for axis in "xyz"]
        x, y, z = (above - below for below, above in zip(low, high, strict=True))
        return ModelInfo(
            all(value == "yes" for value in blocks["manifold"]),
            sum(map(int, blocks["number_of_parts"])),
            sum(map(float, blocks["volume"])),
            (x, y, z),
        )
    except (KeyError, ValueError) as error:
        raise ToolError(f"The slicer's report on {file.name} cannot be read.") from error


def _warnings(text: str) -> tuple[str, ...]:
    lines = [printable(line[:_WARNING_MAX]).strip() for line in text.splitlines()]
    warnings = [line for line in lines if re.search(r"\bwarning\b", line, re.IGNORECASE)]
    return tuple(dict.fromkeys(warnings))[:_WARNINGS_MAX]
