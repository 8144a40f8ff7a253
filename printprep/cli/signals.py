"""Signals that end the program: the exception they raise, and what is said of them."""

from __future__ import annotations

import signal


class Terminated(BaseException):
    """A signal that ends the program, by its number."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def sentence_of(number: int) -> str:
    """How a run that a signal ended is told."""
    if number == signal.SIGINT:
        return "Interrupted."
    return f"Ended by {signal.Signals(number).name}."
