"""Turns rows of G-code words into straight stretches of deposited filament, in machine mm.

It follows the rows as a firmware does: absolute and relative axes (G90, G91) and filament (M82,
M83; G91 makes the filament relative too, as PrusaSlicer reads it), new origins (G92: the head does
not move), and arcs (G2, G3) by radius or by centre, which is relative (G91.1) except after G90.1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs
from printprep.errors import InputError
from printprep.gcode.lexer import HOME, SET, E, I, J, R, Rows, X, Y, Z

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int
    from printprep.gcode.modal_state import ModalState


_REACH_MM = 1e5  # no printer is larger than 100 m
_FILAMENT_MAX = 1e9  # mm or mm³: a tonne of filament
_CHORDS_MAX = 1 << 18  # made of arcs at a time, so that memory stays bounded for any file
_TURN_DEG = 5.0  # an arc becomes chords of at most this turn: sagitta 0.1 % of the radius


@dataclass(frozen=True, eq=False)
class Stretches:
    """Straight stretches in the order of printing.

    start_mm, end_mm : (n, 3) of the nozzle;  filament : (n,) positive, mm or, where volumetric,
    mm³;  state : (n,) index into the states given.
    """

    start_mm: Float
    end_mm: Float
    filament: Float
    state: Int


class Walker:
    """Keeps the position of the head and the filament from one piece of a file to the next."""

    def __init__(self, name: str) -> None:
        """name : of the file, for errors."""
        self._name = name
        self._at = np.zeros(4)  # x, y, z, e in the file's coordinates, mm
        self._origin = np.zeros(3)  # sum of all G92: machine = file + origin

    def walk(
        self, rows: Rows, state_of_row: Int, states: Sequence[ModalState], first_line: int
    ) -> Iterator[Stretches]:
        """The stretches that a piece of the file deposits, in one or more parts.

        state_of_row : (n,) for each row the index of its state in ``states``;  first_line : number
        of the piece's first line, for errors.

        Raises InputError for a place or an arc that no printer reaches.
        """
        n = len(rows.kind)
        if n == 0:
            return
        words = self._in_mm(rows, state_of_row, states)
        relative = np.array([state.relative for state in states])[state_of_row]
        relative_e = np.array([state.relative_e for state in states])[state_of_row] | relative
        sets = (rows.kind == SET) | (rows.kind == HOME)
        after = np.empty((n, 4))  # the loop below writes every column
        for axis, counts in ((X, relative), (Y, relative), (Z, relative), (E, relative_e)):
            after[:, axis] = _follow(words[:, axis], counts & ~sets, self._at[axis])
        before = np.vstack([self._at, after[:-1]])
        origins = self._origins(rows.kind, before, after)
        self._at = after[-1].copy()
        start, end = before[:, :3] + origins, after[:, :3] + origins
        in_reach = (np.abs(end) <= _REACH_MM).all(axis=1) & (np.abs(after[:, E]) <= _FILAMENT_MAX)
        in_reach &= ~(np.abs(words[:, [I, J, R]]) > _REACH_MM).any(axis=1)
        if not in_reach.all():
            line = first_line + int(rows.line[np.argmin(in_reach)])
            raise InputError(
                f"{self._name}, line {line}: it moves beyond {_REACH_MM / 1000:g} m, farther than "
                "any printer reaches.",
                "Slice the model again.",
            )
        filament = np.where(sets, 0.0, after[:, E] - before[:, E])
        arc = (rows.kind == 2) | (rows.kind == 3)
        across = (start[:, :2] != end[:, :2]).any(axis=1) | arc
        kept = np.flatnonzero((filament > 0) & across)
        made = Stretches(start[kept], end[kept], filament[kept], state_of_row[kept])
        if not len(kept):
            return
        if not arc[kept].any():
            yield made
            return
        placed = np.array([state.absolute_centre for state in states])[state_of_row][kept]
        words, before = words[kept], before[kept]
        words[placed, I] -= before[placed, X]  # both in the file's coordinates
        words[placed, J] -= before[placed, Y]
        yield from _straightened(made, rows.kind[kept], words)

    def _in_mm(self, rows: Rows, state_of_row: Int, states: Sequence[ModalState]) -> Float:
        """(n, 7) words in mm (E in mm³ where volumetric); a bare G92 or G28 sets all axes to 0."""
        words = rows.words.copy()
        unit = np.array([state.unit_mm for state in states])[state_of_row]
        if (unit != 1.0).any():
            volumetric = np.array([state.volumetric for state in states])[state_of_row]
            scale = np.repeat(unit[:, None], words.shape[1], axis=1)
            scale[volumetric, E] = 1.0
            words *= scale
        for code, axes in ((SET, [X, Y, Z, E]), (HOME, [X, Y, Z])):
            bare = (rows.kind == code) & np.isnan(words[:, axes]).all(axis=1)
            words[np.ix_(bare, axes)] = 0.0
        return words

    def _origins(self, kind: Int, before: Float, after: Float) -> Float:
        """(n, 3) or (1, 3) mm, machine position of the file's origin at each row.

        kind : (n,);  before, after : (n, 4) position in the file's coordinates.
        """
        moved = np.where((kind == SET)[:, None], before[:, :3] - after[:, :3], 0.0)
        if not moved.any():
            return self._origin[None, :]
        origins: Float = self._origin + np.cumsum(moved, axis=0)
        self._origin = origins[-1].copy()
        return origins


def _follow(value: Float, relative: Bool, start: float) -> Float:
    """(n,) position of an axis after each row: absolute words set it, relative ones add to it.

    value : (n,) words, NaN for none;  relative : (n,);  start : position before the first row.
    """
    given = ~np.isnan(value)
    last = np.maximum.accumulate(np.where(given & ~relative, np.arange(len(value)), -1))
    after = np.where(last >= 0, value[last], start)
    if (given & relative).any():
        way = np.cumsum(np.where(given & relative, value, 0.0))
        after = after + way - np.where(last >= 0, way[last], 0.0)
    return after


def _straightened(made: Stretches, kind: Int, words: Float) -> Iterator[Stretches]:
    """The same stretches with each arc as chords, its filament spread evenly over the angle.

    kind : (n,) G number;  words : (n, 7) mm.
    """
    arc = kind >= 2
    centre = np.zeros((len(kind), 2))
    turn = np.zeros(len(kind))
    centre[arc], turn[arc] = _arcs(made.start_mm[arc], made.end_mm[arc], kind[arc] == 2, words[arc])
    pieces = np.ones(len(kind), dtype=np.int64)
    pieces[arc] = np.maximum(1, np.ceil(np.abs(turn[arc]) / np.radians(_TURN_DEG))).astype(np.int64)
    parts = np.flatnonzero(np.diff(np.cumsum(pieces) // _CHORDS_MAX, prepend=0))
    for some in np.split(np.arange(len(kind)), parts):
        if not len(some):
            continue
        owner, step = runs(pieces[some])
        owner = some[owner]
        bent = arc[owner]
        from_centre = made.start_mm[owner[bent], :2] - centre[owner[bent]]
        ends = []
        for shift in (0, 1):
            share = (step + shift) / pieces[owner]
            point = made.start_mm[owner] + share[:, None] * (made.end_mm - made.start_mm)[owner]
            angle = turn[owner[bent]] * share[bent]
            cos, sin = np.cos(angle), np.sin(angle)
            x, y = from_centre.T
            around = np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
            point[bent, :2] = centre[owner[bent]] + around
            ends.append(point)
        yield Stretches(ends[0], ends[1], (made.filament / pieces)[owner], made.state[owner])


def _arcs(start: Float, end: Float, clockwise: Bool, words: Float) -> tuple[Float, Float]:
    """(n, 2) mm, centres of arcs, and (n,) their turns in radians, counter-clockwise positive.

    start, end : (n, 3) mm;  clockwise : (n,);  words : (n, 7) mm.  With R, the centre lies on the
    chord's normal, on the side that makes the turn less than 180° for R > 0 and more for R < 0.
    Where the chord is longer than 2 |R|, it counts as the diameter.
    """
    a, b = start[:, :2], end[:, :2]
    centre = a + np.nan_to_num(words[:, [I, J]])
    radius = words[:, R]
    by_radius = ~np.isnan(radius)
    if by_radius.any():
        chord = b - a
        length = np.linalg.norm(chord, axis=1)
        rise = np.sqrt(np.maximum(radius**2 - (length / 2) ** 2, 0.0))
        side = np.where(clockwise, -1.0, 1.0) * np.where(radius < 0, -1.0, 1.0)
        normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1) / np.maximum(length, 1e-12)[:, None]
        centre = np.where(by_radius[:, None], (a + b) / 2 + (side * rise)[:, None] * normal, centre)
    u, v = a - centre, b - centre
    turn = np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], np.einsum("ij,ij->i", u, v))
    whole = np.linalg.norm(b - a, axis=1) < 1e-6
    turn = np.where(clockwise, -(-turn % (2 * np.pi)), turn % (2 * np.pi))
    return centre, np.where(whole, np.where(clockwise, -2 * np.pi, 2 * np.pi), turn)
