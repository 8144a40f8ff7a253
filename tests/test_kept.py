"""Results that are kept for the last few solids, or once for a check."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from printprep.kept import Once, kept, read_only


def test_the_last_few_results_are_kept() -> None:
    asked: list[object] = []

    @kept(most=2)
    def named(thing: object) -> str:
        asked.append(thing)
        return f"result {len(asked)}"

    one, two, three = object(), object(), object()
    assert [named(one), named(two), named(one), named(two)] == ["result 1", "result 2"] * 2
    assert named(three) == "result 3"  # one, asked of before two, is forgotten
    assert named.known(two) and named.known(three) and not named.known(one)
    assert (named(two), named(one)) == ("result 2", "result 4")


def test_arrays_that_may_change_are_asked_anew() -> None:
    @kept(most=2)
    def total(array: np.ndarray) -> float:
        return float(array.sum())

    array = np.ones(3)
    assert total(array) == 3.0
    array[0] = 5.0
    assert total(array) == 7.0
    read_only(array)
    assert total(array) == 7.0 and total.known(array)
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1.0


def test_an_error_is_not_kept() -> None:
    outcomes = iter([ValueError("first"), "second"])

    @kept(most=2)
    def result(thing: object) -> str:
        outcome = next(outcomes)
        if isinstance(outcome, ValueError):
            raise outcome
        return outcome

    thing = object()
    with pytest.raises(ValueError, match="first"):
        result(thing)
    assert not result.known(thing)
    assert result(thing) == "second"
    assert result.known(thing)


def test_a_view_of_what_may_change_is_asked_anew() -> None:
    @kept(most=2)
    def total(array: np.ndarray) -> float:
        return float(array.sum())

    whole = np.ones(6)
    view = whole[:3]
    read_only(view)
    assert total(view) == 3.0
    whole += 1.0
    assert total(view) == 6.0


def test_two_threads_that_ask_the_same_find_it_once() -> None:
    once, found = Once(), []

    def find() -> int:
        time.sleep(0.05)
        found.append(threading.current_thread())
        return 7

    results: list[int] = []
    threads = [
        threading.Thread(target=lambda: results.append(once.get("it", find))) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [7] * 4 and len(found) == 1
    assert once.get("other", lambda: 8) == 8
