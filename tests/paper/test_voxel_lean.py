"""The lean methods against a second solver, and against the paper's result they must not exceed."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import random_voxels
from scipy.optimize import linprog

from printprep.evaluate.bodies import body_of
from printprep.evaluate.methods import methods
from printprep.paper.domain import build_domain
from printprep.paper.settings import PaperSettings
from printprep.paper.voxel_balance import footing, moment_columns, tilt_deg
from printprep.paper.voxel_lean import footprints, leanest

SEEDS = range(12)
EDGE = 14


def named(name: str, lean_deg: float = 10.0):
    return methods([name], resolution=EDGE, lean_deg=lean_deg)[0]


def least_mass(domain, footprint, lean_deg) -> float | None:
    """The whole program over all voxels, by HiGHS alone."""
    fixed = domain.shell.copy()
    fixed[:, :, domain.ground] |= footprint
    free = domain.interior | (domain.base if footprint.any() else False)
    free[:, :, domain.ground] = False
    given = moment_columns(np.argwhere(fixed), domain.shape, domain.ground).sum(axis=1)
    voxels = moment_columns(np.argwhere(free), domain.shape, domain.ground)
    rows = footing(fixed[:, :, domain.ground]).constraints(lean_deg)
    found = linprog(voxels[0], A_ub=-rows @ voxels, b_ub=rows @ given, bounds=(0, 1))
    return float(found.fun + given[0]) if found.status == 0 else None


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("lean_deg", [3.0, 10.0])
def test_no_lighter_filling_stands(seed, lean_deg):
    domain = build_domain(random_voxels(seed), PaperSettings(), shell="boundary")
    choices = footprints(domain)
    found = leanest(domain, lean_deg, choices)
    masses = [least_mass(domain, choice, lean_deg) for choice in choices]
    feasible = [mass for mass in masses if mass is not None]
    assert (found.reachable_deg is None) == bool(feasible)
    if feasible:
        assert found.weight.sum() == pytest.approx(min(feasible), rel=1e-6)
        assert tilt_deg(found.weight, domain.ground) >= lean_deg - 1e-5
    else:
        assert found.reachable_deg < lean_deg
    assert (found.weight >= domain.shell).all()
    assert not found.weight[~(domain.solid | domain.base)].any()


@pytest.mark.parametrize("seed", SEEDS)
def test_at_the_papers_tilt_it_is_never_heavier(seed):
    occupied = random_voxels(seed)
    paper = body_of(occupied, named("paper"))
    ours = body_of(occupied, named("lean-at-paper-tilt"))
    assert ours.weight.sum() <= paper.weight.sum() + 1e-6
    angle = tilt_deg(paper.weight, paper.ground)
    assert tilt_deg(ours.weight, ours.ground) >= angle - 1e-4
    assert ours.lean_deg == pytest.approx(angle)
    assert ours.reachable_deg is None


@pytest.mark.parametrize("name", ["lean", "lean-no-base", "lean-full-base", "lean-at-paper-tilt"])
def test_few_voxels_are_fractional(name):
    for seed in SEEDS:
        body = body_of(random_voxels(seed), named(name, 5.0))
        between = (body.weight > 0) & (body.weight < 1)
        assert between.sum() <= 4


def test_the_main_methods_are_what_they_are_called():
    occupied = random_voxels(1)
    solid, shell, bare = (
        body_of(occupied, named(name)) for name in ("solid", "shell", "paper-no-base")
    )
    assert (solid.weight == solid.solid).all()
    assert (shell.outside == shell.solid).all()
    assert shell.weight.sum() < bare.weight.sum() < solid.weight.sum()
    assert not (bare.weight > solid.weight).any()
    assert ((bare.weight == 1) | (bare.weight == 0)).all()


def test_a_base_is_not_built_where_nothing_needs_it():
    cube = np.zeros((EDGE,) * 3, dtype=bool)
    cube[3:11, 3:11, 2:10] = True
    body = body_of(cube, named("lean"))
    assert (body.outside == body.solid).all()
    assert body.weight.sum() == 8**3 - 6**3
    full = body_of(cube, named("lean-full-base"))
    assert (full.outside & ~full.solid).sum() == 4 * 8  # a ring one voxel wide, in one layer
    assert full.weight.sum() == body.weight.sum() + 4 * 8


def test_adam_comes_close_to_the_plane():
    occupied = random_voxels(2)
    by_plane, by_adam = (
        body_of(occupied, methods(["paper"], resolution=EDGE, solver=solver)[0])
        for solver in ("plane", "adam")
    )
    assert (by_plane.weight == by_adam.weight).mean() > 0.99
