"""Which models are evaluated: a folder of them, or a catalogue that names them."""

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

    name : the file's stem, the whole file name where two share a stem;  up : its axis that is up.
    """

    name: str
    path: Path
    up: str


@dataclass(frozen=True)
class DataSet:
    """Models under one label, which every table carries.

    label : the folder's or the catalogue's name, with the catalogue's set.
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
    """The models of a folder, or of a catalogue.

    Parameters
    ----------
    source : a folder, of which every mesh is taken in the order of names; or a CSV file with a
        column ``file``, and if it likes ``up`` and ``set``.  A row's file is looked for beside the
        catalogue, in the folder named by its set if it has one.
    subset : of a catalogue, the rows whose ``set`` this is.
    up : axis that is up, where no catalogue says.
    only : names of models to keep;  limit : how many to keep of those.

    Raises
    ------
    InputError : the source is missing or cannot be read as such, or holds no model.
    UsageError : a subset of a folder, an unknown axis, a name in ``only`` that is not there.
    """
    rotation(up)
    if source.is_dir():
        if subset is not None:
            raise UsageError(f"--set {subset}: {source} is a folder.", "Name a catalogue instead.")
        paths = [path for path in source.iterdir() if path.suffix.lower() in SUFFIXES]
        rows = [(path, up) for path in sorted(paths)]
        label = source.resolve().name
    else:
        rows = _catalogue(source, subset, up)
        label = source.stem if subset is None else f"{source.stem}, set {subset}"
    if not rows:
        raise InputError(
            f"{source} names no model{'' if subset is None else f' of the set {subset}'}.",
            f"Models are files with one of {', '.join(SUFFIXES)}.",
        )
    stems = Counter(path.stem for path, _ in rows)
    cases = [
        Case(path.stem if stems[path.stem] == 1 else path.name, path, axis) for path, axis in rows
    ]
    return DataSet(label, _chosen(cases, only, limit))


def _catalogue(path: Path, subset: str | None, up: str) -> list[tuple[Path, str]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as handle:
            rows = list(csv.DictReader(handle))
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Name a folder or a catalogue.") from error
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read as CSV: {error}.") from error
    found = []
    for number, row in enumerate(rows, start=2):
        group = row.get("set") or ""
        if subset is not None and group != subset:
            continue
        name = row.get("file")
        if not name:
            raise InputError(
                f"{path}, line {number} names no file.", "A catalogue needs a column `file`."
            )
        axis = row.get("up") or up
        rotation(axis)
        found.append((path.parent / group / name, axis))
    return found


def _chosen(cases: list[Case], only: Sequence[str], limit: int | None) -> tuple[Case, ...]:
    missing = sorted(set(only) - {case.name for case in cases})
    if missing:
        raise UsageError(
            f"--only {missing[0]}: there is no model of that name.",
            "Names are those of the files, without the suffix.",
        )
    if limit is not None and limit < 1:
        raise UsageError(f"--limit {limit}: give a whole number of at least 1.")
    kept = [case for case in cases if not only or case.name in only]
    return tuple(kept[:limit])
