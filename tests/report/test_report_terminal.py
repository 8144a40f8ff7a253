"""The summary: 80 columns, readable without colour, what matters and no more."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from closed_form_parts import box, context, hollow_box, hollow_result
from rich.console import Console

from printprep.check import run_rules
from printprep.pipeline.check import Checked
from printprep.profiles import load_profile
from printprep.report.terminal import show_check, show_result
from printprep.types import Finding, Repair, Stability


def summary(result, *, output="out.3mf", verbose=False) -> str:
    stream = io.StringIO()
    show_result(Console(file=stream, width=80), result, output=output, verbose=verbose)
    return stream.getvalue()


def flat(text: str) -> str:
    return " ".join(text.split())


def test_it_names_what_changed_and_where_the_file_is():
    text = flat(summary(hollow_result()))
    for fact in (
        "9.92 g → 4.84 g (49 % of the solid)",
        "45.0° → 45.0°; should stand at 10°",
        "2.00 mm (profile: 1.2 mm)",
        "cavities 1, 4.1 cm³",
        "no filling of its voxels under 4.9 g stands at 10.5° (gap 2e-10)",
        "base none",
        "Written: out.3mf",
        "first layer of 0.2 mm, a 0.4 mm nozzle and PLA",
        "they start from the build plate only",
    ):
        assert fact in text


def test_it_fits_80_columns_and_carries_no_escape_codes():
    finding = Finding("tilt", "error", "word " * 60, "do " * 60)
    text = summary(hollow_result(with_base=True, findings=(finding,)), verbose=True)
    assert max(len(line) for line in text.splitlines()) <= 80
    assert "\x1b" not in text


def test_a_long_path_is_kept_whole_to_be_copied():
    path = "/".join(["folder"] * 20) + "/out.3mf"
    assert path in summary(hollow_result(), output=path)


def test_brackets_in_names_are_not_markup():
    assert "[bold]x[/bold].3mf" in summary(hollow_result(), output="[bold]x[/bold].3mf")


def test_what_the_user_need_not_know_is_not_said():
    text = summary(hollow_result())
    for word in ("repair", "seconds", "sealed", "solved for"):
        assert word not in text


def test_verbose_adds_seconds_and_the_angle_solved_for():
    text = flat(summary(hollow_result(), verbose=True))
    assert "seconds 1.01 (read 0.01, solve 1.00)" in text
    assert "10.50°" in text


def test_repair_is_told_when_there_was_one():
    solid = hollow_result().solid
    text = flat(
        summary(hollow_result(solid=replace(solid, repair=Repair("union", ("joined 2.",), 0.01))))
    )
    assert "repair joined 2; surface moved by up to 0.01 mm" in text


def test_findings_come_with_their_way_out_and_id():
    finding = Finding("tilt", "error", "It tips.", "Use a base.")
    text = flat(summary(hollow_result(findings=(finding,))))
    assert "error It tips. → Use a base. [tilt]" in text


def test_base_and_falling_are_told():
    nothing = Stability(np.zeros((0, 2)), 0.0, (0, 0, 0), None, None, None)
    falling = replace(hollow_result().stability, tilt_deg=-3.0)
    text = flat(summary(hollow_result(with_base=True, stability_solid=nothing, stability=falling)))
    assert "no contact → -3.0° (falls over by itself)" in text
    assert "seat 1 mm high, footprint grown by 2 mm, 0.218 g" in text


@pytest.mark.parametrize(
    ("grams", "words"),
    [
        (39834.2, "39.8 kg"), (1.5e6, "1500 kg"), (123.45, "123.5 g"), (4.8411, "4.84 g"),
        (0.0234, "23.4 mg"),
    ],
)  # fmt: skip
def test_masses_are_written_as_people_write_them(grams, words):
    assert f"→ {words} (" in flat(summary(hollow_result(mass_g=grams)))


def test_a_proof_only_where_something_stands():
    density = hollow_result().density
    falls = replace(density, reachable_deg=-2.0)
    assert "proof" not in summary(hollow_result(density=falls))
    paper = replace(density, aim_deg=None, certificate=None)
    assert "proof" not in summary(hollow_result(density=paper))


def test_advice_is_for_fdm_and_for_a_3mf():
    assert "Print it with" not in summary(hollow_result(profile="resin-standard"))
    bare = summary(hollow_result(), output="out.stl")
    assert "Print it with" in bare
    assert "build plate" not in bare


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (hollow_box, ("size 20 × 20 × 20 mm", "thinnest wall 2.00 mm", "cavities 1")),
        (lambda size, wall: box(size), ("cavities none", "No issues found")),
    ],
)
def test_check_summary(part, words):
    profile = load_profile("fdm-pla-0.4")
    examined = context(part(20, 2))
    stream = io.StringIO()
    show_check(
        Console(file=stream, width=80),
        Checked(examined, run_rules(examined, profile), profile),
        verbose=False,
    )
    for word in words:
        assert word in flat(stream.getvalue())
