"""The models of a batch: which files, where their parts go, and what a part depends on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import InputError, UsageError
from printprep.output.numbers import plain
from printprep.version import __version__

if TYPE_CHECKING:
    from printprep.pipeline.job import Job

SUFFIXES = (".stl", ".obj", ".ply", ".glb", ".3mf", ".npz", ".npy", ".pt")
_GLOB = frozenset("*?[")
_BLOCK = 1 << 20


@dataclass(frozen=True)
class Item:
    """One model: how it was named, its job, and where its part goes below the batch's folder."""

    name: str
    job: Job
    output: str


def found_models(
    inputs: Iterable[str | Path], but: Path | None = None
) -> Iterator[tuple[str, Path, Path]]:
    """Each model of files, folders and patterns: its name, its path, its place below the output.

    A folder gives all models in it, sorted, with its structure kept; a pattern what it matches.
    but : a folder whose files are no models: that of the parts, where it lies among them.

    Raises InputError for a file or folder that is missing, and a pattern that matches nothing.
    """
    for given in inputs:
        path = Path(given)
        if path.is_dir():
            inside = [i for i in sorted(path.rglob("*")) if _is_model(i) and not _below(i, but)]
            if not inside:
                raise InputError(f"{given} holds no model.", f"Models are {', '.join(SUFFIXES)}.")
            for item in inside:
                yield str(item), item, item.relative_to(path)
        elif path.is_file():
            yield str(given), path, Path(path.name)
        elif _GLOB & set(str(given)):
            matched = sorted(_matches(str(given)))
            if not matched:
                raise InputError(f"{given} matches no file.", "Check the pattern.")
            for item in matched:
                yield str(item), item, Path(item.name)
        else:
            raise InputError(f"{given} does not exist.", "Name a file, a folder or a pattern.")


def _below(path: Path, folder: Path | None) -> bool:
    return folder is not None and folder.absolute() in path.absolute().parents


def _is_model(path: Path) -> bool:
    return path.is_file() and path.suffix.lower() in SUFFIXES


def _matches(pattern: str) -> Iterator[Path]:
    import glob

    names = glob.glob(pattern, recursive=True)  # noqa: PTH207  (a pattern with its folder)
    return (Path(name) for name in names if Path(name).is_file())


def items_of(
    models: Iterable[tuple[str, Path, Path]], template: Job, folder: Path, suffix: str = ".3mf"
) -> tuple[Item, ...]:
    """The items of models that all run with the same options; see :func:`found_models`."""
    return tuple(
        item_of(replace(template, model=path), name, place, folder, suffix)
        for name, path, place in models
    )


def item_of(job: Job, name: str, place: Path, folder: Path, suffix: str = ".3mf") -> Item:
    """One item; its part is named by the model, below the batch's folder."""
    output = place.with_suffix(suffix)
    return Item(name, replace(job, output=folder / output), output.as_posix())


def with_plugs(item: Item) -> Item:
    """The item with plugs for its part's drain holes written beside it."""
    plugs = item.job.output.with_name(f"{item.job.output.stem}-plugs.3mf")
    return replace(item, job=replace(item.job, plugs=plugs))


def with_report(item: Item) -> Item:
    """The item with a page about its part written beside it."""
    report = item.job.output.with_suffix(".html")
    return replace(item, job=replace(item.job, report=report))


def refuse_clashes(items: Sequence[Item]) -> None:
    """Raise UsageError where two parts would be one file, on a system that ignores case too."""
    seen: dict[str, Item] = {}
    for item in items:
        for path in (item.job.output, item.job.plugs, item.job.report):
            other = item if path is None else seen.setdefault(str(path).casefold(), item)
            if other is not item:
                raise UsageError(
                    f"{other.name} and {item.name} would both be written as {path}.",
                    "Rename one, or give their folder instead: its structure is kept.",
                )


def key_of(job: Job) -> str:
    """Hash of all that a job's part depends on: file, options, profile, version.

    The file's name counts, not its folder: it is the part's name.  "" where there is no file.
    """
    from printprep.profiles import load_profile

    try:
        content = sha256_of(job.model)
    except OSError:
        return ""
    profile = load_profile(job.profile, job.overrides)
    model, output = Path(job.model.name), Path(job.output.suffix)
    same = replace(
        job, model=model, output=output, plugs=None, report=None, profile="", overrides={}
    )
    asked = {
        "version": __version__,
        "model": content,
        "options": plain(same),
        "profile": profile.model_dump(mode="json"),
    }
    return hashlib.sha256(json.dumps(asked, sort_keys=True, default=str).encode()).hexdigest()


def sha256_of(path: Path) -> str:
    """Of a file's content, read in blocks.  Raises OSError."""
    found = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            found.update(block)
    return found.hexdigest()
