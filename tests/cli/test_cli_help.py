"""Help a person can use: every option explained, nothing heavy imported, a true reference."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import click
import pytest

from printprep import __version__
from printprep.cli.app import printprep

ROOT = Path(__file__).resolve().parents[2]
HEAVY = (
    "dask", "igl", "jinja2", "lxml", "manifold3d", "mujoco", "numpy", "pydantic", "pymeshlab",
    "rich", "scipy", "skimage", "torch", "trimesh",
)  # fmt: skip


def python(*arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, *arguments], capture_output=True, encoding="utf-8", check=True, cwd=ROOT,
    )  # fmt: skip
    return done.stdout


def reference_maker():
    spec = importlib.util.spec_from_file_location("reference", ROOT / "docs/make_cli_reference.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def every_command() -> list[click.Context]:
    root = click.Context(printprep, info_name="printprep")
    return list(reference_maker().commands(printprep, root))


def test_all_commands_are_there():
    assert {context.command_path for context in every_command()} >= {
        "printprep", "printprep hollow", "printprep check", "printprep profiles",
        "printprep profiles list", "printprep profiles show", "printprep profiles export",
    }  # fmt: skip


@pytest.mark.parametrize("context", every_command(), ids=lambda context: context.command_path)
def test_every_command_and_option_has_help(context: click.Context):
    assert (context.command.help or "").strip()
    for parameter in context.command.params:
        if isinstance(parameter, click.Option):
            assert (parameter.help or "").strip(), f"{parameter.opts} says nothing"


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_names_commands_and_exit_codes(flag: str):
    text = python("-m", "printprep", flag)
    for word in ("hollow", "check", "profiles", "Exit codes:", "70 ", "130 ", "Examples:"):
        assert word in text
    assert max(map(len, text.splitlines())) <= 80


def test_without_arguments_it_shows_help():
    assert python("-m", "printprep") == python("-m", "printprep", "--help")


def test_version():
    assert python("-m", "printprep", "--version") == f"printprep {__version__}\n"


@pytest.mark.parametrize(
    "arguments", [["--help"], ["hollow", "--help"], ["check", "-h"], ["profiles", "show", "-h"]]
)
def test_help_imports_nothing_heavy(arguments: list[str]):
    code = (
        "import sys; from printprep.cli.run import run\n"
        f"assert run({arguments!r}) == 0\n"
        f"print('loaded:', sorted(set({HEAVY!r}) & set(sys.modules)))"
    )
    assert python("-c", code).endswith("loaded: []\n")


def test_importing_the_package_imports_nothing_heavy():
    code = f"import sys, printprep; print(sorted(set({(*HEAVY, 'click')!r}) & set(sys.modules)))"
    assert python("-c", code) == "[]\n"


def test_the_reference_is_up_to_date():
    made = reference_maker().reference()
    assert (ROOT / "docs/cli.md").read_text(encoding="utf-8") == made, "run: python3 dev.py docs"


def test_choices_named_for_speed_are_those_of_the_library():
    # The command line repeats them so that --help need not import the rooms they live in.
    from printprep.cli import options
    from printprep.mesh.read import MM_PER_UNIT
    from printprep.profiles import DEFAULT_PROFILE

    assert set(options.UNITS) == set(MM_PER_UNIT)
    assert options.DEFAULT_PROFILE == DEFAULT_PROFILE
