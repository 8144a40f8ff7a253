"""A part is taken apart by purpose: areas and volumes that are known by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from closed_form_parts import box, hollow_result
from manifold3d import Manifold

from printprep.mesh.measure import area_normals
from printprep.page.meshes import PART_LAYERS, meshes_of, simplified
from printprep.page.shape import Shape, shape_of_part, shape_of_result
from printprep.pipeline.hollow import hollow
from printprep.profiles import load_profile
from printprep.types import Drain

SIDE = 16.0  # of the cavity in a block of 20 mm with walls of 2 mm


def areas(mesh) -> dict[str, float]:
    area = np.linalg.norm(area_normals(mesh.vertices[mesh.faces]), axis=1) / 2
    return {
        name: float(area[mesh.classes == number].sum()) for number, name in enumerate(mesh.layers)
    }


def drilled_block() -> tuple[Manifold, Drain, float]:
    """The block with a hole of 3 mm through its right wall, and the hole's area."""
    radius = 1.5
    bore = Manifold.cylinder(4.0, radius, circular_segments=64).rotate((0, 90, 0))
    bore = bore.translate((7.0, 0.0, 10.0))
    drain = Drain("outlet", 0, (10.0, 0.0, 10.0), (1.0, 0.0, 0.0), 2 * radius, 2.0)
    area = 64 / 2 * radius**2 * math.sin(2 * math.pi / 64)
    return box(20.0) - box(SIDE, z=2.0) - bore, drain, area


def test_a_hollow_block_by_layers():
    found = areas(meshes_of(shape_of_result(hollow_result()), 2.0).meshes[0])
    assert found["cavity"] == pytest.approx(6 * SIDE**2)
    assert found["outside"] == pytest.approx(6 * 20.0**2)
    assert found["base"] == found["vaults"] == found["ballast"] == found["drains"] == 0


def test_its_base_is_a_layer_and_a_solid():
    """The base is a ring 2 mm wide and 1 mm high around the block's foot."""
    shape = shape_of_result(hollow_result(with_base=True))
    ring = 24.0**2 - 20.0**2
    assert shape.base.volume() == pytest.approx(ring)
    meshes = meshes_of(shape, 2.0).meshes
    assert [mesh.name for mesh in meshes] == ["part", "base"]
    found = areas(meshes[0])
    assert found["base"] == pytest.approx(2 * ring + 4 * 24.0 * 1.0)
    assert found["outside"] == pytest.approx(2 * 20.0**2 + 4 * 20.0 * 19.0)


def test_a_written_part_is_taken_apart_the_same_way():
    """Its cavity is found in the mesh; its base is all that lies below the seat."""
    result = hollow_result(with_base=True, profile=load_profile(overrides={"wall_mm": 2.0}))
    shape = shape_of_part(result.part.manifold, result.figures(), result.profile)
    assert sum(void.volume() for void in shape.cavities) == pytest.approx(SIDE**3, rel=1e-6)
    assert shape.outside.volume() == pytest.approx(8000 + 176, rel=1e-6)
    assert shape.base.volume() == pytest.approx(24.0**2 * 1.0, rel=1e-5)
    assert areas(meshes_of(shape, 2.0).meshes[0])["cavity"] == pytest.approx(6 * SIDE**2, rel=1e-6)


def test_a_drain_hole_is_closed_to_find_the_cavity():
    part, drain, area = drilled_block()
    result = hollow_result()
    figures = replace(result.figures(), drains=_drains(drain))
    shape = shape_of_part(part, figures, result.profile)
    assert shape.outside.volume() == pytest.approx(8000, rel=1e-6)
    # The stopper is 1.02 times as wide as the hole, and reaches a diameter into the cavity
    stopper = area * 1.02**2 * 3.0
    cavity = sum(void.volume() for void in shape.cavities)
    assert cavity == pytest.approx(SIDE**3 - stopper, rel=1e-3)
    (plug,) = shape.plugs
    assert 0 < plug.volume() < area * 2.0
    bore = areas(meshes_of(shape, 2.0).meshes[0])["drains"]
    assert bore == pytest.approx(2 * math.pi * 1.5 * 2.0, rel=2e-3)


def _drains(drain: Drain):
    from printprep.output.figures import Drains

    return Drains(1, (drain,), 0.0, ())


def test_voids_that_the_model_brought_stay_outside():
    """The part has one cavity of its own: the smaller void is the model's."""
    part = box(40.0) - box(20.0, z=2.0) - box(6.0, z=30.0)
    result = hollow_result()
    shape = shape_of_part(part, result.figures(), result.profile)
    assert shape.outside.volume() == pytest.approx(40.0**3 - 6.0**3)
    assert sum(void.volume() for void in shape.cavities) == pytest.approx(20.0**3)


def test_thickness_is_that_of_the_wall():
    """On the faces of the block, away from its edges, the wall is 2 mm thick."""
    mesh = meshes_of(shape_of_result(hollow_result()), 2.0).meshes[0]
    place = mesh.vertices
    side = (
        (np.abs(place[:, 0]) > 9.999) & (np.abs(place[:, 1]) < 6) & (np.abs(place[:, 2] - 10) < 6)
    )
    assert side.sum() > 20
    assert np.abs(mesh.thickness_mm[side] - 2.0).max() < 1e-6


def test_thickness_is_told_up_to_four_walls():
    mesh = meshes_of(Shape(box(7.0), box(7.0), ()), 2.0).meshes[0]
    middle = np.abs(mesh.vertices[:, :2]).max(axis=1) < 2
    assert middle.any()
    assert np.abs(mesh.thickness_mm[middle] - 7.0).max() < 1e-6
    thick = meshes_of(Shape(box(30.0), box(30.0), ()), 2.0).meshes[0]
    middle = np.abs(thick.vertices[:, :2]).max(axis=1) < 5
    assert np.abs(thick.thickness_mm[middle] - 8.0).max() < 1e-6


def test_a_fine_part_is_simplified_and_says_so():
    ball = Manifold.sphere(40.0, 300)
    meshes = meshes_of(Shape(ball, ball, ()), 2.0, most=10_000)
    assert meshes.triangles == ball.num_tri() > 10_000 >= meshes.shown
    assert 0 < meshes.moved_mm < 0.5
    radius = np.linalg.norm(meshes.meshes[0].vertices, axis=1)
    assert 40.0 - radius.min() <= meshes.moved_mm + 0.05


def test_a_coarse_part_is_not():
    ball = Manifold.sphere(40.0, 40)
    assert simplified(ball, 300_000) == (ball, 0.0)


@pytest.mark.slow
def test_vaults_and_ballast_of_a_real_part(samples_dir):
    """What lies inside the wall is cavity, vaults or ballast, in the part and in its file."""
    result = hollow(samples_dir / "spot.stl", size_mm=60, lean=25, resolution=40)
    shape = shape_of_result(result)
    deep = result.workings.deep.volume()
    inside = sum(void.volume() for void in shape.cavities)
    assert inside + shape.vaults.volume() + shape.ballast.volume() == pytest.approx(deep, rel=0.01)
    assert shape.vaults.volume() == pytest.approx(result.supports.added_mm3, rel=0.01)
    again = shape_of_part(result.part.manifold, result.figures(), result.profile)
    assert sum(v.volume() for v in again.cavities) == pytest.approx(inside, rel=1e-3)
    known = {name: getattr(shape, name).volume() for name in ("vaults", "ballast")}
    found = {name: getattr(again, name).volume() for name in ("vaults", "ballast")}
    # A written part does not say where a vault ends inside ballast
    assert sum(found.values()) == pytest.approx(sum(known.values()), rel=0.15)
    mine, theirs = (areas(meshes_of(s, 2.0).meshes[0]) for s in (shape, again))
    for name in PART_LAYERS:
        assert theirs[name] == pytest.approx(mine[name], rel=0.1, abs=0.02 * sum(mine.values()))
