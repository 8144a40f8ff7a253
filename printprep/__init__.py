"""Hollow a model for 3D printing: the lightest part that stands at the lean you name.

    import printprep

    result = printprep.hollow("model.stl", profile="fdm-pla-0.4", size_mm=100)
    result.stability.tilt_deg, result.mass_g
    result.write("out.3mf")

Names are loaded when they are first used, so that importing the package costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from printprep.version import __version__

if TYPE_CHECKING:
    from printprep import generators
    from printprep.batches.run import batch
    from printprep.errors import (
        GeometryError,
        InputError,
        OutputError,
        PrintprepError,
        ToolError,
        UsageError,
    )
    from printprep.pipeline.hollow import hollow
    from printprep.profiles import Profile, load_profile
    from printprep.result import HollowResult
    from printprep.types import Finding

__all__ = [
    "Finding",
    "GeometryError",
    "HollowResult",
    "InputError",
    "OutputError",
    "PrintprepError",
    "Profile",
    "ToolError",
    "UsageError",
    "__version__",
    "batch",
    "generators",
    "hollow",
    "load_profile",
]

_HOME = {
    "Finding": "printprep.types",
    "GeometryError": "printprep.errors",
    "HollowResult": "printprep.result",
    "InputError": "printprep.errors",
    "OutputError": "printprep.errors",
    "PrintprepError": "printprep.errors",
    "Profile": "printprep.profiles",
    "ToolError": "printprep.errors",
    "UsageError": "printprep.errors",
    "batch": "printprep.batches.run",
    "hollow": "printprep.pipeline.hollow",
    "load_profile": "printprep.profiles",
}


def __getattr__(name: str) -> Any:
    if name == "generators":
        return import_module("printprep.generators")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
