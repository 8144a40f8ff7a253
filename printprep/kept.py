"""Keeps what was found for the last few solids: many rooms ask the same of one.

A result is kept by the identity of what it was found for, which therefore must not change: a
manifold, or arrays that are read-only and own what they hold.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import partial, update_wrapper
from typing import Any, Generic, ParamSpec, TypeVar

import numpy as np

Asked = ParamSpec("Asked")
Found = TypeVar("Found")


class _Entry:
    """A result, found by the first thread that asks for it; the others wait.

    of : what it was found for, held so that its identity stays its own.
    """

    def __init__(self, of: tuple[object, ...] = ()) -> None:
        self._of = of
        self._found: list[Any] = []
        self._lock = threading.Lock()

    def result(self, find: Callable[[], Any]) -> Any:
        with self._lock:
            if not self._found:
                self._found.append(find())
        return self._found[0]

    @property
    def is_found(self) -> bool:
        return bool(self._found)


class Once:
    """Results by name, each found once, whichever thread asks first."""

    def __init__(self) -> None:
        self._entries: dict[Hashable, _Entry] = {}
        self._order = threading.Lock()

    def get(self, name: Hashable, find: Callable[[], Found]) -> Found:
        """The result of that name, found now where nobody has asked for it before."""
        with self._order:
            entry = self._entries.setdefault(name, _Entry())
        result: Found = entry.result(find)
        return result


class Keeping(Generic[Asked, Found]):
    """A function of objects that do not change, which keeps its results for the last few.

    Where an object is an array that may change, the result is found anew.  A thread that asks for
    what another one is just finding waits for it.
    """

    def __init__(self, function: Callable[Asked, Found], most: int) -> None:
        self._function = function
        self._most = most
        self._last: OrderedDict[tuple[int, ...], _Entry] = OrderedDict()
        self._order = threading.Lock()
        update_wrapper(self, function)

    def __call__(self, *objects: Asked.args, **named: Asked.kwargs) -> Found:
        if named or any(isinstance(each, np.ndarray) and may_change(each) for each in objects):
            return self._function(*objects, **named)
        find = partial(self._function, *objects, **named)
        result: Found = self._entry(objects).result(find)
        return result

    def known(self, *objects: object) -> bool:
        """Whether the result for some objects is kept."""
        entry = self._last.get(tuple(id(each) for each in objects))
        return entry is not None and entry.is_found

    def _entry(self, objects: tuple[object, ...]) -> _Entry:
        key = tuple(id(each) for each in objects)
        with self._order:
            entry = self._last.pop(key, None) or _Entry(objects)
            self._last[key] = entry
            if len(self._last) > self._most:
                self._last.popitem(last=False)
        return entry


def kept(most: int) -> Callable[[Callable[Asked, Found]], Keeping[Asked, Found]]:
    """A function that keeps its results for the last ``most`` things that it was asked of."""
    return lambda function: Keeping(function, most)


def may_change(array: np.ndarray[Any, Any]) -> bool:
    """Whether the numbers of an array can change: it is writeable, or a view of another one."""
    return array.flags.writeable or not array.flags.owndata


def read_only(*arrays: np.ndarray[Any, Any]) -> None:
    """Make arrays read-only, so that what is found for them can be kept."""
    for array in arrays:
        array.setflags(write=False)
