"""The support blocker: between a layer below the outside and a layer above the cavities."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box, cylinder, solid
from support_inside import supports_g

from printprep import hollow
from printprep.cavity.surface import cavity_surface
from printprep.check.walls import united
from printprep.errors import UsageError
from printprep.grid.depth import measure_depths
from printprep.mesh.measure import arrays
from printprep.profiles import Profile, load_profile
from printprep.slicer.process import find_slicer
from printprep.supports.blocker import (
    MARGIN_MM,
    depth_mm,
    support_blocker,
    tallest_step_mm,
    without_bores,
)

PROFILE = load_profile("fdm-pla-0.4")


def blocked(body: Manifold, profile: Profile = PROFILE) -> tuple[Manifold | None, Manifold]:
    """The blocker of a solid, and all that may be its cavity."""
    depths = measure_depths(
        solid(body), resolution=32, wall_mm=profile.wall_mm, min_feature_mm=profile.min_feature_mm
    )
    assert depths.field is not None
    volume = cavity_surface(body, depths.field, profile.wall_mm)
    return support_blocker(body, depths.field, volume, profile), volume


def keeps_its_limits(body: Manifold, blocker: Manifold, volume: Manifold) -> None:
    step_mm = tallest_step_mm(PROFILE)
    assert depth_mm(blocker, body)[0] >= step_mm + MARGIN_MM
    for rise_mm in (0.0, step_mm / 2, step_mm):
        assert (volume.translate((0, 0, rise_mm)) - blocker).volume() < 1e-3


def test_a_box_is_blocked_half_a_wall_deep():
    body = box(24, 20, 16)
    blocker, volume = blocked(body)
    assert blocker is not None
    keeps_its_limits(body, blocker, volume)
    # Exactly half a wall on every side, but for edges that the field's cells round off.
    assert blocker.volume() == pytest.approx((24 - 1.2) * (20 - 1.2) * (16 - 1.2), rel=0.02)
    assert blocker.num_tri() < 400


@examples(6)
@given(
    st.floats(6, 14), st.floats(6, 14), st.floats(6, 14), st.floats(0, 90), st.floats(0, 90),
    st.booleans(),
)  # fmt: skip
def test_any_solid_keeps_its_limits(a, b, c, tilt, turn, waisted):
    body = Manifold.sphere(1, 48).scale((a, b, c)).rotate((tilt, 0, turn))
    if waisted:
        body = body - cylinder(3, 60, 48).translate((a, 0, -30))
    body = body.translate((0, 0, -body.bounding_box()[2]))
    blocker, volume = blocked(body)
    assert blocker is not None
    keeps_its_limits(body, blocker, volume)


def test_a_limb_too_thin_for_a_cavity_has_no_blocker():
    body = box(20, 20, 20) + box(40, 2, 2).translate((20, 0, 0))
    blocker, _ = blocked(body)
    assert blocker is not None and blocker.bounding_box()[3] < 14


def test_walls_of_two_layers_are_too_thin_for_a_blocker():
    profile = load_profile("fdm-pla-0.4", {"wall_mm": 0.6, "printer.layer_height_mm": 0.3})
    assert blocked(box(12, 12, 12), profile)[0] is None


def test_thin_walls_get_vaults_for_the_slicer_unless_the_printer_s_are_asked_for():
    thin = {"wall_mm": 0.6, "printer.layer_height_mm": 0.3}
    cube = trimesh_box()
    made = hollow(cube, overrides=thin, resolution=16)
    assert made.blocker is None
    assert made.supports is not None and made.supports.rule == "slicer"
    with pytest.raises(UsageError, match="too thin for a support blocker"):
        hollow(cube, overrides=thin, resolution=16, vaults="printer")


def trimesh_box():  # type: ignore[no-untyped-def]
    import trimesh

    return trimesh.creation.box((16, 16, 16))


def test_the_ceiling_of_a_drain_hole_is_not_blocked():
    body = box(24, 20, 16)
    blocker, _ = blocked(body)
    assert blocker is not None
    bore = cylinder(2, 30, 64).rotate((0, 90, 0)).translate((0, 0, 8))
    open_ = without_bores(blocker, bore, PROFILE)
    for rise_mm in (0.0, tallest_step_mm(PROFILE)):
        assert (open_ ^ bore.translate((0, 0, rise_mm))).volume() < 0.01
    assert without_bores(blocker, Manifold(), PROFILE) is blocker


def test_the_file_carries_it_and_only_where_it_can(tmp_path: Path):
    made = hollow(trimesh_box(), resolution=16)
    assert made.blocker is not None
    made.write(tmp_path / "part.3mf")
    assert b"SupportBlocker" in config_of(tmp_path / "part.3mf")
    for name, slicer in (("part.stl", "prusa"), ("other.3mf", "cura")):
        with pytest.raises(UsageError, match="carries no support blocker"):
            made.write(tmp_path / name, slicer)
        assert not (tmp_path / name).exists()
        made.write(tmp_path / name, slicer, without_blocker=True)
        assert (tmp_path / name).exists()
    plain = hollow(trimesh_box(), resolution=16, vaults="slicer")
    assert plain.blocker is None
    plain.write(tmp_path / "plain.stl")


def config_of(path: Path) -> bytes:
    import zipfile

    with zipfile.ZipFile(path) as package:
        return package.read("Metadata/Slic3r_PE_model.config")


@pytest.mark.slicer
@pytest.mark.usefixtures("prusa_slicer")
@pytest.mark.parametrize("vaults", ["printer", "none"])
@pytest.mark.parametrize("threshold_deg", [0, 45])
def test_a_slicer_makes_no_support_inside_and_all_of_it_outside(vaults, threshold_deg):
    """A mushroom: its cap overhangs outside, and so does the cavity's ceiling inside."""
    import trimesh

    stem, cap = cylinder(8, 16, 48), cylinder(16, 14, 48).translate((0, 0, 14))
    mushroom = trimesh.Trimesh(*arrays(stem + cap), process=False)
    made = hollow(mushroom, resolution=32, vaults=vaults, base="never", lean=2.0)
    assert made.blocker is not None
    slicer, cavities = find_slicer(), united(made.part.cavities)
    how = (cavities, PROFILE, threshold_deg)
    inside, outside = supports_g(slicer, made.part.manifold, *how, blocker=made.blocker)
    _, needed = supports_g(slicer, made.part.outside, *how)
    assert inside == 0.0
    assert needed > 0.5
    assert outside == pytest.approx(needed, rel=0.01)
    filled, _ = supports_g(slicer, made.part.manifold, *how)
    assert filled > 0.2  # what the blocker kept out


def test_points_of_it_lie_in_the_part_or_its_cavities():
    made = hollow(trimesh_box(), resolution=16)
    assert made.blocker is not None
    assert (made.blocker - made.part.outside).is_empty()
    assert np.isfinite(arrays(made.blocker)[0]).all()
