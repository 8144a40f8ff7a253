"""Measure each method's result on each model, and keep it in a file.

Each result has a file of its own, with the settings it depends on.  A result with the same settings
is not computed again, so an interrupted evaluation goes on where it stopped.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import OutputError
from printprep.evaluate.bodies import body_of
from printprep.evaluate.cases import Case
from printprep.evaluate.fidelity import Fidelity, fidelity
from printprep.evaluate.methods import Method
from printprep.evaluate.picture import Picture, Voxels, picture_of
from printprep.files import write_atomically
from printprep.generators.surface import surface_of
from printprep.paper.voxel_balance import tilt_deg
from printprep.stand.simulate import STANDS_BELOW_DEG
from printprep.version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMAT = 1  # of a result's file; other formats are not read
_DIGITS = 9  # of each figure: enough for any table, without the last bits of a sum


@dataclass(frozen=True)
class Measured:
    """One method on one model; the solid is O, the model's voxels without holes.

    mass : Mas, in the unit cube at unit density;  mass_ratio : to the mass of the solid.
    stands, rotation_deg : after ten simulated seconds;  tilt_deg : computed, negative where the
    body falls by itself;  f_score, chamfer : of its outside against the input.
    lean_deg : the lean asked for, None for a method without one;  reachable_deg : the largest lean
    of any filling where that is less.
    seconds : for the solution alone; the only figure that differs from run to run.
    """

    model: str
    method: str
    mass: float
    mass_ratio: float
    stands: bool
    rotation_deg: float
    tilt_deg: float
    f_score: float
    chamfer: float
    lean_deg: float | None
    reachable_deg: float | None
    seconds: float


def evaluate_case(
    case: Case, chosen: Sequence[Method], folder: Path, voxels: Voxels
) -> tuple[Measured, ...]:
    """Measure all methods on one model; each result is read from ``folder``, or written there.

    Raises
    ------
    InputError, GeometryError : the model cannot be read, or encloses no voxel.
    OutputError : the folder cannot be written to.
    """
    described = [_settings(case, method, voxels) for method in chosen]
    files = [folder / case.name / f"{method.name}.json" for method in chosen]
    kept = [_kept(file, settings) for file, settings in zip(files, described, strict=True)]
    if all(kept):
        return tuple(one for one in kept if one is not None)
    bench: dict[int, _Bench] = {}  # by resolution
    found = []
    for method, settings, file, known in zip(chosen, described, files, kept, strict=True):
        if known is None:
            resolution = method.settings.resolution
            if resolution not in bench:
                bench[resolution] = _Bench(picture_of(case.path, case.up, resolution, voxels))
            known = bench[resolution].measure(case.name, method)
            _keep(file, settings, known)
        found.append(known)
    return tuple(found)


class _Bench:
    """One model's voxels, and the fidelity of every outside measured so far."""

    def __init__(self, picture: Picture) -> None:
        self._picture = picture
        self._known: dict[bytes, Fidelity] = {}

    def measure(self, model: str, method: Method) -> Measured:
        """Run a method, and measure its result."""
        from printprep.evaluate.drop import final_rotation_deg

        _warm_up(method)
        start = time.perf_counter()
        body = body_of(self._picture.occupied, method, self._picture.frozen)
        seconds = time.perf_counter() - start
        mass = float(body.weight.sum())
        rotation = final_rotation_deg(body.weight, body.ground)
        close = self._fidelity(body.outside)
        return Measured(
            model=model,
            method=method.name,
            mass=_rounded(mass / body.weight.size),
            mass_ratio=_rounded(mass / np.count_nonzero(body.solid)),
            stands=rotation < STANDS_BELOW_DEG,
            rotation_deg=_rounded(rotation),
            tilt_deg=_rounded(tilt_deg(body.weight, body.ground)),
            f_score=_rounded(close.f_score),
            chamfer=_rounded(close.chamfer),
            lean_deg=None if body.lean_deg is None else _rounded(body.lean_deg),
            reachable_deg=None if body.reachable_deg is None else _rounded(body.reachable_deg),
            seconds=round(seconds, 4),
        )

    def _fidelity(self, outside: NDArray[np.bool_]) -> Fidelity:
        """The fidelity of an outside (N, N, N) bool to the model."""
        key = np.packbits(outside).tobytes()
        if key not in self._known:
            surface = surface_of(outside)
            target = (self._picture.vertices, self._picture.faces)
            self._known[key] = fidelity((surface.vertices, surface.faces), target)
        return self._known[key]


_warm: set[tuple[str, str]] = set()


def _warm_up(method: Method) -> None:
    """Import what a method needs before its time counts, once in a process."""
    if (method.kind, method.solver) not in _warm:
        _warm.add((method.kind, method.solver))
        short = replace(method, settings=replace(method.settings, resolution=6, steps=1))
        block = np.zeros((6, 6, 6), dtype=bool)
        block[1:5, 1:5, 1:5] = True
        body_of(block, short)


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _settings(case: Case, method: Method, voxels: Voxels) -> dict[str, Any]:
    """All that a result depends on, as JSON holds it."""
    data = b""
    with suppress(OSError):  # reading it as a mesh reports the error
        data = case.path.read_bytes()
    settings = {
        "format": FORMAT,
        "printprep": __version__,
        "model_sha256": hashlib.sha256(data).hexdigest(),
        "up": case.up,
        "voxels": voxels,
        "method": method.described(),
    }
    reloaded: dict[str, Any] = json.loads(json.dumps(settings))
    return reloaded


def _kept(file: Path, settings: dict[str, Any]) -> Measured | None:
    """The result in a file, or None when it is damaged or has other settings."""
    try:
        stored = json.loads(file.read_text(encoding="utf-8"))
    except (FileNotFoundError, json.JSONDecodeError, UnicodeDecodeError):
        return None
    if not isinstance(stored, dict) or stored.get("settings") != settings:
        return None
    return Measured(**stored["result"])


def _keep(file: Path, settings: dict[str, Any], result: Measured) -> None:
    """Write a result with its settings."""
    make_folder(file.parent)
    text = json.dumps({"settings": settings, "result": asdict(result)}, indent=1, allow_nan=False)
    write_atomically(file, (text + "\n").encode("utf-8"))


def make_folder(path: Path) -> None:
    """Create a folder and those above it; OutputError when that fails."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be created: {error.strerror or type(error).__name__}.",
            "Choose another folder with --output.",
        ) from error
