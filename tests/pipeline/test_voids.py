"""The model's own sealed voids: filled, kept on request, and kept where they hold a body."""

from __future__ import annotations

import numpy as np
import pytest
import solids
import trimesh
from manifold3d import Manifold

from printprep import hollow
from printprep.mesh.measure import arrays
from printprep.mesh.sealed_voids import sealed_voids
from printprep.pipeline.check import check
from printprep.result import HollowResult


def holding(void: float = 14.0) -> Manifold:
    """A cube of 40 mm with a cubic void in its middle."""
    return solids.box(40, 40, 40) - solids.box(void, void, void).translate((0, 0, 20 - void / 2))


def rattle() -> Manifold:
    """The same, with a ball of 6 mm loose in the void."""
    return holding() + Manifold.sphere(3.0, 48).translate((0, 0, 20))


def hollowed(solid: Manifold, profile: str, **options: object) -> HollowResult:
    mesh = trimesh.Trimesh(*arrays(solid), process=False)
    return hollow(mesh, profile=profile, resolution=16, **options)  # type: ignore[arg-type]


def said(result: HollowResult) -> dict[str, float | None]:
    return {item.rule: item.value for item in result.findings}


def bodies_of(result: HollowResult) -> list[float]:
    """Volumes of the shells that bound material from outside, largest first."""
    volumes = (part.volume() for part in result.part.manifold.decompose())
    return sorted((volume for volume in volumes if volume > 0), reverse=True)


def test_voids_are_told_from_those_that_hold_a_body() -> None:
    other = solids.box(4, 4, 4).translate((-14, -14, 18))
    found = sealed_voids(rattle() - other)
    assert [void.volume() for void in found.empty] == pytest.approx([64])
    assert [void.volume() for void in found.holding] == pytest.approx([14**3])
    assert found.whole.volume() == pytest.approx(rattle().volume())
    assert sealed_voids(solids.box(5, 5, 5)).empty == ()


def test_a_void_inside_the_body_in_a_void_is_empty() -> None:
    body = solids.box(8, 8, 8).translate((0, 0, 16)) - solids.box(4, 4, 4).translate((0, 0, 18))
    found = sealed_voids(holding() + body)
    assert [void.volume() for void in found.empty] == pytest.approx([64])
    assert [void.volume() for void in found.holding] == pytest.approx([14**3])


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["fdm-pla-0.4", "resin-standard", "sls-pa12"])
def test_a_sealed_void_is_filled_before_hollowing(profile: str) -> None:
    with_void, without = hollowed(holding(), profile), hollowed(solids.box(40, 40, 40), profile)
    assert with_void.part.manifold.volume() == pytest.approx(without.part.manifold.volume())
    assert said(with_void)["void-filled"] == pytest.approx(14**3)
    assert "void-filled" not in said(without)
    assert with_void.solid_mass_g == pytest.approx(without.solid_mass_g)


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["fdm-pla-0.4", "resin-standard", "sls-pa12"])
def test_a_rattle_keeps_its_void_and_its_ball(profile: str) -> None:
    result = hollowed(rattle(), profile)
    ball = Manifold.sphere(3.0, 48).volume()
    part, loose = bodies_of(result)
    assert loose == pytest.approx(ball, rel=1e-4)
    assert part > 10 * loose
    assert said(result)["void-kept"] == pytest.approx(14**3)
    # The wall around the void stands on the floor of the cavity.
    assert result.wall_min_mm is not None
    assert result.wall_min_mm >= result.profile.wall_mm - 0.05
    middle = np.array([[0.0, 0.0, 20.0], [0.0, 0.0, 25.0]])
    from printprep.grid.distance import Surface

    assert Surface.of(result.part.manifold).contains(middle).tolist() == [True, False]


@pytest.mark.slow
def test_voids_that_are_kept_get_vaults_and_walls() -> None:
    result = hollowed(holding(), "fdm-pla-0.4", voids="keep")
    assert len(bodies_of(result)) == 1
    assert said(result)["void-kept"] == pytest.approx(14**3)
    assert "unsupported-ceiling" not in said(result)
    (kept,) = result.part.kept
    assert kept.volume() < 14**3  # vaults stand in it
    assert not (kept - solids.box(14, 14, 14).translate((0, 0, 13))).volume() > 0.5
    assert result.wall_min_mm is not None and result.wall_min_mm >= 1.2 - 0.05


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["resin-standard", "sls-pa12"])
def test_voids_that_are_kept_are_drained(profile: str) -> None:
    result = hollowed(holding(), profile, voids="keep")
    assert len(bodies_of(result)) == 1
    # One hole may open both, on its way through the cavity around the void.
    assert not {"sealed-cavity", "drain-too-small"} & said(result).keys()
    assert result.drainage is not None and len(result.drainage.drains) >= 2
    assert len(result.part.cavities) == 2


@pytest.mark.slow
def test_a_kept_void_that_no_hole_drains_stays_and_is_said() -> None:
    void = solids.box(4, 4, 2.5).translate((0, 0, 18))
    result = hollowed(
        solids.box(40, 40, 40) - void, "resin-standard", voids="keep", drain_diameter_mm=5.0
    )
    assert said(result)["sealed-cavity"] == pytest.approx(40)


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["fdm-pla-0.4", "resin-standard", "sls-pa12"])
@pytest.mark.parametrize("solid", [holding(), rattle(), solids.leaning_prism(15, 60, 20)])
def test_check_says_nothing_that_hollow_did_not(
    solid: Manifold, profile: str, tmp_path: object
) -> None:
    from pathlib import Path

    file = Path(str(tmp_path)) / "part.3mf"
    result = hollowed(solid, profile, lean=25)
    result.write(file)
    checked = check(file, profile=profile, lean=25)
    hollow_said = {(item.rule, item.severity) for item in result.findings}
    assert {(item.rule, item.severity) for item in checked.findings} <= hollow_said


@pytest.mark.corpus
@pytest.mark.parametrize("profile", ["fdm-pla-0.4", "resin-standard", "sls-pa12"])
@pytest.mark.parametrize("name", ["bunny", "spot_low_resolution", "chair", "fandisk", "torus"])
def test_check_agrees_on_real_models(
    name: str, profile: str, dev_models: dict, tmp_path: object
) -> None:
    from pathlib import Path

    model = dev_models[name]
    file = Path(str(tmp_path)) / "part.3mf"
    result = hollow(model.path, up=model.up, size_mm=60, profile=profile, resolution=32)
    result.write(file)
    hollow_said = {(item.rule, item.severity) for item in result.findings}
    found = {(item.rule, item.severity) for item in check(file, profile=profile).findings}
    assert found <= hollow_said
