"""Moves a body by physics (MuJoCo), step by step, on a bed that can lean."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.stand.scene import Scene, compiled

if TYPE_CHECKING:
    from printprep.arrays import Float

STEP_S = 0.001


class Motion:
    """One run of the physics engine, from rest.

    The bed stays fixed and gravity turns: the same motion, seen from the bed.
    """

    def __init__(self, scene: Scene, step_s: float = STEP_S) -> None:
        import mujoco

        self._mujoco = mujoco
        self._scene = scene
        self._model = compiled(scene, step_s)
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)

    def lean(self, lean_deg: float, azimuth_deg: float) -> None:
        """Lean the bed by an angle toward an azimuth (from +x counter-clockwise) from now on."""
        lean, azimuth = np.radians([lean_deg, azimuth_deg])
        along = np.array([np.cos(azimuth), np.sin(azimuth)]) * np.sin(lean)
        self._model.opt.gravity[:] = self._scene.gravity * np.array([*along, -np.cos(lean)])

    def advance(self, steps: int) -> None:
        """Simulate this many steps of time."""
        self._mujoco.mj_step(self._model, self._data, steps)

    @property
    def rotation(self) -> Float:
        """(3, 3) rotation of the body since the start."""
        return np.array(self._data.body("body").xmat).reshape(3, 3)

    @property
    def position_mm(self) -> Float:
        """(3,) present centre of mass of the body, in the coordinates of the part."""
        start = np.array([*self._scene.centre_mm[:2], 0.0])
        return start + np.array(self._data.qpos[:3]) * self._scene.unit_mm

    @property
    def rotation_deg(self) -> float:
        """Angle by which the body has turned, about any axis."""
        half = min(abs(float(self._data.qpos[3])), 1.0)
        return float(np.degrees(2 * np.arccos(half)))

    @property
    def tilt_deg(self) -> float:
        """Angle between the body's vertical and the bed's: turning on the spot does not count."""
        x, y = self._data.qpos[4:6]
        return float(np.degrees(2 * np.arcsin(min(float(np.hypot(x, y)), 1.0))))

    def state(self) -> Any:
        """Position and velocity, for ``resume``."""
        return self._data.qpos.copy(), self._data.qvel.copy(), self._data.qacc_warmstart.copy()

    def resume(self, state: Any) -> None:
        """Go back to an earlier state of this run."""
        self._data.qpos[:], self._data.qvel[:], self._data.qacc_warmstart[:] = state
        self._mujoco.mj_forward(self._model, self._data)
