"""Shell, interior and base layer, against counts that can be done by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_models import box, random_solid

from printprep.errors import GeometryError, UsageError
from printprep.paper.domain import build_domain, fill
from printprep.paper.settings import PaperSettings


def test_box_shell_interior_and_ground():
    domain = build_domain(box(), PaperSettings())
    assert domain.shell.sum() == 10**3 - 8**3
    assert domain.interior.sum() == 8**3
    assert domain.ground == 3
    assert not (domain.shell & domain.free).any()
    assert np.array_equal(domain.free, domain.interior | domain.base)


@pytest.mark.parametrize(
    ("epsilon", "reach", "per_layer"),
    # A square of side 10 has 40 voxels at L1 distance 1, 44 at 2 (40 and the 4 corners).
    [
        (1, "below", 0),
        (2, "below", 40),
        (3, "below", 84),
        (1, "within", 40),
        (2, "within", 84),
        (0, "within", 0),
    ],
)
def test_box_base_layer(epsilon, reach, per_layer):
    domain = build_domain(box(), PaperSettings(epsilon=epsilon, base_reach=reach))
    assert domain.base.sum() == epsilon * per_layer
    layers = np.flatnonzero(domain.base.any(axis=(0, 1)))
    assert set(layers) <= set(range(3, 3 + epsilon))
    assert not (domain.base & domain.solid).any()


def test_base_can_be_switched_off():
    domain = build_domain(box(), PaperSettings(base=False))
    assert not domain.base.any()
    assert np.array_equal(domain.free, domain.interior)


def test_base_stays_in_the_grid_instead_of_wrapping_around():
    occupied = np.zeros((8, 8, 8), dtype=bool)
    occupied[:3, 2:6, :4] = True
    domain = build_domain(occupied, PaperSettings())
    assert not domain.base[-1].any()
    assert domain.base[3, 2:6, 0].all()


def test_grid_edge_is_outside():
    domain = build_domain(np.ones((5, 5, 5), dtype=bool), PaperSettings())
    assert domain.interior.sum() == 3**3


def test_surface_voxels_give_the_same_domain_as_their_solid():
    solid = box()
    surface = solid.copy()
    surface[4:12, 4:12, 4:12] = False
    from_solid = build_domain(solid, PaperSettings())
    from_surface = build_domain(surface, PaperSettings())
    for name in ("solid", "shell", "interior", "base"):
        assert np.array_equal(getattr(from_solid, name), getattr(from_surface, name))


def test_a_thick_surface_is_frozen_as_given():
    surface = box()
    surface[6:10, 6:10, 6:10] = False
    kept = build_domain(surface, PaperSettings(), shell="occupied")
    assert np.array_equal(kept.shell, surface)
    assert kept.interior.sum() == 4**3
    thin = build_domain(surface, PaperSettings(), shell="boundary")
    assert thin.interior.sum() == 8**3


def test_a_leak_floods_the_interior_and_slices_hold_it():
    surface = box()
    surface[4:12, 4:12, 4:12] = False
    surface[3, 7, 7] = False
    assert np.array_equal(fill(surface, "flood"), surface)
    closed = fill(surface, "slices")
    # Lost are the leak itself and the two slices through it, which share a line of 8.
    assert closed.sum() == 10**3 - 1 - 8**2 - 8**2 + 8
    assert not closed[4, 7, 7]


@given(st.integers(0, 10_000))
def test_flood_is_part_of_slices(seed):
    noise = np.random.default_rng(seed).random((7, 8, 9)) < 0.55
    flood, slices = fill(noise, "flood"), fill(noise, "slices")
    assert (flood | noise).sum() == flood.sum()
    assert not (flood & ~slices).any()


@given(st.integers(0, 10_000))
def test_interior_never_touches_the_outside(seed):
    domain = build_domain(random_solid(seed), PaperSettings())
    padded = np.pad(domain.solid, 1)
    for axis in range(3):
        for shift in (-1, 1):
            neighbour = np.roll(padded, shift, axis)[1:-1, 1:-1, 1:-1]
            assert neighbour[domain.interior].all()


def test_refusals():
    with pytest.raises(GeometryError, match="empty"):
        build_domain(np.zeros((4, 4, 4), dtype=bool), PaperSettings())
    with pytest.raises(UsageError, match="bool"):
        build_domain(np.ones((4, 4, 4)), PaperSettings())
    with pytest.raises(UsageError, match=r"Filling .guess. does not exist"):
        fill(box(), "guess")
    with pytest.raises(UsageError, match=r"Shell rule .guess. does not exist"):
        build_domain(box(), PaperSettings(), shell="guess")


@pytest.mark.parametrize(
    "wrong",
    [
        {"resolution": 0},
        {"epsilon": -1},
        {"steps": 0},
        {"rate": 0.0},
        {"rate": float("nan")},
        {"mass_weight": -1.0},
        {"base_reach": "far"},
    ],
)
def test_invalid_settings(wrong):
    with pytest.raises(UsageError, match=next(iter(wrong))):
        PaperSettings(**wrong)
