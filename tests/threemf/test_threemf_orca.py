"""The layout for OrcaSlicer: judged by its parser's rules, by lib3mf and by our reader."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
from orca_judge import read_as_orca
from test_threemf_project import BAMBU, big
from test_threemf_read import model_xml, package
from threemf_shapes import BOX_FACES, box, hollow_box, judge_strictly, volume

from printprep.errors import InputError
from printprep.mesh.read import read_mesh
from printprep.threemf.item import Item, Volume, VolumeKind
from printprep.threemf.orca import SUBTYPES
from printprep.threemf.orca_read import read_orca
from printprep.threemf.read import read_3mf
from printprep.threemf.write import write_3mf
from printprep.types import PLAIN, Material, Paint, Style

CAVE = box((2, 2, 2), (18, 18, 19))


def items() -> list[Item]:
    solid = Volume("solid & <co>", *hollow_box(20.0, 2.0))
    blocker = Volume("support blocker", CAVE, BOX_FACES, "SupportBlocker")
    dense = Volume("ballast", CAVE - 1, BOX_FACES, "ParameterModifier", {"wall_loops": "3"})
    return [
        Item("first", [solid, blocker], {"sparse_infill_density": "100%"}, (125.0, 105.0, 0.5)),
        Item("second", [Volume("cube", CAVE, BOX_FACES), dense], {}, (50.0, 40.0, -2.0)),
    ]


def written() -> bytes:
    return write_3mf(items(), dialect="orca")


def test_the_slicers_parser_finds_every_volume_in_its_place() -> None:
    found = read_as_orca(written())
    assert [one.name for one in found] == ["first", "second"]
    assert found[0].settings == {"sparse_infill_density": "100%"}
    assert found[1].settings == {}
    for object_, item in zip(found, items(), strict=True):
        assert [one.name for one in object_.volumes] == [one.name for one in item.volumes]
        for one, meant in zip(object_.volumes, item.volumes, strict=True):
            assert one.subtype == SUBTYPES[meant.kind]
            assert one.settings == meant.settings
            assert one.vertices.tolist() == (meant.vertices + item.translation_mm).tolist()
            assert one.faces.tolist() == meant.faces.tolist()


@pytest.mark.parametrize(("kind", "subtype"), list(SUBTYPES.items()))
def test_each_kind_has_its_subtype(kind: VolumeKind, subtype: str) -> None:
    solid = Volume("solid", *hollow_box(20.0, 2.0))
    other = Volume("other", CAVE, BOX_FACES, kind)
    (found,) = read_as_orca(write_3mf([Item("i", [solid, other])], dialect="orca"))
    assert [one.subtype for one in found.volumes] == ["normal_part", subtype]


def test_lib3mf_reads_it_strictly_as_components(tmp_path: Path) -> None:
    model = judge_strictly(written(), tmp_path / "a.3mf")
    assert model.GetBuildItems().Count() == 2
    assert model.GetMeshObjects().Count() == 4
    components = model.GetComponentsObjects()
    assert components.Count() == 2
    assert components.MoveNext()
    assert components.GetCurrentComponentsObject().GetComponentCount() == 2


def test_our_reader_finds_the_same_solid_and_blocker(tmp_path: Path) -> None:
    ours, prusas = tmp_path / "orca.3mf", tmp_path / "prusa.3mf"
    ours.write_bytes(write_3mf(items()[:1], dialect="orca"))
    prusas.write_bytes(write_3mf(items()[:1]))
    found, same = read_3mf(ours), read_3mf(prusas)
    assert found.names == same.names == ("first",)
    assert found.vertices.tolist() == same.vertices.tolist()
    assert found.faces.tolist() == same.faces.tolist()
    (blocker,), (other,) = found.blockers, same.blockers
    assert blocker.name == "support blocker"
    assert blocker.vertices.tolist() == other.vertices.tolist()
    assert volume(blocker.vertices, blocker.faces) == pytest.approx(16 * 16 * 17)


def test_the_same_items_give_the_same_bytes_without_a_word_of_prusas() -> None:
    assert written() == written()
    with zipfile.ZipFile(io.BytesIO(written())) as archive:
        assert set(archive.namelist()) == {
            "[Content_Types].xml",
            "_rels/.rels",
            "3D/3dmodel.model",
            "Metadata/model_settings.config",
        }
        everything = b"".join(archive.read(name) for name in archive.namelist())
    assert b"slic3r" not in everything.lower()


def test_each_volume_keeps_its_own_colours(tmp_path: Path) -> None:
    styles = (PLAIN, Style(Material("red", "#FF0000")), Style(Material("blue", "#0000FF")))
    red = Volume("v", CAVE, BOX_FACES, paint=Paint(styles, np.array([1] * 10 + [2] * 2)))
    blocker = Volume("b", CAVE, BOX_FACES, "SupportBlocker")
    content = write_3mf([Item("i", [red, blocker])], dialect="orca")
    judge_strictly(content, tmp_path / "a.3mf")
    paint = read_3mf(tmp_path / "a.3mf").paint
    assert paint is not None
    names = [paint.styles[label].material for label in paint.labels]
    assert [one.name for one in names if one is not None] == ["red"] * 10 + ["blue"] * 2


def test_the_items_are_read_back_volume_by_volume(tmp_path: Path) -> None:
    path = tmp_path / "a.3mf"
    path.write_bytes(written())
    back = read_orca(path)
    assert back is not None
    for found, item in zip(back, items(), strict=True):
        assert (found.name, found.translation_mm) == (item.name, item.translation_mm)
        for one, meant in zip(found.volumes, item.volumes, strict=True):
            assert (one.name, one.kind) == (meant.name, meant.kind)
            assert one.vertices.tolist() == meant.vertices.tolist()
            assert one.faces.tolist() == meant.faces.tolist()
    path.write_bytes(write_3mf(items()))
    assert read_orca(path) is None


@pytest.mark.parametrize(
    "spoil",
    [
        ('<item objectid="3"/>', '<item objectid="3" transform="1 0 0 0 1 0 0 0 1 9 0 0"/>'),
        ('<item objectid="3"/>', '<item objectid="1"/>'),
        ('<item objectid="3"/>', '<item objectid="77"/>'),
        ('component objectid="2" transform="1 ', 'component objectid="2" transform="2 '),
        ('component objectid="2"', 'component objectid="77"'),
    ],
)
def test_a_file_laid_out_otherwise_is_refused(tmp_path: Path, spoil: tuple[str, str]) -> None:
    path = tmp_path / "a.3mf"
    path.write_bytes(write_3mf(items()[:1], dialect="orca"))
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    text = parts["3D/3dmodel.model"].decode()
    assert spoil[0] in text
    parts["3D/3dmodel.model"] = text.replace(*spoil).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    with pytest.raises(InputError, match=r"a\.3mf is not laid out"):
        read_orca(path)


def test_a_negative_part_of_type_other_is_subtracted(tmp_path: Path) -> None:
    """As BambuStudio saves: what is not material has another type than "model"."""
    model = model_xml(
        big(1, 4)
        + big(7, 2).replace("<object ", '<object type="other" ')
        + '<object id="9"><components><component objectid="1"/><component objectid="7" transform='
        '"1 0 0 0 1 0 0 0 1 1 1 1"/></components></object>',
        '<item objectid="9"/>',
    )
    config = (
        '<config><object id="9"><part id="1" subtype="normal_part"/>'
        '<part id="7" subtype="SUBTYPE"/></object></config>'
    )
    for subtype, left in (("negative_part", 56), ("support_blocker", 64), ("modifier_part", 64)):
        path = package(tmp_path / "a.3mf", model, {BAMBU: config.replace("SUBTYPE", subtype)})
        raw = read_mesh(path)
        assert volume(raw.vertices, raw.faces) == pytest.approx(left)
        assert len(read_3mf(path).blockers) == (subtype == "support_blocker")
