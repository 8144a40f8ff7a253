"""The methods to compare, and the paper's ablations, by name.

Solid, shell, and the paper's objective with its switches come from the paper; lean is printprep's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal

from printprep.errors import UsageError
from printprep.paper.settings import PaperSettings, Reach

Kind = Literal["solid", "shell", "paper", "lean", "lean-full-base", "lean-at-paper-tilt"]
Solver = Literal["plane", "adam"]

LEAN_DEG = 10.0


@dataclass(frozen=True)
class Method:
    """One method: a row of a table.

    title : in the tables;  lean_deg : for the kinds "lean" and "lean-full-base".
    settings : the paper's parameters; the other kinds use N, ε, and whether B exists and how far it
    reaches.
    """

    name: str
    title: str
    kind: Kind
    settings: PaperSettings = field(default_factory=PaperSettings)
    lean_deg: float = LEAN_DEG
    solver: Solver = "plane"

    def described(self) -> dict[str, Any]:
        """All that its result depends on, and nothing else, as JSON holds it."""
        facts: dict[str, Any] = {"kind": self.kind, "settings": asdict(self.settings)}
        if self.kind in ("lean", "lean-full-base"):
            facts["lean_deg"] = self.lean_deg
        if self.kind in ("paper", "lean-at-paper-tilt"):
            facts["solver"] = self.solver
        return facts


_PLAIN = PaperSettings()
_NO_BASE = PaperSettings(base=False)

_WIDE = "paper-wide-base"

_MAIN = (
    Method("solid", "solid", "solid", _NO_BASE),
    Method("shell", "shell only", "shell", _NO_BASE),
    Method("paper", "paper's objective, with B", "paper", _PLAIN),
    Method("paper-no-base", "paper's objective, without B", "paper", _NO_BASE),
    Method("lean", "lightest at {lean:g}° lean, B where it helps", "lean", _PLAIN),
    Method("lean-no-base", "lightest at {lean:g}° lean, without B", "lean", _NO_BASE),
    Method("lean-full-base", "lightest at {lean:g}° lean, with all of B", "lean-full-base", _PLAIN),
    Method(
        "lean-at-paper-tilt",
        "lightest at the paper's own tilt angle, B where it helps",
        "lean-at-paper-tilt",
        _PLAIN,
    ),
)

_ABLATIONS = (
    Method("paper-no-center", "without L_center", "paper", PaperSettings(center=False)),
    Method("paper-no-region", "without L_region", "paper", PaperSettings(region=False)),
    Method("paper-no-height", "without L_z", "paper", PaperSettings(height=False)),
    Method("paper-lambda-0", "without L_mass (λ = 0)", "paper", PaperSettings(mass_weight=0.0)),
    Method("paper-lambda-10", "λ = 10", "paper", PaperSettings(mass_weight=10.0)),
    Method("paper-lambda-1000", "λ = 1000", "paper", PaperSettings(mass_weight=1000.0)),
    Method("paper-no-smoothing", "without smoothing", "paper", PaperSettings(smoothing=False)),
    Method("paper-epsilon-1", "ε = 1", "paper", PaperSettings(epsilon=1)),
    Method("paper-epsilon-3", "ε = 3", "paper", PaperSettings(epsilon=3)),
    Method(_WIDE, "B up to and including ε, as the code has it", "paper", _PLAIN),
)

MAIN = tuple(method.name for method in _MAIN)
# The ablations, with the full method they are compared with, and the method without B.
ABLATIONS = ("paper", "paper-no-base", *(method.name for method in _ABLATIONS))


def methods(
    names: Sequence[str] = MAIN,
    *,
    ablations: bool = False,
    resolution: int = 64,
    solver: Solver = "plane",
    lean_deg: float = LEAN_DEG,
    base_reach: Reach = "below",
) -> tuple[Method, ...]:
    """The methods of these names, then, with ``ablations``, those that are not among them.

    base_reach : of B, see `PaperSettings`; "paper-wide-base" has its own.

    Raises UsageError for an unknown name, for no name, or for a lean outside [0, 90).
    """
    known = {method.name: method for method in (*_MAIN, *_ABLATIONS)}
    for name in names:
        if name not in known:
            raise UsageError(
                f"--methods {name}: this method does not exist.", f"Choose from {', '.join(known)}."
            )
    if not 0 <= lean_deg < 90:
        raise UsageError(
            f"--lean {lean_deg:g} is out of range.", "Use 0° or more, and less than 90°."
        )
    chosen = list(dict.fromkeys([*names, *(ABLATIONS if ablations else ())]))
    if not chosen:
        raise UsageError("--methods names no method.", f"Choose from {', '.join(known)}.")
    return tuple(
        replace(
            known[name],
            title=known[name].title.format(lean=lean_deg),
            settings=replace(
                known[name].settings,
                resolution=resolution,
                base_reach="within" if name == _WIDE else base_reach,
            ),
            solver=solver,
            lean_deg=lean_deg,
        )
        for name in chosen
    )
