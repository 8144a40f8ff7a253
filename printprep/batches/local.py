"""A batch on this machine: as many jobs at once as cores and memory allow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from printprep.batches.item import Item
from printprep.batches.memory import estimated_mib, machine_mib
from printprep.batches.row import Told
from printprep.batches.work import run_one
from printprep.pool import WorkerDiedError, run_apart
from printprep.processors import usable_processors

if TYPE_CHECKING:
    from printprep.pipeline.job import Job


def run_locally(
    items: Sequence[Item],
    *,
    workers: int | None = None,
    memory_mib: float | None = None,
    timeout_s: float | None = None,
    run: Callable[[Job], Told] = run_one,
) -> Iterator[tuple[Item, Told]]:
    """Each item with what came of it, as they end.

    workers : processes, None for one a core;  memory_mib : for all jobs at once, None for most of
    what is free: a job waits until its estimate fits, and one that never fits runs alone.
    timeout_s : for one job.  run : what does a job, in a worker.
    """
    ended = run_apart(
        partial(_run_item, run),
        items,
        workers or usable_processors(),
        timeout_s=timeout_s,
        cost=_cost_mib,
        budget=machine_mib() if memory_mib is None else memory_mib,
    )
    for item, result in ended:
        try:
            told = result()
        except TimeoutError:
            told = Told("timeout", timeout_facts(timeout_s))
        except WorkerDiedError as error:
            told = Told("crashed", crash_facts(error.exit_code))
        yield item, told


def timeout_facts(timeout_s: float | None) -> dict[str, Any]:
    """The facts of a row whose time was up."""
    return {
        "code": "timeout",
        "message": f"It took over {timeout_s:g} s.",
        "hint": "Give it more time (--timeout), or fewer triangles.",
    }


def crash_facts(exit_code: int | None) -> dict[str, Any]:
    """The facts of a row whose process died."""
    how = f" by signal {-exit_code}" if exit_code is not None and exit_code < 0 else ""
    return {
        "code": "crashed",
        "message": f"The process that ran it died{how}.",
        "hint": "Where memory is short, run fewer at once (--jobs), or at a lower --resolution.",
    }


def _run_item(run: Callable[[Job], Told], item: Item) -> Told:
    return run(item.job)


def _cost_mib(item: Item) -> float:
    return estimated_mib(item.job)
