"""The examples of CONTRIBUTING.md run, each through the door that it describes."""

from __future__ import annotations

import re
import sys
import textwrap
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType, ModuleType

import pytest
from closed_form_parts import box, context

import printprep
from printprep import objectives
from printprep.check import catalogue, registry, run_rules, troubleshooting
from printprep.cli import app
from printprep.cli.run import run
from printprep.objectives import OBJECTIVES
from printprep.pipeline.fills import FILLS
from printprep.process import PROCESSES, Process
from printprep.profiles import load_profile

PAGE = Path(__file__).resolve().parent.parent / "CONTRIBUTING.md"


def example(name: str) -> str:
    """The code of the one block that is marked ``python NAME``."""
    blocks = re.findall(
        rf"^ *```python {name}\n(.*?)^ *```$", PAGE.read_text(encoding="utf-8"), re.S | re.M
    )
    assert len(blocks) == 1, f"CONTRIBUTING.md has {len(blocks)} examples of a {name}"
    return textwrap.dedent(blocks[0])


def last_value(code: str, names: dict[str, object]) -> object:
    """Run a block and return the value of its last expression."""
    import ast

    tree = ast.parse(code)
    last = tree.body.pop()
    assert isinstance(last, ast.Expr)
    exec(compile(tree, str(PAGE), "exec"), names)
    return eval(compile(ast.Expression(last.value), str(PAGE), "eval"), names)


@pytest.fixture
def tower(tmp_path):
    """A tower of 18 × 18 × 40 mm, as a file."""
    from printprep.mesh.write import to_bytes

    path = tmp_path / "tower.stl"
    path.write_bytes(to_bytes(box(18, 40), ".stl"))
    return path


def test_the_rule(monkeypatch):
    kind = last_value(example("catalogue"), {"Kind": catalogue.Kind})
    remedy = last_value(example("remedy"), {"Remedy": troubleshooting.Remedy})
    assert remedy.id == kind.id
    kinds = MappingProxyType({**catalogue.CATALOGUE, kind.id: kind})
    monkeypatch.setattr(catalogue, "CATALOGUE", kinds)
    monkeypatch.setattr(registry, "CATALOGUE", kinds)
    monkeypatch.setattr(registry, "RULES", dict(registry.RULES))
    exec(compile(example("rule"), str(PAGE), "exec"), {})
    fdm = load_profile("fdm-pla-0.4")
    (tall,) = [f for f in run_rules(context(box(100, 201)), fdm) if f.rule == "tall-part"]
    assert (tall.value, tall.limit, tall.unit, tall.severity) == (201.0, 200, "mm", "info")
    assert "tall-part" not in {f.rule for f in run_rules(context(box(100, 200)), fdm)}


def test_the_process(monkeypatch, tower):
    row = last_value(example("process"), {"Process": Process})
    monkeypatch.setitem(PROCESSES, row.name, row)
    profile = load_profile("fdm-pla-0.6", {"process": "pellets"})
    result = printprep.hollow(tower, profile=profile, resolution=16)
    assert result.mass_g < result.solid_mass_g


def test_the_objective(monkeypatch, tower):
    row = last_value(example("objective"), {**vars(objectives), "replace": replace})
    monkeypatch.setitem(OBJECTIVES, row.name, row)
    shell = printprep.hollow(tower, objective="shell", resolution=16)
    assert shell.density.planes == (None,)


def test_the_fill(monkeypatch, tower):
    row = last_value(example("fill"), {"FILLS": FILLS, "replace": replace})
    monkeypatch.setitem(FILLS, row.name, row)
    assert printprep.hollow(tower, fill="floating", base="always", resolution=16).part.base is None


def test_the_command(monkeypatch, tower, capsys):
    module = ModuleType("printprep.cli.weigh")
    exec(compile(example("command"), str(PAGE), "exec"), vars(module))
    monkeypatch.setitem(sys.modules, "printprep.cli.weigh", module)
    monkeypatch.setitem(app.printprep._lazy, "weigh", "printprep.cli.weigh")
    assert run(["weigh", str(tower), "--scale", "2"]) == 0
    assert capsys.readouterr().out == "103.680 cm³\n"


def test_every_door_has_an_example_and_every_example_a_test():
    named = re.findall(r"^ *```python (\w+)$", PAGE.read_text(encoding="utf-8"), re.M)
    assert sorted(named) == [
        "catalogue",
        "command",
        "fill",
        "objective",
        "process",
        "remedy",
        "rule",
    ]
