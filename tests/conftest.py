"""What every test may ask for: the model collection, the real slicer."""

from __future__ import annotations

import csv
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn

import pytest
from collection import CatalogueModel
from hypothesis import settings

pytest_plugins = ["tiers"]

# The same examples every time: a change fails for what it changes. For more of them, and others
# every time:  pytest --hypothesis-profile=random
settings.register_profile("default", deadline=None, derandomize=True)
settings.register_profile(
    "random", deadline=None, derandomize=False, max_examples=500, print_blob=True
)
settings.load_profile("default")

ROOT = Path(__file__).resolve().parent.parent
MODELS = Path(os.environ.get("PRINTPREP_MODELS", ROOT.parent / "shared" / "models"))


@pytest.fixture(scope="session", autouse=True)
def _no_profiles_of_the_user(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The tests, and the commands that they start, see no profiles of whoever runs them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PRINTPREP_PROFILES", str(tmp_path_factory.mktemp("profiles")))
        yield


def _required() -> bool:
    return os.environ.get("PRINTPREP_REQUIRE_TOOLS") == "1"


@pytest.fixture(scope="session")
def models_dir() -> Path:
    """Folder of the shared model collection (set PRINTPREP_MODELS to put it elsewhere)."""
    if not (MODELS / "catalogue.csv").is_file():
        pytest.skip("the shared model collection is not here")
    return MODELS


@pytest.fixture(scope="session")
def dev_models(models_dir: Path) -> dict[str, CatalogueModel]:
    """The real models by file stem."""
    with (models_dir / "catalogue.csv").open(encoding="utf-8", newline="") as handle:
        rows = [row for row in csv.DictReader(handle) if row["set"] == "dev"]
    return {
        Path(row["file"]).stem: CatalogueModel(
            models_dir / "dev" / row["file"], row["up"], row["may_ship"] == "yes"
        )
        for row in rows
    }


@pytest.fixture(scope="session")
def samples_dir() -> Path:
    """The samples that ship with the project."""
    return ROOT / "samples"


@pytest.fixture(scope="session")
def prusa_slicer() -> Path:
    """The real slicer: skipped without it on a user's machine, a failure in CI."""
    return _tool("prusa-slicer")


@pytest.fixture(scope="session")
def cura_engine() -> Path:
    """Cura's engine, likewise."""
    return _tool("CuraEngine")


@pytest.fixture(scope="session")
def chromium() -> tuple[Path, Path]:
    """A real browser and its driver, likewise."""
    return _tool("chromium"), _tool("chromedriver")


@pytest.fixture(scope="session")
def shell_program() -> Callable[[str], Path]:
    """Finds a real shell by its name, likewise."""
    return _tool


@pytest.fixture(scope="session")
def axe() -> str:
    """The script of axe-core, which npm puts below web/ (`python3 dev.py page`), likewise."""
    script = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"
    if not script.is_file():
        _missing("axe-core is not installed")
    return script.read_text(encoding="utf-8")


def _tool(name: str) -> Path:
    found = shutil.which(name)
    if found is None:
        _missing(f"{name} is not installed")
    return Path(found)


def _missing(message: str) -> NoReturn:
    """Skip a test whose tool is missing; where all tools are required, fail it."""
    if _required():
        pytest.fail(message)
    pytest.skip(message)
