"""Drains from model to file: weighed, standing, the same each time, and judged by PrusaSlicer."""

from __future__ import annotations

import io

import lib3mf
import numpy as np
import pytest
import trimesh
from drain_measures import hole_diameter_mm
from manifold3d import Manifold, OpType
from sl1_layers import judged_with_and_without

from printprep.mesh.quantize import quantized
from printprep.output.part_file import part_bytes
from printprep.output.plugs import plugs_3mf
from printprep.pipeline.hollow import hollow

# One worker drains the tower for all of them
pytestmark = pytest.mark.xdist_group("drained tower")


@pytest.fixture(scope="module")
def tower() -> trimesh.Trimesh:
    """A block 24 mm square and 60 mm high with a boss on one side, which has a floor of its own.

    The boss hangs over.
    """
    block = trimesh.creation.box((24, 24, 60))
    boss = trimesh.creation.box((20, 20, 16)).apply_translation((20, 0, 18))
    return trimesh.boolean.union([block, boss], engine="manifold")


@pytest.fixture(scope="module")
def result(tower):
    return hollow(tower, profile="resin-standard", base="never", lean=12.0)


def test_it_drains_and_stands_with_its_holes_weighed(result):
    drains = result.drainage.drains
    assert {drain.role for drain in drains} == {"outlet", "vent"}
    part = result.part.manifold
    assert result.mass_g == pytest.approx(part.volume() * 1.15 / 1000)
    assert result.stability.tilt_deg >= 12.0
    # Only as far as it must where it had to be solved for
    assert result.stability.tilt_deg < 12.0 + 1.5 or result.density.planes == (None,)
    assert all(shell.volume() > 0 for shell in part.decompose())
    for drain in drains:
        assert hole_diameter_mm(part, drain) == pytest.approx(3.5, abs=0.05)
        assert np.linalg.norm(drain.axis) == pytest.approx(1.0)


def plugs_of(result):
    return plugs_3mf(result.part, result.drainage, result.profile)


@pytest.mark.slicer
@pytest.mark.usefixtures("prusa_slicer")
def test_the_layers_of_a_slicer_hold_nothing_shut(result):
    part = result.part
    undrained = quantized(Manifold.batch_boolean([part.outside, *part.cavities], OpType.Subtract))
    drained, sealed = judged_with_and_without(part.manifold, undrained)
    assert (drained.trapped_mm3, drained.cups) == (0.0, 0)
    cavity_mm3 = sum(cavity.volume() for cavity in part.cavities)
    assert sealed.trapped_mm3 == pytest.approx(cavity_mm3, rel=0.05) and sealed.cups >= 1


def test_the_same_bytes_each_time(tower, result):
    again = hollow(tower, profile="resin-standard", base="never", lean=12.0)
    assert part_bytes(again.contents(), ".stl") == part_bytes(result.contents(), ".stl")
    assert plugs_of(again) == plugs_of(result)


def test_plugs_are_objects_of_their_own_to_a_strict_reader(result, tmp_path):
    path = tmp_path / "plugs.3mf"
    path.write_bytes(plugs_of(result))
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    objects, count = model.GetMeshObjects(), 0
    while objects.MoveNext():
        count += 1
        assert objects.GetCurrentMeshObject().IsManifoldAndOriented()
    assert count == len(result.drainage.drains)
    scene = trimesh.load(io.BytesIO(path.read_bytes()), file_type="3mf")
    assert scene.bounds[0][2] == pytest.approx(0.0, abs=1e-4)


def test_no_drains_leave_the_cavity_sealed(tower):
    sealed = hollow(tower, profile="resin-standard", base="never", drains=0)
    assert sealed.drainage is None
    assert any(shell.volume() < 0 for shell in sealed.part.manifold.decompose())
    assert any(item.rule == "sealed-cavity" for item in sealed.findings)


def test_filament_drains_only_where_asked(tower):
    asked = hollow(
        tower, base="never", vaults="none", drains=2, drain_diameter_mm=4.0, resolution=32
    )
    assert asked.drainage is not None and len(asked.drainage.drains) >= 2
    assert {drain.diameter_mm for drain in asked.drainage.drains} == {4.0}
