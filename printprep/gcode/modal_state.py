"""Follows all lines of a G-code that are not moves: modes, tools, and comments of slicers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from printprep.gcode.features import UNLABELLED, feature_of

MM_PER_INCH = 25.4
_TOOLS_MAX = 64  # higher numbers are the pseudo tools of BambuStudio (T255, T1000)
_SETTINGS_MAX = 4096
_SETTING_BYTES_MAX = 1 << 16

_LABEL = re.compile(rb";\s*(TYPE|FEATURE|WIDTH|LINE_WIDTH|HEIGHT|LAYER_HEIGHT)\s*:\s*(.*)")
_SETTING = re.compile(rb";\s*([A-Za-z][\w \[\]().,/-]*?)\s*(?:=|:)\s+(.*)|;([A-Za-z ]+):(\S.*)")
_PRODUCER = re.compile(
    rb"(?:generated (?:by|with)|HEADER.*?)\s*((?:Prusa|Super|Orca|Bambu|Cura|Slic3r)\w*)[ _-]*"
    rb"(?:SteamEngine )?v?([\d.]+)?",
    re.IGNORECASE,
)
_ORCA_HEAD = re.compile(rb";\s*(BambuStudio|OrcaSlicer)\s+([\d.]+)")
_OBJECT = re.compile(
    rb";\s*printing object (.+)|EXCLUDE_OBJECT_START NAME=(\S+)|M486 S(\d+)", re.IGNORECASE
)
_OBJECTS_MAX = 1000
_NUMBER = re.compile(rb"[-+]?\d*\.?\d+")
_CODE = re.compile(rb"([GMT])0*(\d+)(?![\d.])", re.IGNORECASE)
_CENTRE = re.compile(rb"G0*9([01])\.1(?!\d)", re.IGNORECASE)
_VOLUMETRIC = re.compile(rb"[DS]\s*([\d.]+)", re.IGNORECASE)


@dataclass(frozen=True)
class ModalState:
    """The modes that give the following moves their meaning.

    unit_mm : mm per unit of the file;  relative, relative_e : axes and filament count from their
    present position;  absolute_centre : I and J are a position, not an offset from the start of the
    arc;  volumetric : E is mm³, not mm;  width_mm, height_mm : of beads, NaN where no comment gives
    them.
    """

    relative: bool = False
    relative_e: bool = False
    absolute_centre: bool = False
    unit_mm: float = 1.0
    volumetric: bool = False
    tool: int = 0
    feature: str = UNLABELLED
    width_mm: float = math.nan
    height_mm: float = math.nan


@dataclass
class StateTracker:
    """Follows the lines that are not moves; ``state`` holds after the last line read.

    settings : "key = value" comments, of which the last counts;  producer : the slicer;
    labelled : whether the file labels features;  objects : labels of the objects printed.
    """

    state: ModalState = field(default_factory=ModalState)
    settings: dict[str, str] = field(default_factory=dict)
    producer: str | None = None
    labelled: bool = False
    objects: set[str] = field(default_factory=set)

    def feed_all(
        self, lines: Iterable[tuple[int, bytes]]
    ) -> tuple[list[ModalState], list[int], list[int]]:
        """Read numbered lines: the states found, the lines that change it, and to which state.

        The first of the states is the one before these lines; the last result holds indices into
        the states.  A change seen before is looked up: slicers repeat a few labels thousands of
        times.
        """
        states, index = [self.state], {self.state: 0}
        known: dict[tuple[int, bytes], int] = {}
        current, at, became = 0, [], []
        for number, line in lines:
            following = known.get((current, line))
            if following is None:
                if not self.feed(line):
                    continue
                following = index.setdefault(self.state, len(states))
                if following == len(states):
                    states.append(self.state)
                known[current, line] = following
            current = following
            self.state = states[current]
            at.append(number)
            became.append(current)
        return states, at, became

    def feed(self, line: bytes) -> bool:
        """Read a line; True where it sets a mode."""
        if line.startswith(b";"):
            return self._comment(line)
        self._object(line)
        found = _CODE.match(line)
        if found is None:
            centre = _CENTRE.match(line)
            return centre is not None and self._become(absolute_centre=centre[1] == b"0")
        return self._code(found[1].upper(), int(found[2]), line[found.end() :].split(b";")[0])

    def _comment(self, line: bytes) -> bool:
        label = _LABEL.match(line)
        if label is None:
            self._note(line)
            return False
        kind, text = label[1], label[2].strip()
        if kind in (b"TYPE", b"FEATURE"):
            self.labelled = True
            return self._become(feature=feature_of(text.decode("utf-8", "replace")))
        number = _NUMBER.fullmatch(text)
        if number is None:
            return False
        value = float(text)
        if kind in (b"WIDTH", b"LINE_WIDTH"):
            return self._become(width_mm=value)
        return self._become(height_mm=value)

    def _object(self, line: bytes) -> None:
        found = _OBJECT.match(line)
        if found is not None and len(self.objects) < _OBJECTS_MAX:
            name = next(part for part in found.groups() if part)
            self.objects.add(name.decode("utf-8", "replace").strip())

    def _note(self, line: bytes) -> None:
        """Keep what a comment tells about the object, the slicer or a setting."""
        self._object(line)
        if self.producer is None:
            found = _PRODUCER.search(line) or _ORCA_HEAD.match(line)
            if found is not None:
                self.producer = b" ".join(part for part in found.groups() if part).decode("ascii")
        if len(line) > _SETTING_BYTES_MAX or len(self.settings) >= _SETTINGS_MAX:
            return
        found = _SETTING.match(line)
        if found is not None:
            key = (found[1] or found[3]).decode("ascii").strip()
            self.settings[key] = (found[2] or found[4] or b"").decode("utf-8", "replace").strip()

    def _code(self, letter: bytes, number: int, words: bytes) -> bool:
        if letter == b"T":
            return number < _TOOLS_MAX and self._become(tool=number)
        if letter == b"G":
            if number in (20, 21):
                return self._become(unit_mm=MM_PER_INCH if number == 20 else 1.0)
            return number in (90, 91) and self._become(relative=number == 91)
        if number in (82, 83):
            return self._become(relative_e=number == 83)
        if number == 200:  # RepRap: M200 D1.75 makes E volumetric, M200 D0 or S0 ends it
            sizes = [float(size) for size in _VOLUMETRIC.findall(words)]
            return self._become(volumetric=bool(sizes) and all(sizes))
        return False

    def _become(self, **changes: object) -> bool:
        before = self.state
        self.state = replace(before, **changes)  # type: ignore[arg-type]
        return True


def numbers(settings: Mapping[str, str], key: str) -> tuple[float, ...]:
    """The numbers of a setting, one for each extruder; empty where the file has none."""
    found = re.split(r"[,;]", settings.get(key, ""))
    values = [re.match(r"\s*([-+]?\d*\.?\d+)", text) for text in found]
    return tuple(float(value[1]) for value in values if value is not None)
