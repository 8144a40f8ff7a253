"""The figures a file carries: one class writes them and reads them back, or says why not."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from closed_form_parts import hollow_result

from printprep.output.figures import FORMAT, Figures
from printprep.output.numbers import to_text
from printprep.types import Drain, Drainage, Supports

DRAINED = hollow_result(
    profile="resin-standard",
    with_base=True,
    supports=Supports("printer", 3, 5, 12.5, 0.0, 0),
    drainage=Drainage(
        (Drain("outlet", 0, (10.0, 0.0, 4.0), (1.0, 0.0, 0.0), 3.5, 2.0),),
        filled_mm3=500.0,
        closed_mm3=(800.0,),
    ),
)


@pytest.mark.parametrize("result", [hollow_result(), DRAINED], ids=["plain", "drained"])
def test_what_is_written_is_read_back_the_same(result):
    figures = result.figures()
    assert Figures.from_json(to_text(figures.to_json())) == figures


def test_the_version_of_the_keys_comes_first():
    assert next(iter(hollow_result().figures().to_json().items())) == ("format", FORMAT)


def test_known_figures_of_a_cube():
    """10 mm half side at 10 mm height: 45°; 3904 mm³ of PLA."""
    figures = Figures.from_json(to_text(hollow_result().figures().to_json()))
    assert (figures.mass_g, figures.tilt_deg, figures.bodies) == (4.84096, 45.0, 1)
    assert figures.contact is not None and figures.contact.area_mm2 == 400.0
    assert sorted(figures.contact.polygon_mm) == [(-10, -10), (-10, 10), (10, -10), (10, 10)]
    assert figures.cavities.items[0].volume_mm3 == 4096.0


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"format": FORMAT + 1}, f'"format": {FORMAT}'),
        ({"mass_g": "heavy"}, "mass_g"),
        ({"contact": {"polygon_mm": [[0.0]], "area_mm2": 1.0}}, "contact.polygon_mm"),
        ({"placement": [[1.0, 0.0, 0.0, 0.0]]}, "placement"),
        ({"mass_g": None}, "mass_g"),
    ],
)
def test_what_is_not_understood_is_refused_by_its_key(change, reason):
    data = {**hollow_result().figures().to_json(), **change}
    with pytest.raises(ValueError, match=reason):
        Figures.from_json(json.dumps(data))


@pytest.mark.parametrize("bad", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_numbers_that_are_not_finite_are_refused(bad):
    text = to_text(hollow_result().figures().to_json()).replace(
        '"mass_g": 4.84096', f'"mass_g": {bad}'
    )
    assert bad in text
    with pytest.raises(ValueError, match="finite"):
        Figures.from_json(text)


@pytest.mark.parametrize("missing", ["mass_g", "bounds_mm", "findings", "repair"])
def test_a_missing_key_is_named(missing):
    data = hollow_result().figures().to_json()
    del data[missing]
    with pytest.raises(ValueError, match=missing):
        Figures.from_json(json.dumps(data))


def test_a_part_without_contact_has_none():
    lifted = hollow_result()
    part = replace(lifted.part, manifold=lifted.part.manifold.translate((0, 0, 5)))
    assert replace(lifted, part=part).figures().contact is None
