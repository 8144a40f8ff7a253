"""Every method on every model, as many models at once as there are workers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from printprep.errors import GeometryError, InputError, PrintprepError
from printprep.evaluate.cases import Case, DataSet
from printprep.evaluate.measured import Measured, evaluate_case, make_folder
from printprep.evaluate.methods import Method
from printprep.evaluate.picture import Voxels
from printprep.pool import run_here

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
    kept = folder / "results"
    make_folder(kept)
    found: dict[str, tuple[Measured, ...]] = {}
    failed: dict[str, PrintprepError] = {}
    job = partial(_outcome, chosen=tuple(chosen), kept=kept, voxels=voxels)
    for done, (case, outcome) in enumerate(run_here(job, models.cases, workers), start=1):
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


def _outcome(case: Case, chosen: tuple[Method, ...], kept: Path, voxels: Voxels) -> _Outcome:
    """The results, or what is wrong with the model; a folder that refuses is no model's fault."""
    try:
        return evaluate_case(case, chosen, kept, voxels)
    except (InputError, GeometryError) as error:
        return error
