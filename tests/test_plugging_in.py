"""The four doors: a fourth process, an objective, a fill and a rule plug in by one row each."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from closed_form_parts import box, context, hollow_box
from manifold3d import Manifold

import printprep
from printprep.check import RULES, rule, run_rules
from printprep.check.catalogue import CATALOGUE, finding
from printprep.cli.run import run
from printprep.errors import UsageError
from printprep.objectives import OBJECTIVES, Objective, objective_of
from printprep.pipeline.fills import FILLS, fill_of
from printprep.process import PROCESSES
from printprep.profiles import load_profile
from printprep.types import Unit

PELLETS = replace(PROCESSES["fdm"], name="pellets", loosens_from_bed=False)
WAX = replace(PROCESSES["resin"], name="wax", cavity_holds="wax", peels_from_film=False)


@pytest.fixture
def tower(tmp_path):
    """A tower of 18 × 18 × 40 mm, as a file."""
    from printprep.mesh.write import to_bytes

    path = tmp_path / "tower.stl"
    path.write_bytes(to_bytes(box(18, 40), ".stl"))
    return path


@pytest.mark.parametrize(("row", "profile"), [(PELLETS, "fdm-pla-0.4"), (WAX, "resin-standard")])
def test_a_fourth_process_runs_through_every_room(monkeypatch, tower, tmp_path, row, profile):
    monkeypatch.setitem(PROCESSES, row.name, row)
    settings = load_profile(profile, {"process": row.name})
    assert settings.traits is row
    result = printprep.hollow(tower, profile=settings, resolution=16)
    assert result.mass_g < result.solid_mass_g
    out = tmp_path / "out.3mf"
    result.write(out)
    run_rules(context(hollow_box(30, 2)), settings)
    assert run(["check", str(out), "-p", profile, "--set", f"process={row.name}", "-q"]) == 0


def test_a_sealed_cavity_is_told_in_the_process_own_words(monkeypatch):
    monkeypatch.setitem(PROCESSES, "wax", WAX)
    settings = load_profile("resin-standard", {"process": "wax"})
    found = {item.rule: item for item in run_rules(context(hollow_box(30, 2)), settings)}
    assert "of wax" in found["sealed-cavity"].message
    assert found["sealed-cavity"].severity == "error"


def test_an_unknown_process_is_refused_with_those_there_are():
    with pytest.raises(UsageError, match="must be fdm, resin"):
        load_profile("fdm-pla-0.4", {"process": "laser"})


def test_an_objective_plugs_in(monkeypatch, tower):
    """Everything empty: the shell alone."""

    def empty(program, choice, lean, margin_deg, solver):
        return replace(
            OBJECTIVES["lean"].on_solid(program, choice, lean, margin_deg, solver),
            planes=(None,) * len(program.bodies),
        )

    def empty_voxels(domain, lean_deg, settings, solver):
        return domain.shell.astype(float)

    row = Objective("shell", "the shell alone", False, empty, empty_voxels)
    monkeypatch.setitem(OBJECTIVES, "shell", row)
    shell = printprep.hollow(tower, objective="shell", resolution=16, vaults="none")
    assert shell.density.certificate is None  # another objective proves nothing about the lean
    assert shell.mass_g <= printprep.hollow(tower, resolution=16, vaults="none").mass_g
    block = np.zeros((64, 64, 64), dtype=bool)
    block[20:40, 20:40, 20:40] = True
    hollowed = printprep.generators.hollow(block, objective="shell")
    assert hollowed.cavity_voxels.sum() == 18**3


def test_a_fill_plugs_in(monkeypatch, tower):
    """Half the wall: another row on the cavity's own functions."""
    row = replace(FILLS["cavity"], name="twin", summary="the same again")
    monkeypatch.setitem(FILLS, "twin", row)
    twin = printprep.hollow(tower, fill="twin", resolution=16)
    plain = printprep.hollow(tower, resolution=16)
    assert twin.mass_g == plain.mass_g
    assert twin.alternative_fill is not None


def test_a_rule_plugs_in(monkeypatch):
    monkeypatch.setattr("printprep.check.registry.RULES", dict(RULES))

    with pytest.raises(ValueError, match="not in the catalogue"):
        rule("hat")(lambda context, profile: ())
    with pytest.raises(ValueError, match="two rules"):
        rule("tilt")(lambda context, profile: ())


def test_the_catalogue_refuses_what_it_does_not_know():
    with pytest.raises(ValueError, match="not in the catalogue"):
        finding("hat", "It wears a hat.")
    with pytest.raises(ValueError, match="not error"):
        finding("gap", "A gap.", severity="error")
    with pytest.raises(ValueError, match="not None"):
        finding("wall-thickness", "Thin.")


def test_units_are_one_vocabulary():
    units = {kind.unit for kind in CATALOGUE.values()}
    assert units <= {None, *get_args(Unit)}


@pytest.mark.parametrize("of", [objective_of, fill_of])
def test_unknown_names_are_refused_with_those_there_are(of):
    with pytest.raises(UsageError) as caught:
        of("none-such")
    assert "none-such" in caught.value.message and caught.value.hint is not None


def test_a_density_without_a_plane_is_cut_where_it_is_below_one_half(monkeypatch, tower):
    def upper_half(program, choice, lean, margin_deg, solver):
        found = OBJECTIVES["lean"].on_solid(program, choice, lean, margin_deg, solver)
        z = np.arange(found.rho.shape[2])
        rho = np.broadcast_to(z < found.rho.shape[2] / 2, found.rho.shape).astype(float)
        return replace(found, rho=rho, planes=None)

    row = Objective("upper", "the lower half solid", False, upper_half, None)
    monkeypatch.setitem(OBJECTIVES, "upper", row)
    part = printprep.hollow(tower, objective="upper", resolution=16, vaults="none").part
    (cavity,) = part.cavities
    assert isinstance(cavity, Manifold)
    assert cavity.bounding_box()[2] == pytest.approx(20.0, abs=3.0)
