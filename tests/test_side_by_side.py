"""Work side by side: the same results and errors as one after another."""

from __future__ import annotations

import threading
import time
from contextvars import ContextVar

import pytest

from printprep import side_by_side as module
from printprep.side_by_side import side_by_side


@pytest.fixture(params=[1, 2, 3])
def processors(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    count: int = request.param
    monkeypatch.setattr(module, "usable_processors", lambda: count)
    return count


@pytest.mark.usefixtures("processors")
@pytest.mark.parametrize("count", [0, 1, 2, 7])
def test_results_are_in_the_order_of_the_work(count: int) -> None:
    def piece(number: int) -> int:
        time.sleep(0.01 * (count - number))  # the first ends last
        return number

    assert side_by_side([lambda k=k: piece(k) for k in range(count)]) == list(range(count))


def test_two_pieces_run_at_one_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "usable_processors", lambda: 2)
    both = threading.Barrier(2, timeout=20)
    assert sorted(side_by_side([both.wait, both.wait])) == [0, 1]


def test_on_one_processor_there_is_no_other_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "usable_processors", lambda: 1)
    here = threading.current_thread()
    assert side_by_side([threading.current_thread] * 3) == [here] * 3


@pytest.mark.usefixtures("processors")
def test_the_error_of_the_first_piece_that_fails_is_raised() -> None:
    def fails(number: int) -> None:
        time.sleep(0.02 * (4 - number))
        raise ValueError(str(number))

    with pytest.raises(ValueError, match=r"^1$"):
        side_by_side([lambda: None, lambda: fails(1), lambda: fails(2), lambda: fails(3)])


def test_after_an_error_no_more_begins(processors: int) -> None:
    begun: list[int] = []

    def piece(number: int) -> None:
        begun.append(number)
        if number == 0:
            raise ValueError
        time.sleep(0.05)

    with pytest.raises(ValueError):
        side_by_side([lambda k=k: piece(k) for k in range(50)])
    assert len(begun) <= 2 * processors


@pytest.mark.usefixtures("processors")
def test_an_interruption_ends_the_work() -> None:
    here = threading.current_thread()
    begun: list[int] = []

    def piece(number: int) -> None:
        begun.append(number)
        if threading.current_thread() is here:
            raise KeyboardInterrupt
        time.sleep(0.05)

    with pytest.raises(KeyboardInterrupt):
        side_by_side([lambda k=k: piece(k) for k in range(100)])
    time.sleep(0.2)
    assert len(begun) < 20


def test_context_variables_hold_in_every_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "usable_processors", lambda: 2)
    both = threading.Barrier(2, timeout=20)
    variable: ContextVar[str] = ContextVar("variable", default="unset")
    variable.set("set")

    def piece() -> str:
        both.wait()
        return variable.get()

    assert side_by_side([piece, piece]) == ["set", "set"]


def test_whatever_ends_another_thread_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "usable_processors", lambda: 2)
    here = threading.current_thread()
    both = threading.Barrier(2, timeout=20)

    def piece() -> None:
        both.wait()
        if threading.current_thread() is not here:
            raise SystemExit(3)

    with pytest.raises(SystemExit):
        side_by_side([piece, piece])


@pytest.mark.parametrize("ends", [KeyboardInterrupt, ValueError])
def test_a_crew_within_another_one_ends_with_it(
    ends: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "usable_processors", lambda: 2)
    begun: list[int] = []

    def inner(number: int) -> None:
        begun.append(number)
        time.sleep(0.02)

    def fails() -> None:
        while not begun:
            time.sleep(0.001)
        raise ends

    def many() -> None:
        side_by_side([lambda k=k: inner(k) for k in range(200)])

    with pytest.raises(ends):
        side_by_side([many, fails] if ends is ValueError else [fails, many])
    time.sleep(0.2)
    assert len(begun) < 30
