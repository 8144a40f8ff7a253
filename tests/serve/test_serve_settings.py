"""Settings from a page become a job, or an error that names them."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from printprep.errors import UsageError
from printprep.pipeline.job import Job
from printprep.pipeline.options import FillOptions, Placement
from printprep.serve.settings import Settings

TEMPLATE = Job(
    Path("a.stl"), Path("a-hollow.3mf"), placement=Placement(pose=2), options=FillOptions(lean="12")
)


def test_settings_change_the_job():
    settings = Settings.of(
        {"wall": " 2,5 ", "lean": "15@90", "fill": "infill", "drains": "3", "pose": "1"}
    )
    job = settings.job(TEMPLATE)
    assert job.overrides == {"wall_mm": 2.5, "drain.count": 3}
    assert (job.placement.pose, job.options.lean, job.options.fill) == (1, "15@90", "infill")


def test_empty_settings_leave_it():
    assert Settings.of({}).job(TEMPLATE) == TEMPLATE


@pytest.mark.parametrize(
    ("data", "named"),
    [
        ([], "not a table"),
        (None, "not a table"),
        ({"walls": "1"}, "no setting walls"),
        ({"wall": 1}, "wall is not a short text"),
        ({"wall": "1" * 41}, "wall is not a short text"),
    ],
)
def test_anything_else_is_refused(data, named):
    with pytest.raises(UsageError, match=named):
        Settings.of(data)


@pytest.mark.parametrize(
    ("data", "named"),
    [
        ({"wall": "thick"}, "wall is not a number"),
        ({"drains": "2.5"}, "drains is not a whole number"),
        ({"pose": "x"}, "pose is not a whole number"),
        ({"fill": "foam"}, "no fill foam"),
    ],
)
def test_a_setting_that_cannot_be_is_named(data, named):
    with pytest.raises(UsageError, match=named):
        Settings.of(data).job(TEMPLATE)


@given(st.text(max_size=20), st.text(max_size=20))
def test_the_command_can_be_copied_into_a_shell(lean, model):
    words = shlex.split(Settings(lean=lean, wall="2").command(model, "p"))
    options = ["--wall", "2", *(["--lean", lean] if lean else [])]
    assert words == ["printprep", "hollow", model, "-p", "p", *options]
