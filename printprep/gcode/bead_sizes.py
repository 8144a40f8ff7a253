"""Widths and heights of beads, from comments or, without them, from the distance of layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.gcode.modal_state import ModalState, StateTracker, numbers

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.gcode.paths import Stretches


class BeadSizes:
    """Widths and heights of beads; a height that no comment gives is that of the layer."""

    def __init__(self, tracker: StateTracker) -> None:
        self._tracker = tracker
        self._top = 0.0
        self._height = math.nan

    def of(self, made: Stretches, states: Sequence[ModalState]) -> tuple[Float, Float]:
        """(n,) widths, NaN where no comment gives them, and (n,) heights of stretches, mm."""
        width = np.array([state.width_mm for state in states])[made.state]
        height = np.array([state.height_mm for state in states])[made.state]
        missing = np.isnan(height)
        if missing.any():
            height[missing] = self._by_layer(made.end_mm[missing, 2])
        return width, height

    def _by_layer(self, z: Float) -> Float:
        """(k,) mm, heights of beads with tops z (k,): the step from the layer below or the bed."""
        starts = np.flatnonzero(np.abs(np.diff(z, prepend=np.nan_to_num(self._top))) > 1e-6)
        height = np.full(len(z), self._height)
        nominal = numbers(self._tracker.settings, "Layer height")
        for start in starts.tolist():
            step = float(z[start]) - self._top
            self._top = float(z[start])
            self._height = step if step > 0 else self._top  # lower than before: the next object
            if nominal and not math.isclose(self._top, self._height, abs_tol=1e-6):
                self._height = min(self._height, nominal[0])
            height[start:] = self._height
        return height
