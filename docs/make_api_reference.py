"""Write docs/api.md, the Python interface, from signatures and docstrings.

Run it from anywhere after a change to a public name:  python3 dev.py docs
"""

from __future__ import annotations

import inspect
import re
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import printprep
from printprep.batches.row import Row
from printprep.batches.run import BatchOptions
from printprep.generators import VoxelHollow
from printprep.generators.hollow import hollow as hollow_voxels
from printprep.objectives import Solver
from printprep.output.figures import Figures
from printprep.pipeline.check import Checked, check
from printprep.pipeline.explore import Exploration, explore
from printprep.pipeline.hollow import hollow_with
from printprep.pipeline.job import Job, JobResult, run_job
from printprep.pipeline.options import FillOptions, Placement
from printprep.pipeline.simulate import Simulated, simulate
from printprep.types import Advice, Certificate, Lean, Part, Simulation, Stability
from printprep.verify.run import Verified, verify

TARGET = Path(__file__).with_name("api.md")
_HEAD = """# The Python interface

Made from signatures and docstrings by `docs/make_api_reference.py`.

```python
import printprep

result = printprep.hollow("model.stl", profile="fdm-pla-0.4", size_mm=100)
print(result.mass_g, result.tilt_deg, result.wall_min_mm)
result.write("out.3mf")
```

Axis order is x, y, z; z is up; the bed is z = 0. Lengths are mm, masses g, angles degrees,
densities g/cm³. Arrays are numpy arrays. Every error that is raised on purpose is a
`printprep.PrintprepError`.
"""

_PAGE: tuple[tuple[str, tuple[Any, ...]], ...] = (
    (
        "Hollow a model",
        (printprep.hollow, printprep.HollowResult, Part, Stability, Lean, Certificate, Advice),
    ),
    ("Findings", (printprep.Finding,)),
    ("Profiles", (printprep.load_profile, printprep.Profile)),
    (
        "The same with frozen options",
        (hollow_with, Placement, FillOptions, Solver, run_job, Job, JobResult),
    ),
    ("Figures in a 3MF", (Figures,)),
    ("Check, simulate, explore, verify", (check, Checked, simulate, Simulated, Simulation)),
    ("", (explore, Exploration, verify, Verified)),
    ("Many models", (printprep.batch, BatchOptions, Row)),
    ("Voxels of a generator", (printprep.generators, hollow_voxels, VoxelHollow)),
    (
        "Errors",
        (
            printprep.PrintprepError,
            printprep.UsageError,
            printprep.InputError,
            printprep.GeometryError,
            printprep.OutputError,
            printprep.ToolError,
        ),
    ),
)


def path_of(item: Any) -> str:
    """The name to import, as short as it is public."""
    if isinstance(item, ModuleType):
        return item.__name__
    if item is hollow_voxels:
        return "printprep.generators.hollow"
    name = item.__name__
    if getattr(printprep, name, None) is item:
        return f"printprep.{name}"
    return f"{item.__module__}.{name}"


def signature(item: Any) -> str:
    """A call with a parameter a line, or a class with a field a line."""
    if is_dataclass(item):
        lines = [f"    {field.name}: {_type(field.type)}" for field in fields(item)]
        return "\n".join([f"class {item.__name__}:", *lines])
    if inspect.isclass(item) and hasattr(item, "model_fields"):
        lines = [f"    {name}: {_type(item.__annotations__[name])}" for name in item.model_fields]
        return "\n".join([f"class {item.__name__}:", *lines])
    if inspect.isclass(item):
        return f"class {item.__name__}({item.__bases__[0].__name__})"
    lines, keyword_only = [], False
    parameters = inspect.signature(item).parameters.values()
    for parameter in parameters:
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword_only:
            lines, keyword_only = [*lines, "    *,"], True
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        lines.append(f"    {parameter.name}: {_type(parameter.annotation)}{_short(default)},")
    returned = _type(inspect.signature(item).return_annotation)
    return "\n".join([f"{item.__name__}(", *lines, f") -> {returned}"])


def _short(default: str) -> str:
    return " = …" if " object at 0x" in default else default


def _type(annotation: Any) -> str:
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "Any")
    return re.sub(r"Annotated\[(\w+), .*\]", r"\1", text)


def members(item: Any) -> list[str]:
    """The public properties and methods of a class, each with the first line of its docstring."""
    if not inspect.isclass(item) or issubclass(item, Exception):
        return []
    found = []
    for name, value in vars(item).items():
        value = value.__func__ if isinstance(value, classmethod) else value
        documented = inspect.getdoc(value.fget if isinstance(value, property) else value)
        if name.startswith(("_", "model_")) or not callable(getattr(value, "fget", value)):
            continue
        assert documented, f"{path_of(item)}.{name} has no docstring"
        call = "" if isinstance(value, property) else "()"
        found.append(f"- `{name}{call}` {documented.splitlines()[0]}")
    return found


def entry(item: Any) -> str:
    """One name: what it is, its signature, its docstring."""
    documented = inspect.getdoc(item)
    assert documented, f"{path_of(item)} has no docstring"
    lines = [f"### `{path_of(item)}`", ""]
    if not isinstance(item, ModuleType):
        lines += ["```python", signature(item), "```", ""]
    lines += ["```text", documented, "```", ""]
    listed = members(item)
    return "\n".join([*lines, *listed, ""] if listed else lines)


def reference() -> str:
    """The page as Markdown."""
    pages = [_HEAD]
    for title, items in _PAGE:
        if title:
            pages.append(f"## {title}\n")
        pages += [entry(item) for item in items]
    return "\n".join(pages).rstrip() + "\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        if TARGET.read_text(encoding="utf-8") != reference():
            sys.exit(f"{TARGET.name} does not match the docstrings: run python3 dev.py docs")
    else:
        TARGET.write_text(reference(), encoding="utf-8", newline="\n")
