"""Means, comparisons and the shape of what is written."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import fields
from pathlib import Path

import pytest

from printprep.errors import InputError
from printprep.evaluate.cases import Case, DataSet
from printprep.evaluate.measured import Measured
from printprep.evaluate.methods import methods
from printprep.evaluate.run import Evaluation
from printprep.evaluate.summary import compare, summary
from printprep.evaluate.tables import HEAD, as_json, csv_text, markdown, write_tables


def row(model: str, method: str, ratio: float, *, stands: bool = True, **more) -> Measured:
    values = {
        "mass": ratio / 4, "rotation_deg": 0.0 if stands else 90.0, "tilt_deg": 20.0,
        "f_score": 1.0, "chamfer": 0.01, "lean_deg": None, "reachable_deg": None, "seconds": 0.5,
    }  # fmt: skip
    return Measured(model=model, method=method, mass_ratio=ratio, stands=stands, **values | more)


ROWS = (
    row("a", "paper", 0.6),
    row("a", "lean", 0.3, lean_deg=10.0, tilt_deg=10.0),
    row("b", "paper", 0.4, stands=False),
    row("b", "lean", 0.45, lean_deg=10.0, reachable_deg=6.0, tilt_deg=5.0),
)
CASES = (Case("a", Path("a.obj"), "+z"), Case("b", Path("b.obj"), "+z"))


def evaluation(*, ablations: bool = False, rows=ROWS, failures=()) -> Evaluation:
    chosen = methods(["paper", "lean"], ablations=ablations)
    return Evaluation(DataSet("two boxes", CASES), chosen, "centre", rows, failures)


def test_a_summary_is_a_mean():
    one = summary("lean", ROWS)
    assert one.models == 2 and one.out_of_reach == 1
    assert one.mass_ratio == pytest.approx(0.375)
    assert one.mass == pytest.approx(0.375 / 4)
    assert one.tilt_deg == 7.5
    assert (one.stable_percent, summary("paper", ROWS).stable_percent) == (100.0, 50.0)
    assert summary("paper", ROWS).rotation_deg == 45.0
    assert summary("solid", ROWS) is None


def test_a_comparison_names_who_differs():
    one = compare("lean", "paper", ROWS)
    assert one.lighter_percent == pytest.approx(25.0)
    assert one.stable_points == 50.0
    assert (one.heavier, one.rose, one.fell) == (("b",), ("b",), ())
    back = compare("paper", "lean", ROWS[:2])
    assert back.models == 1 and back.heavier == ("a",)
    assert compare("lean", "solid", ROWS) is None


def test_the_csv_has_a_line_for_each():
    lines = list(csv.DictReader(io.StringIO(csv_text(ROWS))))
    assert list(lines[0]) == [field.name for field in fields(Measured)]
    assert [(line["model"], line["method"]) for line in lines] == [
        (one.model, one.method) for one in ROWS
    ]
    assert lines[0]["lean_deg"] == "" and float(lines[1]["lean_deg"]) == 10.0
    assert lines[2]["stands"] == "False"


def test_the_page_labels_every_row_with_its_data_set():
    text = markdown(evaluation())
    table = [line for line in text.splitlines() if line.startswith("|")]
    assert table[0] == "| " + " | ".join(HEAD) + " |"
    for line in table[2:]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        assert len(cells) == len(HEAD)
        assert cells[1] == ("the paper's generated models" if "*" in cells[0] else "two boxes")
    assert "| 0.0938 | 0.375 | 100 | 0.0 | 7.5 | 1.0000 | 0.0100 | 0.50 |" in text
    assert "up to 43 % less mass" in text and "Ablations" not in text
    assert "`lean` against `paper` on 2 models: mean mass ratio 25.0 % lower" in text
    assert "heavier on 1 (b); stands where the other does not: b." in text


def test_ablations_have_a_table_of_their_own():
    extra = (*ROWS, row("a", "paper-no-region", 0.5), row("a", "paper-no-base", 0.55))
    text = markdown(evaluation(ablations=True, rows=extra))
    _, _, below = text.partition("Ablations")
    assert "without L_region" in below and "| 87 |" in below and "| 75 |" in below
    assert "lightest" not in below


def test_failures_are_told():
    failed = (("b", InputError("b.obj is empty.")),)
    text = markdown(evaluation(rows=ROWS[:2], failures=failed))
    assert "- b: b.obj is empty." in text
    assert as_json(evaluation(rows=ROWS[:2], failures=failed))["failures"] == {
        "b": "b.obj is empty."
    }


def test_three_files_are_written(tmp_path):
    written = write_tables(evaluation(), tmp_path)
    assert [path.name for path in written] == ["table.csv", "results.json", "tables.md"]
    stored = json.loads((tmp_path / "results.json").read_text())
    assert len(stored["results"]) == 4
    assert stored["data_set"] == "two boxes"
    assert stored["methods"]["lean"]["lean_deg"] == 10.0
    assert "lean_deg" not in stored["methods"]["paper"]
    assert stored["comparisons"][0]["heavier"] == ["b"]
