"""Hollow random solids and judge every promise of the parts; keep what fails, shrunk.

    python benchmarks/random_solids.py --count 2000 --seed 0 [--minutes 30]

hypothesis makes the solids and shrinks a failure; its recipe goes to tests/corpus, where a test
tries it from then on.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from hypothesis import HealthCheck, Phase, given, seed, settings
from random_solids import CORPUS, RECIPES, Recipe, judge


class _OutOfTime(BaseException):
    """The minutes are over."""


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=2000, help="solids to try")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after these")
    parser.add_argument("--no-shrink", action="store_true", help="keep failures as they come")
    given_ = parser.parse_args()
    started, tried = time.monotonic(), 0
    failures: dict[str, tuple[Recipe, list[str]]] = {}

    def attempt(recipe: Recipe) -> None:
        nonlocal tried
        if time.monotonic() - started > 60 * given_.minutes:
            raise _OutOfTime
        tried += 1
        broken = judge(recipe, twice=tried % 5 == 0)
        if tried % 100 == 0:
            minutes = (time.monotonic() - started) / 60
            print(f"{tried} solids in {minutes:.1f} min", file=sys.stderr, flush=True)
        if broken:
            kind = broken[0].split(":")[0]
            print(f"{tried}: {broken}\n{recipe.to_json()}", flush=True)
            known = failures.get(kind)
            if known is None or len(recipe.steps) < len(known[0].steps):
                failures[kind] = recipe, broken
            if not given_.no_shrink:
                raise AssertionError(kind)

    phases = [Phase.generate] if given_.no_shrink else [Phase.generate, Phase.shrink]
    test = seed(given_.seed)(
        settings(
            max_examples=given_.count,
            deadline=None,
            database=None,
            phases=phases,
            suppress_health_check=list(HealthCheck),
        )(given(RECIPES)(attempt))
    )
    try:
        test()
    except (_OutOfTime, AssertionError):
        pass
    except BaseExceptionGroup:
        pass
    CORPUS.mkdir(exist_ok=True)
    for recipe, _ in failures.values():
        text = recipe.to_json()
        name = hashlib.sha256(text.encode()).hexdigest()[:12]
        (CORPUS / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    minutes = (time.monotonic() - started) / 60
    print(f"{tried} solids in {minutes:.1f} min, {len(failures)} kinds of violation.")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
