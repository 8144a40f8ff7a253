"""One run of one model as data: what is asked, what comes back, and what is written when."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from closed_form_parts import box
from judges import read_strictly
from manifold3d import Manifold

from printprep.errors import OutputError, UsageError
from printprep.mesh.write import to_bytes
from printprep.output.figures import Figures
from printprep.pipeline.check import check
from printprep.pipeline.job import Job, check_job, run_job
from printprep.pipeline.options import FillOptions, Placement
from printprep.threemf.read import ATTACHMENT, read_3mf

QUICK = FillOptions(resolution=16)


@pytest.fixture
def job(tmp_path: Path) -> Job:
    """Hollow a block of 16 × 16 × 12 mm, coarsely."""
    (tmp_path / "block.stl").write_bytes(to_bytes(box(16, 12), ".stl"))
    return Job(tmp_path / "block.stl", tmp_path / "out.3mf", options=QUICK)


def test_the_file_holds_the_figures_of_the_result(job: Job):
    done = run_job(job)
    assert (done.written, done.plugs, done.verified, done.stopped) == (
        job.output,
        None,
        None,
        False,
    )
    assert done.findings == done.result.findings
    figures = Figures.from_json(read_3mf(job.output).attachments[ATTACHMENT])
    assert figures == done.result.figures()
    mesh, warnings = read_strictly(job.output)
    volume_mm3 = trimesh.Trimesh(mesh.vertices, mesh.faces).volume
    assert volume_mm3 * 1.24e-3 == pytest.approx(figures.mass_g, rel=1e-5) and not warnings


def test_a_job_is_data_and_its_file_the_same_bytes(job: Job, tmp_path: Path):
    job = replace(job, options=replace(QUICK, vaults="none"))
    again = replace(pickle.loads(pickle.dumps(job)), output=tmp_path / "again.3mf")
    run_job(job)
    run_job(again)
    assert again.output.read_bytes() == job.output.read_bytes()


def test_a_finding_at_the_level_keeps_an_older_file_as_it_was(job: Job):
    job.output.write_bytes(b"older")
    done = run_job(replace(job, fail_on="info"))
    assert done.stopped and done.written is None
    assert job.output.read_bytes() == b"older"


def test_a_placement_and_options_arrive(job: Job):
    placement = Placement(up="+x", scale=1.5)
    done = run_job(replace(job, placement=placement, overrides={"wall_mm": 2.0}))
    assert np.ptp(done.result.model.vertices, axis=0) == pytest.approx([18, 24, 24], abs=1e-3)
    assert done.result.profile.wall_mm == 2.0
    assert done.result.wall_min_mm == pytest.approx(2.0, abs=0.05)


def test_plugs_are_written_beside_the_part(job: Job, tmp_path: Path):
    plugs = tmp_path / "plugs.3mf"
    done = run_job(replace(job, profile="resin-standard", plugs=plugs))
    assert done.plugs == plugs and plugs.is_file()
    assert done.result.drainage is not None
    assert len(read_3mf(plugs).faces) >= 12 * len(done.result.drainage.drains)


def test_without_drains_no_plugs_and_a_finding_that_says_so(job: Job, tmp_path: Path):
    """A plate without room for a cavity has nothing to drain."""
    job.model.write_bytes(to_bytes(box(20, 2), ".stl"))
    plugs = tmp_path / "plugs.3mf"
    done = run_job(replace(job, profile="resin-standard", plugs=plugs))
    assert done.plugs is None and not plugs.exists()
    assert "no-plugs" in {item.rule for item in done.findings}


def test_a_simulation_is_part_of_the_result(job: Job):
    done = run_job(replace(job, simulate=True))
    assert done.result.simulation is not None and done.result.simulation.settled.stands


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"output": Path("out.step")}, UsageError, "not a format"),
        ({"output": Path("nowhere/out.3mf")}, OutputError, "does not exist"),
        ({"options": FillOptions(fill="foam")}, UsageError, "foam"),
        ({"options": FillOptions(objective="best")}, UsageError, "best"),
        ({"options": FillOptions(resolution=4)}, UsageError, "resolution"),
        ({"plugs": Path("p.3mf")}, UsageError, "--plugs has no effect"),
        ({"overrides": {"drain.diameter_mm": 3.0}}, UsageError, "makes no drain holes"),
        (
            {"simulate": True, "options": FillOptions(fill="infill")},
            UsageError,
            "cannot be simulated",
        ),
        ({"written_for": "cura", "options": FillOptions(fill="infill")}, UsageError, "cura"),
        ({"output": Path("o.stl"), "verify": True}, UsageError, "only a 3MF"),
        ({"options": FillOptions(slicer=Path("ps"))}, UsageError, "--slicer"),
        ({"profile": "resin-standard", "written_for": "cura"}, UsageError, "cura"),
    ],
)
def test_what_cannot_be_is_found_out_before_the_work(
    job: Job, monkeypatch, tmp_path, change, error, words
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", lambda *_: pytest.fail("worked"))
    asked = replace(job, **change)
    with pytest.raises(error, match=words):
        run_job(asked)
    with pytest.raises(error, match=words):
        check_job(asked)


def test_the_model_is_never_replaced_by_its_part(job: Job):
    with pytest.raises(UsageError, match="is the model, which would be replaced"):
        check_job(replace(job, output=job.model))


def test_check_takes_voxels_as_hollow_does(tmp_path: Path):
    """A block of 20³ voxels of 1 mm in a grid of 64; its edges are bevelled by half a voxel."""
    voxels = np.zeros((64, 64, 64), dtype=bool)
    voxels[20:40, 20:40, 20:40] = True
    np.savez(tmp_path / "block.npz", voxels=voxels)
    found = check(tmp_path / "block.npz", placement=Placement(size_mm=20.0))
    assert found.context.size_mm == pytest.approx((20, 20, 20))
    assert isinstance(found.context.part, Manifold)
    assert found.context.part.volume() == pytest.approx(8000 - 12 * 20 / 8, rel=1e-3)
