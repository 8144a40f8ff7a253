"""Random solids keep the promises; so do those that once did not."""

from __future__ import annotations

from pathlib import Path

import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from random_solids import CORPUS, RECIPES, Recipe, Step, judge

pytestmark = pytest.mark.slow


@settings(examples(30), suppress_health_check=list(HealthCheck))
@given(RECIPES)
def test_random_solids_keep_the_promises(recipe: Recipe) -> None:
    assert judge(recipe) == []


@pytest.mark.parametrize("file", sorted(CORPUS.glob("*.json")), ids=lambda file: file.stem)
def test_what_failed_once_keeps_the_promises(file: Path) -> None:
    assert judge(Recipe.of_json(file.read_text(encoding="utf-8")), twice=True) == []


def test_a_recipe_survives_its_file() -> None:
    step = Step("add", "box", (20.0, 20.0, 20.0), (0.0, 30.0, 0.0), (0.0, 0.0, 5.0))
    recipe = Recipe((step,), (0.0, 0.0, 0.0), 20.0, "fdm-pla-0.4", "fill", "auto", 16, 10.0)
    assert Recipe.of_json(recipe.to_json()) == recipe
