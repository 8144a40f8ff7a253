"""Real models, hollowed, sliced, measured: one row each of the table in docs/verify.md."""

from __future__ import annotations

import pytest
from collection import CatalogueModel
from verify_table import agrees, markdown, measure

SIZE_MM = 60.0  # the table is made at 100: this is for every change

pytestmark = [pytest.mark.slicer, pytest.mark.corpus]


@pytest.mark.parametrize("name", ["cow", "teapot"])
def test_a_real_model_prints_as_computed(
    name: str, dev_models: dict[str, CatalogueModel], prusa_slicer: object
):
    model = dev_models[name]
    row = measure(model.path, model.up, SIZE_MM, "fdm-pla-0.4")
    assert row["bodies"] == 1
    assert abs(row["mass_off_percent"]) < 4.0
    assert row["centre_off_mm"] < row["centre_limit_mm"]
    promised = min(row["lean_deg"], row["tilt_computed_deg"])
    assert row["tilt_printed_deg"] >= promised - 1.0
    assert row["in_cavities_mm3"] == 0.0
    assert row["support_in_cavities_mm3"] == 0.0
    assert abs(row["filament_off_percent"]) < 0.5
    assert agrees(row), row["findings"]
    assert name in markdown([row])
