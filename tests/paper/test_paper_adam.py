"""The fast Adam against the autograd reference, and the plane against both."""

import numpy as np
import pytest
import torch
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from paper_models import random_solid, voxelize
from paper_reference import run_autograd

from printprep.errors import UsageError
from printprep.paper.adam import initial_logits, solve_adam
from printprep.paper.domain import build_domain
from printprep.paper.plane import solve_plane
from printprep.paper.settings import PaperSettings

MODELS = ["spot_low_resolution", "penguin", "rocker-arm"]


def _agree(domain, chosen):
    fast, plain = solve_adam(domain, chosen), run_autograd(domain, chosen)
    assert len(fast.trace) == len(plain.trace) == chosen.steps
    assert fast.trace == pytest.approx(plain.trace, abs=1e-3)
    assert np.abs(fast.smoothed - plain.smoothed).max() < 1e-3


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"smoothing": False},
        {"base": False},
        {"center": False},
        {"region": False},
        {"height": False},
        {"mass": False},
        {"rate": 0.01},
        {"epsilon": 3, "base_reach": "within"},
    ],
    ids=str,
)
def test_hundred_steps_agree_with_autograd(change):
    chosen = PaperSettings(steps=100, resolution=16, **change)
    _agree(build_domain(random_solid(4, edge=16), chosen), chosen)


@pytest.mark.corpus
@pytest.mark.parametrize("name", MODELS)
def test_hundred_steps_agree_on_models(name, dev_models):
    chosen = PaperSettings(steps=100, resolution=32)
    model = dev_models[name]
    _agree(build_domain(voxelize(model.path, model.up, 32), chosen), chosen)


def test_densities_have_moved_by_the_steps_compared():
    """Else agreement would say nothing: 400 steps take whole neighbourhoods over."""
    chosen = PaperSettings(steps=400, resolution=16)
    domain = build_domain(random_solid(4, edge=16), chosen)
    fast, plain = solve_adam(domain, chosen), run_autograd(domain, chosen)
    assert plain.trace[0] - plain.trace[-1] > 1.0
    assert plain.smoothed[domain.free].max() > 0.7
    assert fast.trace == pytest.approx(plain.trace, abs=1e-3)


@examples(8)
@given(st.integers(0, 10_000))
def test_plane_is_never_above_adam(seed):
    chosen = PaperSettings(resolution=12)
    domain = build_domain(random_solid(seed), chosen)
    adam, plane = solve_adam(domain, chosen), solve_plane(domain, chosen)
    assert plane.terms.total <= adam.terms.total + 1e-4 * abs(adam.terms.total)


@pytest.mark.corpus
@pytest.mark.parametrize("name", MODELS)
def test_plane_and_adam_end_in_the_same_material(name, dev_models):
    chosen = PaperSettings(resolution=32)
    model = dev_models[name]
    domain = build_domain(voxelize(model.path, model.up, 32), chosen)
    adam, plane = solve_adam(domain, chosen), solve_plane(domain, chosen)
    assert plane.terms.total <= adam.terms.total
    assert plane.terms.total >= adam.terms.total - 1e-3 * abs(adam.terms.region)
    assert (adam.material == plane.material).mean() >= 0.998


def test_seed_is_the_only_source_of_chance():
    chosen = PaperSettings(steps=50, resolution=12)
    domain = build_domain(random_solid(4), chosen)
    first, again = solve_adam(domain, chosen), solve_adam(domain, chosen)
    assert first.smoothed.tobytes() == again.smoothed.tobytes()
    other = solve_adam(domain, PaperSettings(steps=50, resolution=12, seed=43))
    assert other.smoothed.tobytes() != first.smoothed.tobytes()


def test_logits_start_at_ten_with_the_generators_noise():
    domain = build_domain(random_solid(4), PaperSettings())
    theta = initial_logits(domain, PaperSettings())
    noise = theta - np.where(domain.shell, 10.0, -10.0)
    torch.manual_seed(42)
    expected = torch.randn(1, 1, 12, 12, 12)[0, 0].numpy()
    assert noise == pytest.approx(expected, abs=1e-5)


def test_nothing_free_is_a_constant_trace():
    occupied = np.zeros((6, 6, 6), dtype=bool)
    occupied[2:4, 2:4, 1:5] = True
    chosen = PaperSettings(base=False, steps=5)
    solution = solve_adam(build_domain(occupied, chosen), chosen)
    assert np.ptp(solution.trace) == 0.0
    assert np.array_equal(solution.material, occupied)


def test_threads_are_given_back_and_devices_checked():
    chosen = PaperSettings(steps=2)
    domain = build_domain(random_solid(4), chosen)
    before = torch.get_num_threads()
    solve_adam(domain, chosen)
    assert torch.get_num_threads() == before
    with pytest.raises(UsageError, match=r"Device .abacus. does not exist"):
        solve_adam(domain, chosen, device="abacus")
    if not torch.cuda.is_available():
        with pytest.raises(UsageError, match="CUDA"):
            solve_adam(domain, chosen, device="cuda")


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no CUDA device here")
def test_cuda_agrees_with_the_cpu():
    chosen = PaperSettings(steps=100, resolution=16)
    domain = build_domain(random_solid(4, edge=16), chosen)
    cpu, cuda = solve_adam(domain, chosen), solve_adam(domain, chosen, device="cuda")
    assert cuda.trace == pytest.approx(cpu.trace, abs=1e-3)
    assert np.abs(cuda.smoothed - cpu.smoothed).max() < 1e-3
