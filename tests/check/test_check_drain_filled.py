"""The rule about what was filled for want of a drain: clean, at its limit, and failing."""

from __future__ import annotations

import pytest
from closed_form_parts import context, hollow_box

from printprep.check.drain_filled import FILLED_MM3, drain_filled
from printprep.profiles import load_profile
from printprep.types import Drainage

PROFILE = load_profile("resin-standard")


@pytest.mark.parametrize("drainage", [None, Drainage((), FILLED_MM3, ())])
def test_clean(drainage):
    part = context(hollow_box(20, 2), drainage=drainage)
    assert list(drain_filled(part, PROFILE)) == []


def test_floors_beyond_the_limit_are_told():
    part = context(hollow_box(20, 2), drainage=Drainage((), FILLED_MM3 + 1, ()))
    (found,) = drain_filled(part, PROFILE)
    assert (found.severity, found.value) == ("info", FILLED_MM3 + 1)


def test_cavities_left_solid_are_told():
    part = context(hollow_box(20, 2), drainage=Drainage((), 0.0, (300.0, 200.0)))
    (found,) = drain_filled(part, PROFILE)
    assert found.value == 500.0
    assert "2 cavities of 0.5 cm³" in found.message and "3.5 mm" in found.message
