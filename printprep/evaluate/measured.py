"""What is measured of each method's result on each model, and where it is kept.

A result lives in a file of its own beside the settings it depends on; one that is there with the
same settings is not computed again, so an evaluation goes on where it was interrupted.
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

FORMAT = 1  # of a result's file; another one is not read
_DIGITS = 9  # kept: enough for any table, and free of the last bits of a sum


@dataclass(frozen=True)
class Measured:
    """One method on one model; the solid is O, the model's voxels without holes.

    mass : Mas, in the unit cube at unit density;  mass_ratio : to the solid's.
    stands, rotation_deg : after ten simulated seconds;  tilt_deg : computed, negative where the
    body falls by itself;  f_score, chamfer : of its outside against the input.
    lean_deg : asked for, None for a method without;  reachable_deg : the largest there is where
    that is less.
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
    """All methods on one model, each read from ``folder`` where it is there, else put there.

    Raises
    ------
    InputError, GeometryError : the model cannot be read, or encloses no voxel.
    OutputError : the folder refuses.
    """
    described = [_settings(case, method, voxels) for method in chosen]
    files = [folder / case.name / f"{method.name}.json" for method in chosen]
    kept = [_kept(file, settings) for file, settings in zip(files, described, strict=True)]
    if all(kept):
        return tuple(one for one in kept if one is not None)
    bench: dict[int, _Bench] = {}
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
    """One model's picture, and the fidelity of every outside that came up."""

    def __init__(self, picture: Picture) -> None:
        self._picture = picture
        self._known: dict[bytes, Fidelity] = {}

    def measure(self, model: str, method: Method) -> Measured:
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
        key = np.packbits(outside).tobytes()
        if key not in self._known:
            surface = surface_of(outside)
            target = (self._picture.vertices, self._picture.faces)
            self._known[key] = fidelity((surface.vertices, surface.faces), target)
        return self._known[key]


_warm: set[tuple[str, str]] = set()


def _warm_up(method: Method) -> None:
    """Import what a method needs before its clock runs, once a process."""
    if (method.kind, method.solver) not in _warm:
        _warm.add((method.kind, method.solver))
        short = replace(method, settings=replace(method.settings, resolution=6, steps=1))
        block = np.zeros((6, 6, 6), dtype=bool)
        block[1:5, 1:5, 1:5] = True
        body_of(block, short)


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _settings(case: Case, method: Method, voxels: Voxels) -> dict[str, Any]:
    data = b""
    with suppress(OSError):  # what cannot be read is reported where it is read as a mesh
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
    """The result in a file, if it is whole and of these settings."""
    try:
        stored = json.loads(file.read_text(encoding="utf-8"))
    except (FileNotFoundError, json.JSONDecodeError, UnicodeDecodeError):
        return None
    if not isinstance(stored, dict) or stored.get("settings") != settings:
        return None
    return Measured(**stored["result"])


def _keep(file: Path, settings: dict[str, Any], result: Measured) -> None:
    make_folder(file.parent)
    text = json.dumps({"settings": settings, "result": asdict(result)}, indent=1, allow_nan=False)
    write_atomically(file, (text + "\n").encode("utf-8"))


def make_folder(path: Path) -> None:
    """Make a folder and those above it; OutputError where that is not possible."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be made: {error.strerror or type(error).__name__}.",
            "Choose another --output.",
        ) from error
