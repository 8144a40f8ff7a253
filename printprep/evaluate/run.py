"""Every method on every model, as many models at once as there are workers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from printprep.errors import GeometryError, InputError, PrintprepError, UsageError
from printprep.evaluate.cases import Case, DataSet
from printprep.evaluate.measured import Measured, evaluate_case, make_folder
from printprep.evaluate.methods import Method
from printprep.evaluate.picture import Voxels

Told = Callable[[str, int, int], None]
"""Called with a model's name, how many are done and how many there are."""


@dataclass(frozen=True)
class Evaluation:
    """All that was measured, in the order of the models and, for each, of the methods.

    voxels : which voxels a model has.
    failures : the models that could not be evaluated, each with its error.
    """

    data_set: DataSet
    methods: tuple[Method, ...]
    voxels: Voxels
    results: tuple[Measured, ...]
    failures: tuple[tuple[str, PrintprepError], ...]


def evaluate(
    models: DataSet,
    chosen: Sequence[Method],
    folder: Path,
    *,
    voxels: Voxels = "surface",
    workers: int = 1,
    told: Told | None = None,
) -> Evaluation:
    """Evaluate the models, keeping every result in ``folder``/results.

    The result does not depend on the number of workers, or on how often it was interrupted.  A
    model that cannot be evaluated does not stop the others.

    Raises
    ------
    OutputError : the folder cannot be written to.
    UsageError : fewer than one worker.
    """
    if workers < 1:
        raise UsageError(f"--workers {workers}: give a whole number of at least 1.")
    kept = folder / "results"
    make_folder(kept)
    found: dict[str, tuple[Measured, ...]] = {}
    failed: dict[str, PrintprepError] = {}
    outcomes = _outcomes(models.cases, (tuple(chosen), kept, voxels), workers)
    for done, (case, outcome) in enumerate(outcomes, start=1):
        if isinstance(outcome, PrintprepError):
            failed[case.name] = outcome
        else:
            found[case.name] = outcome
        if told is not None:
            told(case.name, done, len(models.cases))
    return Evaluation(
        data_set=models,
        methods=tuple(chosen),
        voxels=voxels,
        results=tuple(row for case in models.cases for row in found.get(case.name, ())),
        failures=tuple((c.name, failed[c.name]) for c in models.cases if c.name in failed),
    )


_Outcome = tuple[Measured, ...] | PrintprepError
_Job = tuple[tuple[Method, ...], Path, Voxels]


def _outcomes(cases: Sequence[Case], job: _Job, workers: int) -> Iterator[tuple[Case, _Outcome]]:
    """Each case with what came of it, as they are done."""
    if workers == 1 or len(cases) == 1:
        for case in cases:
            yield case, _outcome(case, *job)
        return
    # Processes begin afresh ("spawn") on every system: forking would copy threads' locks.
    with ProcessPoolExecutor(min(workers, len(cases)), get_context("spawn")) as pool:
        waiting: dict[Future[_Outcome], Case] = {
            pool.submit(_outcome, case, *job): case for case in cases
        }
        for future in as_completed(waiting):
            yield waiting[future], future.result()


def _outcome(case: Case, chosen: tuple[Method, ...], kept: Path, voxels: Voxels) -> _Outcome:
    """The results, or what is wrong with the model; a folder that refuses is no model's fault."""
    try:
        return evaluate_case(case, chosen, kept, voxels)
    except (InputError, GeometryError) as error:
        return error
