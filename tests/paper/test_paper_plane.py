"""The plane: closed forms, brute force, and the properties of a minimum."""

import itertools

import numpy as np
import pytest
from examples import examples
from hypothesis import assume, given
from hypothesis import strategies as st
from paper_models import box, random_solid, voxelize

from printprep.paper.domain import build_domain
from printprep.paper.linear_form import linear_form
from printprep.paper.plane import solve_plane
from printprep.paper.settings import PaperSettings
from printprep.types import Grid


@pytest.mark.parametrize("weight", [10.0, 100.0, 300.0, 1000.0])
def test_box_is_cut_level_at_the_best_height(weight):
    """Without smoothing and base, a centred box has one unknown: the layers that stay."""
    settings = PaperSettings(base=False, smoothing=False, mass_weight=weight)
    domain = build_domain(box(), settings)
    form = linear_form(domain, settings)
    level = form.voxels[:, 2]
    by_height = [form.terms((level < 4 + k).astype(float)).total for k in range(9)]
    solution = solve_plane(domain, settings)
    assert solution.terms.total <= min(by_height) + 1e-9 * abs(min(by_height))
    assert solution.fractional == 0
    best = int(np.argmin(by_height))
    assert np.array_equal(solution.material, domain.shell | (domain.interior & _below(4 + best)))
    assert solution.plane.normal == pytest.approx((0, 0, 1), abs=1e-9)
    assert 4 + best - 1 <= solution.plane.offset <= 4 + best


def _below(z):
    keep = np.zeros((16, 16, 16), dtype=bool)
    keep[:, :, :z] = True
    return keep


def test_without_smoothing_the_filling_is_exactly_the_half_space():
    settings = PaperSettings(smoothing=False, base=False)
    domain = build_domain(random_solid(7, edge=20), settings)
    solution = solve_plane(domain, settings)
    index = np.argwhere(domain.interior)
    above = index @ solution.plane.normal - solution.plane.offset
    filled = solution.rho[domain.interior]
    assert (filled[above < -1e-6] == 1).all()
    assert (filled[above > 1e-6] == 0).all()
    assert 0 < filled.mean() < 1


@examples(25)
@given(st.integers(0, 10_000), st.booleans())
def test_no_filling_of_a_tiny_solid_is_better(seed, smoothing):
    """A box with bumps: all fillings of its dozen interior voxels are tried, contact fixed."""
    rng = np.random.default_rng(seed)
    occupied = np.zeros((8, 8, 8), dtype=bool)
    occupied[1:-1, 1:-1, :6] = rng.random((6, 6, 6)) < 0.06
    occupied[2:6, 2:6, 1:5] = True
    chosen = PaperSettings(base=False, resolution=16, smoothing=smoothing)
    form = linear_form(build_domain(occupied, chosen), chosen)
    assume(form.count <= 12)
    tried = [
        form.terms(np.array(bits, dtype=float)).total
        for bits in itertools.product((0, 1), repeat=form.count)
    ]
    found = solve_plane(form.domain, chosen).terms.total
    assert found <= min(tried) + 1e-7 * max(1, abs(min(tried)))


@given(st.integers(0, 10_000))
def test_trace_falls_and_no_single_voxel_improves_it(seed):
    settings = PaperSettings()
    domain = build_domain(random_solid(seed), settings)
    solution = solve_plane(domain, settings)
    tolerance = 1e-7 * max(1.0, abs(solution.terms.total))
    assert (np.diff(solution.trace) <= tolerance).all()
    assert solution.trace[-1] == pytest.approx(solution.terms.total, rel=1e-9)
    form = linear_form(domain, settings)
    rho = solution.rho[domain.free]
    for voxel in np.random.default_rng(seed).permutation(form.count)[:10]:
        changed = rho.copy()
        changed[voxel] = round(1 - changed[voxel])
        assert form.terms(changed).total >= solution.terms.total - tolerance


def test_more_mass_weight_never_leaves_more_mass():
    masses = []
    for weight in (0.0, 10.0, 100.0, 1000.0):
        settings = PaperSettings(mass_weight=weight, base=False, resolution=20)
        domain = build_domain(random_solid(7, edge=20), settings)
        masses.append(solve_plane(domain, settings).smoothed.sum())
    assert masses == sorted(masses, reverse=True)
    assert masses[0] > masses[-1]


def test_region_term_fills_the_base_and_lets_go_without_it():
    settings = PaperSettings()
    domain = build_domain(box(), settings)
    assert solve_plane(domain, settings).rho[domain.base].all()
    # B widens the contact and lies low, but far from the middle: L_center alone empties it.
    alone = PaperSettings(region=False, height=False)
    assert not solve_plane(domain, alone).rho[domain.base].any()


def test_material_and_cavity_share_out_the_solid():
    settings = PaperSettings()
    domain = build_domain(random_solid(3, edge=20), settings)
    solution = solve_plane(domain, settings)
    assert not (solution.material & solution.cavity).any()
    assert np.array_equal((solution.material & domain.solid) | solution.cavity, domain.solid)
    assert (solution.material & ~domain.solid == solution.material & domain.base).all()
    assert solution.material[domain.shell].all()
    assert not (solution.cavity & ~domain.interior).any()


def test_nothing_free_gives_the_shell_and_no_plane():
    occupied = np.zeros((6, 6, 6), dtype=bool)
    occupied[2:4, 2:4, 1:5] = True
    settings = PaperSettings(base=False)
    solution = solve_plane(build_domain(occupied, settings), settings)
    assert np.array_equal(solution.material, occupied)
    assert solution.plane is None
    assert not solution.cavity.any()
    assert solution.terms.region == pytest.approx(-4.0)


def test_every_term_dropped_leaves_no_plane_to_speak_of():
    settings = PaperSettings(center=False, region=False, height=False, mass=False)
    solution = solve_plane(build_domain(box(), settings), settings)
    assert solution.plane is None
    assert solution.terms.total == 0.0


def test_plane_in_mm():
    settings = PaperSettings(base=False, smoothing=False)
    solution = solve_plane(build_domain(random_solid(7, edge=20), settings), settings)
    grid = Grid(np.array([-12.5, 4.0, 0.75]), 1.5, (20, 20, 20))
    plane = solution.plane.in_mm(grid)
    index = np.argwhere(np.ones((20, 20, 20)))
    in_voxels = index @ solution.plane.normal - solution.plane.offset
    in_mm = (grid.origin_mm + 1.5 * index) @ plane.normal - plane.offset_mm
    assert in_mm == pytest.approx(1.5 * in_voxels, abs=1e-9)


def test_same_domain_same_bytes():
    settings = PaperSettings()
    domain = build_domain(random_solid(11, edge=20), settings)
    first, second = solve_plane(domain, settings), solve_plane(domain, settings)
    assert first.rho.tobytes() == second.rho.tobytes()
    assert first.plane == second.plane


@pytest.mark.corpus
def test_spot_at_64(dev_models):
    """Golden: −15.22105 after 14 steps, measured when the solver was written.

    The autograd formulation's Adam comes to −15.2101 in 2000 steps and −15.2207 in 8000.
    """
    settings = PaperSettings()
    spot = dev_models["spot_low_resolution"]
    domain = build_domain(voxelize(spot.path, spot.up, 64), settings)
    solution = solve_plane(domain, settings)
    assert solution.terms.total == pytest.approx(-15.22105, abs=2e-5)
    assert len(solution.trace) - 1 <= 23
    assert solution.fractional <= 4
