"""A batch: many models with one journal; what ends becomes a row, whatever it ends with."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.batches.item import (
    Item,
    found_models,
    items_of,
    refuse_clashes,
)
from printprep.batches.journal import NAME, Journal, is_complete, rows_in
from printprep.batches.row import Row, Told
from printprep.errors import PrintprepError, UsageError

if TYPE_CHECKING:
    from distributed import Client

    from printprep.pipeline.dry_run import DryRun
    from printprep.pipeline.job import Job
    from printprep.profiles import Profile


@dataclass(frozen=True)
class BatchOptions:
    """How a batch runs.

    workers : processes on this machine, None for one a core;  memory_mib : for all of them.
    timeout_s : for one model;  resume : go on where the journal ends.
    transfer : on a cluster, send models with their jobs and bring parts back.
    """

    workers: int | None = None
    memory_mib: float | None = None
    timeout_s: float | None = None
    resume: bool = False
    transfer: bool = False


@dataclass(frozen=True)
class Planned:
    """A batch that was checked: what is to run, and the rows that stand already."""

    folder: Path
    items: tuple[Item, ...]
    left: tuple[Item, ...]
    kept: tuple[Row, ...] = field(default=())


def batch(
    inputs: Sequence[str | Path],
    options: Job | None = None,
    *,
    output: str | Path,
    client: Client | None = None,
    run: BatchOptions | None = None,
) -> Iterator[Row]:
    """Hollow many models; yields a row for each as it ends, the ones that stand already first.

    Parameters
    ----------
    inputs : files, folders and patterns.
    options : a job whose options all models get; its own model and output do not count.
    output : the folder for parts and journal.
    client : of a Dask cluster; None runs on this machine.

    Raises
    ------
    UsageError, InputError, OutputError, ToolError : before the first model starts; what happens
        to a model afterwards is its row.
    """
    from printprep.pipeline.job import Job

    folder, how = Path(output), run or BatchOptions()
    template = options or Job(Path(), Path())
    planned = plan(
        items_of(found_models(inputs, folder), template, folder), folder, resume=how.resume
    )
    yield from planned.kept
    yield from run_batch(planned, how, client)


def plan(items: Sequence[Item], folder: Path, *, resume: bool, dry: bool = False) -> Planned:
    """Check all of a batch before its first model starts.

    dry : do not make the folder.

    Raises UsageError for options or names that cannot be, OutputError for a folder that refuses.
    """
    refuse_clashes(items)
    items = with_profiles(items)
    if dry:
        _check_folder(folder)
    else:
        _make_folder(folder)
    if not resume:
        if (folder / NAME).exists():
            raise UsageError(
                f"{folder} holds the journal of an earlier batch.",
                "Add --resume to go on with it, or name another folder.",
            )
        return Planned(folder, tuple(items), tuple(items))
    rows = rows_in(folder)
    complete = {i.output for i in items if is_complete(i, rows.get(i.output), folder)}
    return Planned(
        folder,
        tuple(items),
        tuple(item for item in items if item.output not in complete),
        tuple(rows[item.output] for item in items if item.output in complete),
    )


def dry_run_batch(planned: Planned) -> Iterator[tuple[Item, DryRun | PrintprepError]]:
    """What is left of a batch, each model read and placed, or why it is refused; see ``plan``."""
    from printprep.pipeline.dry_run import dry_run

    for item in planned.left:
        try:
            # Folders of parts are made when those are written: a new one holds nothing in the way
            yield item, dry_run(item.job, into_new_folder=not item.job.output.parent.exists())
        except PrintprepError as error:
            yield item, error


def with_profiles(items: Sequence[Item]) -> tuple[Item, ...]:
    """The items with their profiles loaded and their options checked, but not their files.

    A profile that is loaded travels with its job to machines that do not have its file.

    Raises the error of the first job whose options do not go together, with its model's name.
    """
    from printprep.output.limits import SUFFIXES
    from printprep.pipeline.job import check_settings

    checked: dict[str, Profile] = {}
    loaded = []
    for item in items:
        suffix = item.job.output.suffix
        if suffix not in SUFFIXES:
            raise UsageError(
                f"{suffix} is not a format that printprep writes.", f"Use {', '.join(SUFFIXES)}."
            )
        # But for the files, most models of a batch have the same job
        options = repr(
            replace(item.job, model=Path(), output=Path(suffix), plugs=None, report=None)
        )
        if options not in checked:
            try:
                checked[options] = check_settings(item.job)
            except PrintprepError as error:
                raise type(error)(f"{item.name}: {error.message}", error.hint) from error
        job = replace(item.job, profile=checked[options], overrides={})
        loaded.append(replace(item, job=job))
    return tuple(loaded)


def run_batch(planned: Planned, how: BatchOptions, client: Client | None = None) -> Iterator[Row]:
    """Run what is left of a batch; each row is in the journal before it is yielded."""
    if client is None:
        from printprep.batches.local import run_locally

        ended = run_locally(
            planned.left,
            workers=how.workers,
            memory_mib=how.memory_mib,
            timeout_s=how.timeout_s,
        )
    else:
        from printprep.batches.cluster import run_on_cluster

        ended = run_on_cluster(planned.left, client, transfer=how.transfer, timeout_s=how.timeout_s)
    with Journal(planned.folder) as journal:
        for item, told in ended:
            row = _row(item, _with_output(item, told, planned.folder))
            journal.append(row)
            yield row


def _row(item: Item, told: Told) -> Row:
    made = item.job.report is not None and told.status in ("part", "stopped")
    report = Path(item.output).with_suffix(".html").as_posix() if made else None
    return Row(name=item.name, output=item.output, status=told.status, report=report, **told.facts)


def _with_output(item: Item, told: Told, folder: Path) -> Told:
    """Write the part that came back from a worker."""
    from printprep.files import write_atomically

    if told.output is None:
        return told
    target = folder / item.output
    target.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(target, told.output)
    return replace(told, output=None)


def _check_folder(folder: Path) -> None:
    """Raise OutputError where ``_make_folder`` would, or where nothing can be written into it."""
    from printprep.errors import OutputError

    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not (there.is_dir() and os.access(there, os.W_OK | os.X_OK)):
        what = "is not writable" if there.is_dir() else "is no folder"
        raise OutputError(
            f"{folder} cannot be made a folder: {there} {what}.", "Name another folder with -o."
        )


def _make_folder(folder: Path) -> None:
    from printprep.errors import OutputError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise OutputError(
            f"{folder} cannot be made a folder: {reason}.", "Name another folder with -o."
        ) from error
