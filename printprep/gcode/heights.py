"""How wide and high beads are, from what comments say or, without them, from the layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.gcode.modal_state import Listener, State, numbers

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.gcode.paths import Stretches


class Heights:
    """Widths and heights of beads; a height nobody says is the layer's."""

    def __init__(self, listener: Listener) -> None:
        self._listener = listener
        self._top = 0.0
        self._height = math.nan

    def bead(self, made: Stretches, states: Sequence[State]) -> tuple[Float, Float]:
        """(n,) width, NaN where nobody says it, and (n,) height, mm."""
        width = np.array([state.width_mm for state in states])[made.state]
        height = np.array([state.height_mm for state in states])[made.state]
        unsaid = np.isnan(height)
        if unsaid.any():
            height[unsaid] = self._by_layer(made.end_mm[unsaid, 2])
        return width, height

    def _by_layer(self, z: Float) -> Float:
        """From the step between layers, the first one's from the bed."""
        starts = np.flatnonzero(np.abs(np.diff(z, prepend=np.nan_to_num(self._top))) > 1e-6)
        height = np.full(len(z), self._height)
        nominal = numbers(self._listener.settings, "Layer height")
        for start in starts.tolist():
            step = float(z[start]) - self._top
            self._top = float(z[start])
            self._height = step if step > 0 else self._top  # lower again: the next object
            if nominal and not math.isclose(self._top, self._height, abs_tol=1e-6):
                self._height = min(self._height, nominal[0])
            height[start:] = self._height
        return height
