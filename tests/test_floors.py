"""The plan of the house: imports only go down, and no files import each other in a circle.

Read from the syntax trees: an import counts inside a function and under TYPE_CHECKING too.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import printprep

PACKAGE = Path(printprep.__file__).parent

# From the roof to the ground; files on one floor do not import each other.
FLOORS: tuple[tuple[str, ...], ...] = (
    ("printprep",),
    ("printprep.__main__",),
    ("printprep.cli",),
    ("printprep.report", "printprep.hook", "printprep.serve"),
    ("printprep.batches",),
    ("printprep.page",),
    ("printprep.pipeline",),
    ("printprep.verify",),
    ("printprep.result",),
    ("printprep.infill", "printprep.evaluate"),
    ("printprep.generators",),
    ("printprep.objectives",),
    ("printprep.paper", "printprep.output"),
    ("printprep.check",),
    ("printprep.density", "printprep.drainage", "printprep.supports"),
    ("printprep.cavity", "printprep.gcode", "printprep.render"),
    ("printprep.overhang", "printprep.thickness", "printprep.stand", "printprep.grid"),
    ("printprep.mesh", "printprep.slicer"),
    ("printprep.profile_import", "printprep.profile_new"),
    ("printprep.threemf", "printprep.profiles", "printprep.bgcode"),
    ("printprep.profile_schema", "printprep.types", "printprep.files", "printprep.pool"),
    (
        "printprep.input_file",
        "printprep.mislabelled",
        "printprep.profile_folders",
        "printprep.side_by_side",
    ),
    (
        "printprep.arrays",
        "printprep.children",
        "printprep.errors",
        "printprep.kept",
        "printprep.machine_memory",
        "printprep.process",
        "printprep.processors",
        "printprep.progress",
        "printprep.version",
        "printprep.wording",
    ),
)


def module_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def floor_of(module: str) -> int:
    """The floor of the room that a module is in, 0 at the roof."""
    names = {name: number for number, floor in enumerate(FLOORS) for name in floor}
    room = module
    while room not in names or (room == "printprep" and module != "printprep"):
        if "." not in room:
            raise AssertionError(f"{module} stands on no floor: put its room into FLOORS")
        room = room.rpartition(".")[0]
    return names[room]


def room_of(module: str) -> str:
    return ".".join(module.split(".")[:2])


def imported(module: str) -> Iterator[str]:
    """The modules of printprep that a module imports, anywhere in it."""
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            source = node.module or ""
            names = [
                f"{source}.{alias.name}" if f"{source}.{alias.name}" in MODULES else source
                for alias in node.names
            ]
        else:
            continue
        yield from (name for name in names if name in MODULES and name != module)


ARROWS = {module: set(imported(module)) for module in MODULES}


def test_imports_go_down():
    """To a lower floor, or within a room; a package's own front door counts as its room."""
    up = {
        module: f"{target} is on floor {floor_of(target)}, not below {floor_of(module)}"
        for module, targets in ARROWS.items()
        for target in sorted(targets)
        if room_of(target) != room_of(module) and floor_of(target) <= floor_of(module)
    }
    assert not up


def test_there_is_no_circle():
    """Every file can be taken away once all that it imports is gone."""
    left = {module: set(targets) for module, targets in ARROWS.items()}
    while left:
        done = {module for module, targets in left.items() if not targets & left.keys()}
        assert done, f"files in circles: {sorted(left)}"
        left = {module: targets for module, targets in left.items() if module not in done}


def test_every_room_stands_on_one_floor():
    names = [name for floor in FLOORS for name in floor]
    assert len(names) == len(set(names))
    assert {room_of(module) for module in MODULES} == set(names)


def test_findings_are_made_in_the_catalogue_alone():
    """So that no finding has an id, a unit or a severity of its own making."""
    makers = [
        module
        for module, path in MODULES.items()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "Finding"
    ]
    assert makers == ["printprep.check.catalogue"]


def test_the_catalogue_holds_just_the_findings_that_are_made():
    from printprep.check.catalogue import CATALOGUE

    made = {
        node.args[0].value
        for path in MODULES.values()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "finding"
        and isinstance(node.args[0], ast.Constant)
    }
    assert made == set(CATALOGUE)
