"""Random solids: lists of boolean operations, hollowed with random settings, and judged.

A recipe is plain data, so that a failure can be kept as JSON in tests/corpus.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from hypothesis import strategies as st
from manifold3d import Manifold, OpType
from promises import broken_promises

from printprep import hollow
from printprep.errors import PrintprepError
from printprep.mesh.measure import arrays, together
from printprep.mesh.sealed_voids import sealed_voids
from printprep.profiles import load_profile

CORPUS = Path(__file__).resolve().parent / "corpus"
PROFILES = ("fdm-pla-0.4", "fdm-petg-0.4", "resin-standard", "resin-msla-mono", "sls-pa12")


@dataclass(frozen=True)
class Step:
    """One operation: a shape of sizes x, y, z in mm, turned and moved, added or taken away."""

    op: str
    shape: str
    size: tuple[float, float, float]
    turn: tuple[float, float, float]
    move: tuple[float, float, float]


@dataclass(frozen=True)
class Recipe:
    """A solid and how to hollow it; the solid is turned, then scaled to its longest side."""

    steps: tuple[Step, ...]
    turn: tuple[float, float, float]
    size_mm: float
    profile: str
    voids: str
    base: str
    resolution: int
    lean: float

    def to_json(self) -> str:
        return json.dumps(asdict(self), indent=1)

    @staticmethod
    def of_json(text: str) -> Recipe:
        data: dict[str, Any] = json.loads(text)
        steps = tuple(
            Step(s["op"], s["shape"], tuple(s["size"]), tuple(s["turn"]), tuple(s["move"]))
            for s in data.pop("steps")
        )
        return Recipe(steps, tuple(data.pop("turn")), **data)


def _shape(step: Step) -> Manifold:
    x, y, z = step.size
    made = {
        "box": lambda: Manifold.cube((x, y, z), True),
        "ball": lambda: Manifold.sphere(1.0, 32).scale((x / 2, y / 2, z / 2)),
        "rod": lambda: Manifold.cylinder(z, x / 2, x / 2, 32, True),
        "cone": lambda: Manifold.cylinder(z, x / 2, y / 4, 32, True),
        "ring": lambda: (
            Manifold.cylinder(z, x / 2, x / 2, 32, True)
            - Manifold.cylinder(2 * z, x / 3, x / 3, 32, True)
        ),
    }[step.shape]()
    return made.rotate(step.turn).translate(step.move)


def build(recipe: Recipe) -> Manifold:
    """The solid of a recipe, not yet scaled."""
    solid = Manifold()
    for step in recipe.steps:
        solid = solid + _shape(step) if step.op == "add" else solid - _shape(step)
    return solid.rotate(recipe.turn)


_coarse = st.integers(4, 40).map(float)
_angle = st.sampled_from((0.0, 0.0, 0.0, 90.0, 30.0, 45.0, 17.0))
_offset = st.integers(-24, 24).map(float)
_steps = st.builds(
    Step,
    st.sampled_from(("add", "add", "take")),
    st.sampled_from(("box", "ball", "rod", "cone", "ring")),
    st.tuples(_coarse, _coarse, _coarse),
    st.tuples(_angle, _angle, _angle),
    st.tuples(_offset, _offset, _offset),
)
_first = st.builds(
    Step,
    st.just("add"),
    st.sampled_from(("box", "ball", "rod", "cone", "ring")),
    st.tuples(*[st.integers(16, 50).map(float)] * 3),
    st.tuples(_angle, _angle, _angle),
    st.just((0.0, 0.0, 0.0)),
)

RECIPES = st.builds(
    lambda first, more, *rest: Recipe((first, *more), *rest),
    _first,
    st.lists(_steps, max_size=6),
    st.tuples(_angle, _angle, _angle),
    st.sampled_from((12.0, 16.0, 20.0, 24.0, 30.0)),
    st.sampled_from(PROFILES),
    st.sampled_from(("fill", "fill", "keep")),
    st.sampled_from(("auto", "auto", "never", "always")),
    st.sampled_from((16, 24)),
    st.sampled_from((0.0, 10.0, 20.0)),
)


def judge(recipe: Recipe, *, twice: bool = False) -> list[str]:
    """What is broken about the part of a recipe; nothing for a solid that there is not."""
    solid = build(recipe)
    if solid.is_empty() or solid.volume() < 1000 or solid.status().name != "NoError":
        return []
    mesh = trimesh.Trimesh(*arrays(solid), process=False)

    def run() -> Any:
        return hollow(
            mesh,
            profile=recipe.profile,
            size_mm=recipe.size_mm,
            voids=recipe.voids,
            base=recipe.base,
            resolution=recipe.resolution,
            lean=recipe.lean,
        )

    try:
        result = run()
        again = None
        if twice:
            from tempfile import TemporaryDirectory

            with TemporaryDirectory() as folder:
                run().write(Path(folder) / "part.3mf")
                again = (Path(folder) / "part.3mf").read_bytes()
        return broken_promises(result, _placed(solid, recipe), again=again)
    except PrintprepError as error:
        return [f"exit {error.exit_code}: {error.message}"]
    except Exception as error:  # every exception is a finding here
        return [f"exit 70: {type(error).__name__}: {error}"]


def _placed(solid: Manifold, recipe: Recipe) -> Manifold:
    """The solid on the plate without what prints nothing, its empty voids filled.

    By arithmetic of its own: bodies below the profile's least volume are left out, and said.
    """
    filled = sealed_voids(solid).whole if recipe.voids == "fill" else solid
    if recipe.voids == "keep":
        shells = [part for part in solid.decompose() if part.volume() > 0]
        filled = Manifold.batch_boolean(shells, OpType.Add)
    low, high = np.reshape(filled.bounding_box(), (2, 3))
    factor = recipe.size_mm / float((high - low).max())
    middle = (low + high) / 2
    placed = filled.translate((-middle[0], -middle[1], -low[2])).scale((factor,) * 3)
    crumb_mm3 = load_profile(recipe.profile).crumb_mm3
    shells = placed.decompose()
    prints = [shell for shell in shells if abs(shell.volume()) >= crumb_mm3]
    if len(prints) == len(shells):
        return placed
    stands = together(prints)
    return stands.translate((0.0, 0.0, -stands.bounding_box()[2]))
