"""The models to evaluate: those of a folder, or of a catalogue that lists them."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from printprep.errors import InputError, UsageError
from printprep.mesh.place import rotation
from printprep.mesh.read import SUFFIXES


@dataclass(frozen=True)
class Case:
    """One model.

    name : the file's stem, or the whole file name where two share a stem;  up : the axis that is
    up.
    """

    name: str
    path: Path
    up: str


@dataclass(frozen=True)
class DataSet:
    """Models under one label, for the tables.

    label : the name of the folder or of the catalogue, with the catalogue's set.
    """

    label: str
    cases: tuple[Case, ...]


def data_set(
    source: Path,
    *,
    subset: str | None = None,
    up: str = "+z",
    only: Sequence[str] = (),
    limit: int | None = None,
) -> DataSet:
    """List the models of a folder, or of a catalogue.

    Parameters
    ----------
    source : a folder, whose meshes are taken in the order of their names; or a CSV file with a
        column ``file``, and optional columns ``up`` and ``set``.  A row's file lies beside the
        catalogue, in the folder named by its set if it has one.
    subset : of a catalogue, the rows with this ``set``.
    up : the axis that is up, where the catalogue gives none.
    only : names of models to keep;  limit : how many of them.

    Raises
    ------
    InputError : the source does not exist, cannot be read, or holds no model.
    UsageError : a subset of a folder, an unknown axis, or an unknown name in ``only``.
    """
    rotation(up)
    if source.is_dir():
        if subset is not None:
            raise UsageError(
                f"--set {subset}: {source} is a folder.", "Use a catalogue, or leave out --set."
            )
        paths = [path for path in source.iterdir() if path.suffix.lower() in SUFFIXES]
        rows = [(path, up) for path in sorted(paths)]
        label = source.resolve().name
    else:
        rows = _catalogue(source, subset, up)
        label = source.stem if subset is None else f"{source.stem}, set {subset}"
    if not rows:
        raise InputError(
            f"{source} holds no model{'' if subset is None else f' of the set {subset}'}.",
            f"Models are files of type {', '.join(SUFFIXES)}.",
        )
    stems = Counter(path.stem for path, _ in rows)
    cases = [
        Case(path.stem if stems[path.stem] == 1 else path.name, path, axis) for path, axis in rows
    ]
    return DataSet(label, _chosen(cases, only, limit))


def _catalogue(path: Path, subset: str | None, up: str) -> list[tuple[Path, str]]:
    """The files that a catalogue lists, each with its axis that is up."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as handle:
            rows = list(csv.DictReader(handle))
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Use a folder or a catalogue.") from error
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            f"{path} cannot be read as CSV: {error}.", "Save the catalogue as CSV in UTF-8."
        ) from error
    found = []
    for number, row in enumerate(rows, start=2):
        group = row.get("set") or ""
        if subset is not None and group != subset:
            continue
        name = row.get("file")
        if not name:
            raise InputError(
                f"{path}, line {number} has no file.", "A catalogue needs a column `file`."
            )
        axis = row.get("up") or up
        rotation(axis)
        found.append((path.parent / group / name, axis))
    return found


def _chosen(cases: list[Case], only: Sequence[str], limit: int | None) -> tuple[Case, ...]:
    """The cases of these names, up to the limit."""
    missing = sorted(set(only) - {case.name for case in cases})
    if missing:
        raise UsageError(
            f"--only {missing[0]}: no model has that name.",
            "Use names of files, without the suffix.",
        )
    if limit is not None and limit < 1:
        raise UsageError(f"--limit {limit} is too small.", "Use a whole number of at least 1.")
    kept = [case for case in cases if not only or case.name in only]
    return tuple(kept[:limit])
