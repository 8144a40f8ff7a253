"""Computed against printed: agreement on a block, and every way to differ is found."""

from __future__ import annotations

import json
import zipfile
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from manifold3d import Manifold
from verify_parts import SIDE, hollow_block, write_block, write_model

from printprep import hollow
from printprep.cli.run import run
from printprep.errors import InputError, ToolError, UsageError
from printprep.gcode.printed import Balance, Printed, SlicerSummary
from printprep.mesh.measure import arrays
from printprep.slicer.process import find_slicer
from printprep.slicer.prusa_ini import profile_ini
from printprep.threemf.read import ATTACHMENT
from printprep.types import Lean
from printprep.verify.part_3mf import ComputedPart, computed_part
from printprep.verify.rules import compare, contact_offset_mm, support_inside
from printprep.verify.run import Verified, settings_for, slice_and_measure, verify

slicing = pytest.mark.slicer
# One worker makes the block and slices it for all of them
pytestmark = pytest.mark.xdist_group("verified block")


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_block(tmp_path_factory.mktemp("block"))


@pytest.fixture(scope="module")
def verified(block: Path, prusa_slicer: Path, tmp_path_factory: pytest.TempPathFactory) -> Verified:
    model = write_model(tmp_path_factory.mktemp("model"))
    return verify(block, slicer=prusa_slicer, compare_with=model)


def test_a_part_carries_its_figures_where_the_slicer_sees_it(block: Path):
    part = computed_part(block)
    result = hollow_block()
    assert part.mass_g == pytest.approx(result.mass_g, rel=1e-5)
    assert part.tilt_deg == pytest.approx(result.stability.tilt_deg, abs=1e-4)
    assert part.lean == result.lean
    # The bed is 250 × 210 mm, its middle is the model's x = y = 0
    np.testing.assert_allclose(part.contact_polygon_mm.mean(axis=0), [125, 105], atol=1e-3)
    np.testing.assert_allclose(part.size_mm, SIDE, atol=1e-3)
    assert part.contact_area_mm2 == pytest.approx(SIDE**2, rel=1e-4)
    at = part.placement @ [SIDE / 2, SIDE / 2, SIDE / 2, 1]
    np.testing.assert_allclose(at[:3], [125 + SIDE / 2, 105 + SIDE / 2, SIDE], atol=1e-3)
    assert len(part.cavities) == 1
    low, high = np.reshape(part.cavities[0].bounding_box(), (2, 3))
    assert (low > [125 - SIDE / 2, 105 - SIDE / 2, 0]).all()
    assert (high < [125 + SIDE / 2, 105 + SIDE / 2, SIDE]).all()


@slicing
def test_the_print_of_a_block_is_what_was_computed(verified: Verified):
    assert verified.findings == ()
    part, printed = verified.part, verified.printed
    assert printed.mass_g == pytest.approx(part.mass_g, rel=0.04)
    np.testing.assert_allclose(printed.centre_of_mass_mm, part.centre_mm, atol=0.3)
    assert printed.tilt_deg == pytest.approx(part.tilt_deg, abs=1.0)
    assert printed.contact_area_mm2 == pytest.approx(SIDE**2, rel=0.01)
    assert printed.in_cavities_mm3 == 0.0
    assert printed.filament_mm3 == pytest.approx(printed.slicer_summary.filament_mm3, rel=0.005)
    assert verified.supported is not None
    assert verified.supported.support_in_cavities_mm3 == 0.0
    assert verified.slicer.startswith("PrusaSlicer ")


@slicing
@pytest.mark.parametrize("wall_mm", [2.0, 2.4, 3.0])
def test_thick_walls_weigh_what_was_computed(prusa_slicer: Path, tmp_path: Path, wall_mm: float):
    """Where infill filled the gap between perimeters, 2.4 mm were 4.8 % too heavy."""
    result = hollow(
        trimesh.creation.box((30, 30, 12)),
        resolution=24,
        base="never",
        vaults="none",
        overrides={"wall_mm": wall_mm},
    )
    result.write(tmp_path / "thick.3mf")
    part = computed_part(tmp_path / "thick.3mf")
    settings = settings_for(part, None)
    printed, _ = slice_and_measure(find_slicer(prusa_slicer), part, settings, None, tmp_path)
    assert part.cavities and printed.in_cavities_mm3 == 0.0
    assert printed.mass_g == pytest.approx(part.mass_g, rel=0.02)


@slicing
def test_what_else_the_model_could_be(verified: Verified):
    gyroid, lightning = verified.baselines
    assert (gyroid.name, lightning.name) == ("15 % gyroid", "lightning infill")
    assert gyroid.mass_g > lightning.mass_g > 0.8 * verified.printed.mass_g
    for other in verified.baselines:
        assert other.seconds is not None and other.seconds > 60
        assert other.tilt_deg == pytest.approx(45.0, abs=3.0)  # a cube about its edge


@slicing
def test_closing_holes_fills_a_cavity_and_is_found(block: Path, prusa_slicer: Path, tmp_path: Path):
    config = tmp_path / "mine.ini"
    text = profile_ini(hollow_block().profile).replace("slicing_mode = regular", "")
    config.write_text(f"{text}slicing_mode = close_holes\n", encoding="utf-8")
    found = verify(block, slicer=prusa_slicer, load=config)
    assert {"filled-cavity", "printed-mass"} <= {item.rule for item in found.findings}
    filled = next(item for item in found.findings if item.rule == "filled-cavity")
    assert filled.severity == "error"
    assert filled.value > 1000
    low, high = np.reshape(found.part.cavities[0].bounding_box(), (2, 3))
    assert (low < filled.at_mm).all() and (filled.at_mm < high).all()


@slicing
def test_supports_that_go_inside_are_found(prusa_slicer: Path, tmp_path: Path):
    config = tmp_path / "mine.ini"  # the block's flat ceiling would be bridged
    text = profile_ini(hollow_block().profile) + "dont_support_bridges = 0\n"
    text = text.replace("buildplate_only = 1", "buildplate_only = 0")
    config.write_text(text, encoding="utf-8")
    part = tmp_path / "bare.3mf"
    replace(hollow_block(), blocker=None).write(part)
    found = verify(part, slicer=prusa_slicer, load=config)
    assert [item.rule for item in found.findings] == ["support-in-cavity"]
    assert found.findings[0].value > 100
    assert found.printed.in_cavities_mm3 == 0.0


@slicing
@pytest.mark.parametrize("said", ["filament_density = 0\n", ""])
def test_a_config_without_a_density_takes_the_profiles(
    block: Path, prusa_slicer: Path, tmp_path: Path, said: str
):
    config = tmp_path / "mine.ini"
    text = profile_ini(hollow_block().profile)
    lines = [line for line in text.splitlines() if not line.startswith("filament_density")]
    config.write_text("\n".join(lines) + "\n" + said, encoding="utf-8")
    found = verify(block, slicer=prusa_slicer, load=config)
    assert found.printed.mass_g == pytest.approx(found.part.mass_g, rel=0.04)
    assert found.printed.assumed == ()


def as_printed(part: ComputedPart, **changes: object) -> Printed:
    """A print that is exactly what was computed, but for the changes."""
    x, y, z = (float(value) for value in part.centre_mm)
    same = Printed(
        mass_g=part.mass_g,
        volume_mm3=part.mass_g / 1.24e-3,
        centre_of_mass_mm=(x, y, z),
        inertia_g_mm2=np.eye(3),
        contact_polygon_mm=part.contact_polygon_mm,
        contact_area_mm2=part.contact_area_mm2,
        tilt_deg=float(part.tilt_deg or 0.0),
        bodies=(),
        feature_mass_g={},
        feature_volume_mm3={},
        left_out=(),
        bounds_mm=np.array([part.centre_mm - 1, part.centre_mm + 1]),
        objects=(),
        filament_mm3=1e4,
        in_cavities_mm3=0.0,
        support_in_cavities_mm3=0.0,
        in_cavities_at_mm=None,
        assumed=(),
        labelled=True,
        slicer_summary=SlicerSummary("PrusaSlicer 2.5.0", 1e4, None, None, {}),
    )
    return replace(same, **changes)


def test_each_difference_has_its_rule_and_its_tolerance(block: Path):
    part = computed_part(block)
    assert list(compare(part, as_printed(part))) == []
    x, y, z = part.centre_mm
    shrunk = 125 + (part.contact_polygon_mm - [125, 105]) * 0.9 + [0, -20]
    cases = [
        ({"mass_g": part.mass_g * 1.039}, None),
        ({"mass_g": part.mass_g * 1.041}, "printed-mass"),
        ({"mass_g": part.mass_g * 0.959}, "printed-mass"),
        ({"centre_of_mass_mm": (x, y, z + 0.49)}, None),
        ({"centre_of_mass_mm": (x, y, z - 0.51)}, "printed-centre-of-mass"),
        ({"contact_polygon_mm": shrunk}, "printed-contact"),
        ({"in_cavities_mm3": 0.01}, "filled-cavity"),
        ({"filament_mm3": 1.0049e4}, None),
        ({"filament_mm3": 1.0051e4}, "filament-count"),
        ({"tilt_deg": 8.9}, "printed-tilt"),
        ({"tilt_deg": -3.0}, "printed-tilt"),
        ({"tilt_deg": 9.1}, None),
    ]
    for change, rule in cases:
        found = [item.rule for item in compare(part, as_printed(part, **change))]
        assert found == ([] if rule is None else [rule]), change
    fills = as_printed(part, support_in_cavities_mm3=0.01)
    assert [item.rule for item in support_inside(fills)] == ["support-in-cavity"]
    assert list(support_inside(as_printed(part))) == []


def test_a_lean_out_of_reach_or_toward_one_side(block: Path):
    part = computed_part(block)
    low = replace(part, lean=Lean(30.0), tilt_deg=5.0)
    assert list(compare(low, as_printed(low, tilt_deg=4.1))) == []
    assert [item.rule for item in compare(low, as_printed(low, tilt_deg=3.9))] == ["printed-tilt"]
    falling = replace(part, tilt_deg=-15.0)  # told when it was hollowed; no news of the print
    assert list(compare(falling, as_printed(falling, tilt_deg=-15.2))) == []
    barely = replace(part, lean=Lean(0.0), tilt_deg=0.5)
    assert [item.rule for item in compare(barely, as_printed(barely, tilt_deg=-0.2))] == [
        "printed-tilt"
    ]
    # Toward a corner a square foot reaches √2 as far as toward an edge
    steepness = SIDE / 2 / part.centre_mm[2]
    corner, edge = np.degrees(np.arctan(steepness * np.array([2**0.5, 1.0])))
    lean = float(edge + 4.0)
    assert corner > lean
    diagonal = replace(part, lean=Lean(lean, 45.0), tilt_deg=float(corner))
    assert list(compare(diagonal, as_printed(diagonal))) == []
    straight = replace(part, lean=Lean(lean, 0.0), tilt_deg=lean)
    assert [item.rule for item in compare(straight, as_printed(straight))] == ["printed-tilt"]


def test_the_weakest_body_counts(block: Path):
    part = computed_part(block)
    part = replace(part, bodies=part.bodies * 2)
    good = Balance(1.0, (125.0, 105.0, 12.0), part.contact_polygon_mm, 576.0, 45.0)
    weak = replace(good, tilt_deg=8.0)
    nowhere = Balance(1.0, (125.0, 105.0, 12.0), np.zeros((0, 2)), 0.0, None)
    for bodies, rules in (
        ((good, good), []),
        ((good, weak), ["printed-tilt"]),
        ((nowhere, good), ["printed-tilt"]),
    ):
        found = list(compare(part, as_printed(part, bodies=bodies, tilt_deg=30.0)))
        assert [item.rule for item in found] == rules
        assert all("weakest of its 2 bodies" in item.message for item in found)
    floating = replace(part, tilt_deg=None)  # told when it was hollowed; no news of the print
    assert list(compare(floating, as_printed(part, bodies=(nowhere, good)))) == []


def test_a_contact_narrower_than_a_line_need_not_print(tmp_path: Path):
    """A spike 0.3 mm thin on one side of the foot: with it or without, the print is as computed."""
    foot, spike = Manifold.cube((20, 20, 5)), Manifold.cube((4, 0.3, 5)).translate((20, 8, 0))
    vertices, faces = arrays(foot + spike)
    result = hollow(trimesh.Trimesh(vertices, faces), resolution=16, base="never")
    result.write(tmp_path / "spiked.3mf")
    part = computed_part(tmp_path / "spiked.3mf")
    wide, sure = np.ptp(part.contact_polygon_mm, axis=0), np.ptp(part.sure_polygon_mm, axis=0)
    assert wide[0] == pytest.approx(24, abs=1e-3) and sure[0] == pytest.approx(20, abs=0.1)
    without = part.contact_polygon_mm[part.contact_polygon_mm[:, 0] < part.middle_mm[0] + 8.5]
    assert len(without) == 4
    shift = np.array([0.7, 0.0])
    for polygon, least, most in (
        (part.contact_polygon_mm, 0.0, 0.0),
        (without, 0.0, 0.1),
        (without - shift, 0.69, 0.8),
        (part.contact_polygon_mm + shift, 0.69, 0.71),
    ):
        offset = contact_offset_mm(part, as_printed(part, contact_polygon_mm=polygon))
        assert least <= offset <= most


def rewritten(source: Path, target: Path, figures: bytes | None) -> Path:
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for entry in old.infolist():
            if entry.filename != ATTACHMENT:
                new.writestr(entry, old.read(entry))
            elif figures is not None:
                new.writestr(entry, figures)
    return target


@pytest.mark.parametrize(
    ("figures", "words"),
    [(None, "carries no"), (b"{", "is not JSON"), (b"[]", '"format": 1'), (b"{}", '"format": 1')],
)
def test_files_that_are_not_ours(block: Path, tmp_path: Path, figures: bytes | None, words: str):
    with pytest.raises(InputError, match=words) as caught:
        computed_part(rewritten(block, tmp_path / "other.3mf", figures))
    assert "other.3mf" in caught.value.message
    assert caught.value.hint is not None and "printprep hollow" in caught.value.hint


def test_a_model_is_no_part(tmp_path: Path):
    with pytest.raises(InputError, match="is not a 3MF"):
        computed_part(write_model(tmp_path))
    with pytest.raises(InputError, match="does not exist"):
        computed_part(tmp_path / "none.3mf")


@slicing
def test_another_model_is_not_compared_with(block: Path, prusa_slicer: Path, tmp_path: Path):
    import trimesh

    other = tmp_path / "ball.stl"
    trimesh.creation.icosphere(radius=9).export(other)
    with pytest.raises(UsageError, match="not the model"):
        verify(block, slicer=prusa_slicer, compare_with=other)


def test_a_missing_slicer_is_a_tool_error(block: Path, tmp_path: Path):
    with pytest.raises(ToolError):
        verify(block, slicer=tmp_path / "none")


def test_the_command_on_a_print_as_computed_and_on_a_heavier_one(
    block: Path, monkeypatch: pytest.MonkeyPatch, capsys
):
    """With a stand-in for the slicer, whose prints are made up."""
    heavier = 1.0
    slicer = SimpleNamespace(name="PrusaSlicer 2.5.0")
    monkeypatch.setattr("printprep.slicer.process.find_slicer", lambda _: slicer)
    monkeypatch.setattr(
        "printprep.verify.run.slice_and_measure",
        lambda _, part, *__: (as_printed(part, mass_g=part.mass_g * heavier), ()),
    )
    assert run(["verify", str(block), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["findings"] == [] and said["part"] == str(block)
    assert said["printed"]["tilt_deg"] == pytest.approx(said["computed"]["tilt_deg"])
    heavier = 1.2
    assert run(["verify", str(block), "--fail-on", "warning"]) == 1
    assert "printed-mass" in capsys.readouterr().out


@slicing
def test_the_command(block: Path, prusa_slicer: Path, tmp_path: Path, capsys):
    assert run(["verify", str(block), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["findings"] == [] and said["part"] == str(block)
    assert abs(said["mass_off"]) < 0.04
    assert said["printed"]["tilt_deg"] == pytest.approx(said["computed"]["tilt_deg"], abs=1)
    assert said["support_in_cavities_mm3"] == 0
    assert run(["verify", str(block)]) == 0
    text = capsys.readouterr().out
    assert "in cavities" in text and "nothing" in text and "PrusaSlicer" in text
    lying = tmp_path / "lying.3mf"
    with zipfile.ZipFile(block) as source:
        figures = json.loads(source.read(ATTACHMENT))
    figures["mass_g"] *= 1.2
    rewritten(block, lying, json.dumps(figures).encode())
    assert run(["verify", str(lying), "-q"]) == 0
    assert "weighs" in capsys.readouterr().err
    assert run(["verify", str(lying), "--fail-on", "warning"]) == 1
    assert run(["verify", str(tmp_path / "none.3mf"), "--json"]) == 3


@slicing
def test_hollow_verifies_what_it_writes(prusa_slicer: Path, tmp_path: Path, capsys):
    model, part = write_model(tmp_path), tmp_path / "out.3mf"
    common = ["hollow", str(model), "--resolution", "32", "--base", "never"]
    assert run([*common, "-o", str(part), "--verify", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["verified"]["part"] == str(part)
    assert said["verified"]["printed"]["in_cavities_mm3"] == 0
    plain = tmp_path / "plain.3mf"
    assert run([*common, "-o", str(plain), "-q"]) == 0
    assert plain.read_bytes() == part.read_bytes()
    assert run([*common, "-o", str(tmp_path / "out.stl"), "--verify"]) == 2
    assert run([*common, "-p", "sls-pa12", "-o", str(part), "--verify"]) == 2
