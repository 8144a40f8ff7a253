"""The objective's terms and gradient: closed forms, and the convolution with autograd."""

import numpy as np
import pytest
import torch
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from paper_models import box, random_solid
from paper_reference import Autograd

from printprep.paper.domain import build_domain
from printprep.paper.linear_form import linear_form
from printprep.paper.settings import PaperSettings
from printprep.paper.smoothing import box_mean, smooth

ABLATIONS = [
    {},
    {"center": False},
    {"region": False},
    {"height": False},
    {"mass": False},
    {"smoothing": False},
    {"base": False},
    {"smoothing": False, "base": False},
    {"mass_weight": 0.0},
    {"mass_weight": 1000.0},
    {"epsilon": 3},
    {"base_reach": "within"},
]


def test_full_box_has_the_closed_form():
    """A filled cube of 10 on ground 3, no base: each term by hand."""
    settings = PaperSettings(base=False, smoothing=False)
    form = linear_form(build_domain(box(), settings), settings)
    terms = form.terms(np.ones(form.count))
    half = np.arange(10) - 4.5
    distance = np.hypot(*np.meshgrid(half, half)).mean()
    assert terms.center == pytest.approx(distance, rel=1e-12)
    assert terms.region == pytest.approx(-100.0, rel=1e-12)
    assert terms.height == pytest.approx(4.5, rel=1e-12)
    assert terms.mass == pytest.approx(100 * 1000 / 64**3, rel=1e-12)
    assert terms.total == pytest.approx(distance - 100 + 4.5 + 1e5 / 64**3, rel=1e-12)


def test_half_box_centre_of_mass():
    """Interior empty above half height: mass and height from the layers' areas."""
    settings = PaperSettings(base=False, smoothing=False, center=False, region=False)
    domain = build_domain(box(), settings)
    form = linear_form(domain, settings)
    rho = (form.voxels[:, 2] < 8).astype(float)
    layers = np.array([100, *[100] * 4, *[36] * 4, 100], dtype=float)
    terms = form.terms(rho)
    assert terms.mass == pytest.approx(100 * layers.sum() / 64**3, rel=1e-12)
    assert terms.height == pytest.approx(layers @ np.arange(10) / layers.sum(), rel=1e-12)


def test_contact_falls_to_a_quarter_per_layer():
    """A T: a stem of one voxel on the ground, a bar one layer up and a bar two layers up."""
    occupied = np.zeros((7, 3, 4), dtype=bool)
    occupied[3, 1, :] = True
    occupied[2, 1, 1:] = True
    occupied[1, 1, 2:] = True
    settings = PaperSettings(base=False)
    form = linear_form(build_domain(occupied, settings), settings)
    assert form.terms(np.zeros(0)).region == pytest.approx(-(1 + 1 / 4 + 1 / 16))


def test_box_mean_is_its_own_adjoint_and_keeps_constants_inside():
    rng = np.random.default_rng(0)
    a, b = rng.random((2, 5, 6, 7))
    assert np.sum(box_mean(a) * b) == pytest.approx(np.sum(a * box_mean(b)), rel=1e-12)
    inside = box_mean(np.ones((5, 5, 5)))
    assert inside[1:-1, 1:-1, 1:-1] == pytest.approx(np.ones((3, 3, 3)))
    assert inside[0, 0, 0] == pytest.approx(8 / 27)


@given(st.integers(0, 10_000))
def test_moments_are_those_of_the_smoothed_field(seed):
    settings = PaperSettings()
    domain = build_domain(random_solid(seed), settings)
    form = linear_form(domain, settings)
    rho = np.random.default_rng(seed).random(form.count)
    field = form.field(rho)
    axes = np.meshgrid(*[np.arange(n) for n in domain.shape], indexing="ij")
    moments = [np.sum(field * (axis - r)) for axis, r in zip(axes, form.reference, strict=True)]
    assert form.moments(rho) == pytest.approx([field.sum(), *moments], abs=1e-9)


def test_smoothing_leaves_the_shell_and_clears_the_outside():
    domain = build_domain(box(), PaperSettings())
    field = smooth(np.ones(domain.shape), domain)
    assert np.array_equal(field > 0, domain.shell | domain.free)
    assert field[domain.shell] == pytest.approx(1.0)


@pytest.mark.parametrize("change", ABLATIONS, ids=str)
@examples(12)
@given(seed=st.integers(0, 10_000))
def test_value_and_gradient_match_convolution_and_autograd(change, seed):
    """Frozen noise included, in float64, for every ablation."""
    chosen = PaperSettings(**change)
    domain = build_domain(random_solid(seed), chosen)
    rng = np.random.default_rng(seed)
    whole = np.where(domain.shell, 1 - 0.1 * rng.random(domain.shape), 0.0)
    whole = np.where(domain.shell | domain.free, whole, 0.1 * rng.random(domain.shape))
    whole[domain.free] = rng.random(int(domain.free.sum()))
    form = linear_form(domain, chosen, whole)
    rho = whole[domain.free]

    plain = Autograd(domain, chosen, torch.float64)
    leaf = torch.from_numpy(whole).requires_grad_(True)
    loss = plain.loss(plain.smooth(leaf))
    if loss.requires_grad:
        loss.backward()
    assert form.terms(rho).total == pytest.approx(loss.item(), abs=1e-9, rel=1e-9)
    slope, q = form.gradient(rho)
    if leaf.grad is not None:
        assert slope == pytest.approx(leaf.grad.numpy()[domain.free], abs=1e-10, rel=1e-7)
    assert q.shape == (4,)


def test_dropped_terms_are_zero():
    for name in ("center", "region", "height", "mass"):
        settings = PaperSettings(**{name: False})
        form = linear_form(build_domain(box(), settings), settings)
        terms = form.terms(np.full(form.count, 0.5))
        assert getattr(terms, name) == 0.0
        others = {"center", "region", "height", "mass"} - {name}
        assert all(getattr(terms, other) != 0.0 for other in others)
