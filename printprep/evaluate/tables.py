"""Write the tables: CSV for each model and method, JSON of everything, Markdown to read."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from printprep.evaluate.measured import Measured
from printprep.evaluate.methods import ABLATIONS, MAIN, Method
from printprep.evaluate.published import PUBLISHED, SOURCE, Published
from printprep.evaluate.run import Evaluation
from printprep.evaluate.summary import Summary, compare, summary
from printprep.files import write_atomically
from printprep.output.numbers import to_text

HEAD = (
    "method", "data set", "Mas", "mass ratio", "Stable %", "Rot °", "tilt °", "F-score", "Chamfer",
    "seconds",
)  # fmt: skip
_VOXELS = {
    "surface": "every voxel the surface passes through in the shell",
    "centre": "voxels whose centre is inside, the outermost in the shell",
}
_PAIRS = (
    ("lean", "paper"),
    ("lean-full-base", "paper"),
    ("lean-at-paper-tilt", "paper"),
    ("lean-no-base", "paper-no-base"),
)


def write_tables(evaluation: Evaluation, folder: Path) -> tuple[Path, ...]:
    """Write table.csv, results.json and tables.md into ``folder``, over older ones."""
    contents = {
        "table.csv": csv_text(evaluation.results),
        "results.json": to_text(as_json(evaluation)) + "\n",
        "tables.md": markdown(evaluation),
    }
    for name, text in contents.items():
        write_atomically(folder / name, text.encode("utf-8"))
    return tuple(folder / name for name in contents)


def csv_text(results: Sequence[Measured]) -> str:
    """CSV with a line for every model and method; a cell without a value is empty."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    names = [field.name for field in fields(Measured)]
    writer.writerow(names)
    for row in results:
        values = [getattr(row, name) for name in names]
        writer.writerow(["" if value is None else value for value in values])
    return out.getvalue()


def as_json(evaluation: Evaluation) -> dict[str, Any]:
    """Everything as JSON, by the names of the fields."""
    compared = [compare(mine, other, evaluation.results) for mine, other in _PAIRS]
    return {
        "data_set": evaluation.data_set.label,
        "voxels": evaluation.voxels,
        "methods": {method.name: method.described() for method in evaluation.methods},
        "summaries": [asdict(one) for _, one in _summaries(evaluation)],
        "comparisons": [asdict(one) for one in compared if one is not None],
        "results": [asdict(row) for row in evaluation.results],
        "failures": {name: error.message for name, error in evaluation.failures},
        "published": [asdict(row) for row in PUBLISHED],
        "published_source": SOURCE,
    }


def markdown(evaluation: Evaluation) -> str:
    """The tables as Markdown: methods, ablations if any, comparisons, failures."""
    label, count = evaluation.data_set.label, len(evaluation.data_set.cases)
    found = {method.name: (method, one) for method, one in _summaries(evaluation)}
    resolution = evaluation.methods[0].settings.resolution
    reaches = {method.settings.base_reach for method in evaluation.methods if method.name in MAIN}
    wide = "up to and including" if reaches == {"within"} else "below"
    lines = [
        f"Data set: {label} ({count} models); {resolution}³ voxels, {_VOXELS[evaluation.voxels]}; "
        f"B at distances {wide} ε. The paper's figures come from its own models, not these: "
        f"{SOURCE}.",
        "",
    ]
    lines += _table([found[name] for name in found if name in MAIN], label, "methods")
    if any(name in found for name in ABLATIONS if name not in MAIN):
        lines += ["", "Ablations of the paper's objective:", ""]
        lines += _table([found[name] for name in ABLATIONS if name in found], label, "ablations")
    lines += ["", *_compared(evaluation)]
    lines += [f"- {name}: {error.message}" for name, error in evaluation.failures]
    return "\n".join(lines).rstrip() + "\n"


def _summaries(evaluation: Evaluation) -> Iterator[tuple[Method, Summary]]:
    for method in evaluation.methods:
        one = summary(method.name, evaluation.results)
        if one is not None:
            yield method, one


def _table(rows: Sequence[tuple[Method, Summary]], label: str, which: str) -> list[str]:
    lines = [_line(HEAD), "|" + "---|" * len(HEAD)]
    for method, one in rows:
        figures = (
            f"{one.mass:.4f}", f"{one.mass_ratio:.3f}", f"{one.stable_percent:.0f}",
            f"{one.rotation_deg:.1f}", f"{one.tilt_deg:.1f}", f"{one.f_score:.4f}",
            f"{one.chamfer:.4f}", f"{one.seconds:.2f}",
        )  # fmt: skip
        lines.append(_line((method.title, label, *figures)))
        beside = [row for row in PUBLISHED if (row.method, row.table) == (method.name, which)]
        lines += [_published(row) for row in beside]
    return lines


def _published(row: Published) -> str:
    stable = "–" if row.stable_percent is None else f"{row.stable_percent:.0f}"
    title = f"*{row.title} ({row.where})*"
    return _line((title, row.data_set, "–", row.mass_ratio or "–", stable, *["–"] * 5))


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _compared(evaluation: Evaluation) -> Iterator[str]:
    for mine, other in _PAIRS:
        one = compare(mine, other, evaluation.results)
        if one is None:
            continue
        text = (
            f"- `{mine}` against `{other}` on {one.models} models: mean mass ratio "
            f"{one.lighter_percent:.1f} % lower, stands {one.stable_points:+.1f} points, heavier "
            f"on {len(one.heavier)}"
        )
        if one.heavier:
            text += f" ({', '.join(one.heavier)})"
        for what, names in (("falls", one.fell), ("stands", one.rose)):
            if names:
                text += f"; {what} where the other does not: {', '.join(names)}"
        yield text + "."
