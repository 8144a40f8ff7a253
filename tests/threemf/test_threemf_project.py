"""Projects of slicers: plates, objects, negative volumes, units, paint; and limits of a 3MF."""

from __future__ import annotations

import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from test_threemf_read import ITEM, OBJECT, UNIT_BOX, mesh_xml, model_xml, package
from threemf_shapes import BOX_FACES, box, judge_strictly, volume

from printprep.errors import GeometryError, InputError, UsageError
from printprep.mesh.read import Choice, read_mesh
from printprep.threemf.read import ATTACHMENT, ThreeMF, read_3mf
from printprep.threemf.write import Item, Volume, write_3mf
from printprep.types import PLAIN, Material, Paint, Style

BAMBU = "Metadata/model_settings.config"
PRUSA = "Metadata/Slic3r_PE_model.config"


def big(number: int, side: float, name: str = "") -> str:
    return f'<object id="{number}" name="{name}">{mesh_xml((0, 0, 0), (side, side, side))}</object>'


def plate(number: int, members: list[tuple[int, int]], name: str = "") -> str:
    inside = "".join(
        f'<model_instance><metadata key="object_id" value="{item}"/>'
        f'<metadata key="instance_id" value="{copy}"/></model_instance>'
        for item, copy in members
    )
    return (
        f'<plate><metadata key="plater_id" value="{number}"/>'
        f'<metadata key="plater_name" value="{name}"/>{inside}</plate>'
    )


NAMES = (
    '<object id="2"><metadata key="name" value="cone.stl"/></object>'
    '<object id="4"><metadata key="name" value="block.stl"/></object>'
)
TWO = model_xml(
    big(2, 1) + big(4, 2),
    '<item objectid="2"/><item objectid="4"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 9 0 0"'
    "/>",
)


def project(path: Path, plates: str, model: str = TWO) -> Path:
    return package(path, model, {BAMBU: f"<config>{NAMES}{plates}</config>"})


def total(found: ThreeMF) -> float:
    return volume(found.vertices, found.faces)


def said(found: ThreeMF) -> str:
    return " ".join(f"{note.kind}: {note.message}" for note in found.notes)


def test_plates_are_never_merged(tmp_path: Path) -> None:
    path = project(tmp_path / "a.3mf", plate(1, [(2, 0), (2, 1)]) + plate(2, [(4, 0)], "big one"))
    with pytest.raises(InputError) as caught:
        read_3mf(path)
    assert "2 plates: 1 (cone.stl), 2 'big one' (block.stl)" in caught.value.message
    assert "--plate N" in (caught.value.hint or "")
    assert total(read_3mf(path, plate=1)) == pytest.approx(2)
    assert total(read_3mf(path, plate=2)) == pytest.approx(8)
    assert read_3mf(path, plate=2).notes == ()
    with pytest.raises(UsageError, match="no plate 3") as unknown:
        read_3mf(path, plate=3)
    assert "block.stl" in (unknown.value.hint or "")
    raw = read_mesh(path, choice=Choice(plate=2))
    assert np.ptp(raw.vertices, axis=0) == pytest.approx([2, 2, 2])


def test_one_plate_needs_no_name_and_takes_only_what_lies_on_it(tmp_path: Path) -> None:
    path = project(tmp_path / "a.3mf", plate(1, [(2, 0), (2, 1)]) + plate(2, []))
    found = read_3mf(path)
    assert total(found) == pytest.approx(2)
    assert "1 object beside the plates" in said(found)
    off = project(
        tmp_path / "b.3mf",
        plate(1, [(2, 0), (2, 1)]) + plate(2, [(4, 0)]),
        TWO.replace('objectid="4"', 'objectid="4" printable="0"'),
    )
    found = read_3mf(off)
    assert total(found) == pytest.approx(2)
    assert "1 object that is not printable" in said(found)
    plain = package(tmp_path / "c.3mf", TWO)
    assert total(read_3mf(plain)) == pytest.approx(10)
    with pytest.raises(UsageError, match="no plate 1"):
        read_3mf(plain, plate=1)


def test_one_object_by_name_or_number(tmp_path: Path) -> None:
    whole = project(tmp_path / "a.3mf", plate(1, [(2, 0), (4, 0), (2, 1)]))
    found = read_3mf(whole)
    assert total(found) == pytest.approx(10)
    assert "3 objects, which were read as one model: 1 'cone.stl', 2 'block.stl'" in said(found)
    for item in ("block.stl", "BLOCK.STL", "2"):
        assert total(read_3mf(whole, item=item)) == pytest.approx(8)
    assert total(read_3mf(whole, item="cone.stl")) == pytest.approx(1)  # one of its two copies
    for item in ("", "0", "4", "-1", "9" * 400, "cone\x1b[31m"):
        with pytest.raises(UsageError) as caught:
            read_3mf(whole, item=item)
        assert "\x1b" not in caught.value.message
    plates = project(tmp_path / "b.3mf", plate(1, [(2, 0), (2, 1)]) + plate(2, [(4, 0)]))
    assert total(read_3mf(plates, item="block.stl")) == pytest.approx(8)
    with pytest.raises(UsageError, match="no object"):
        read_3mf(plates, plate=1, item="block.stl")
    same = model_xml(big(2, 1, "x") + big(4, 2, "x"), '<item objectid="2"/><item objectid="4"/>')
    with pytest.raises(UsageError, match="2 objects named 'x'"):
        read_3mf(package(tmp_path / "c.3mf", same), item="x")


def test_negative_volumes_are_subtracted_from_their_own_object(tmp_path: Path) -> None:
    cube = Volume("v", box((0, 0, 0), (9, 9, 9)), BOX_FACES)
    hole = Volume("my hole", box((8, 1, 1), (12, 3, 3)), BOX_FACES, kind="NegativeVolume")
    path = tmp_path / "a.3mf"
    path.write_bytes(
        write_3mf(
            [
                Item("one", [cube, hole], translation_mm=(100, 0, 0)),
                Item("two", [cube], translation_mm=(108, 0, 0)),
            ]
        )
    )
    raw = read_mesh(path, choice=Choice(item="one"))
    assert volume(raw.vertices, raw.faces) == pytest.approx(729 - 4)
    assert [(note.kind, "'my hole'" in note.message) for note in raw.notes] == [
        ("subtracted", True)
    ]
    both = read_mesh(path)
    assert volume(both.vertices, both.faces) == pytest.approx(2 * 729 - 4)
    path.write_bytes(
        write_3mf(
            [Item("i", [cube, Volume("v", cube.vertices * 2 - 1, BOX_FACES, "NegativeVolume")])]
        )
    )
    with pytest.raises(GeometryError, match="nothing is left"):
        read_mesh(path)


@pytest.mark.parametrize("subtype", ["negative_part", "modifier_part", "support_blocker"])
def test_components_of_bambu_and_orca(tmp_path: Path, subtype: str) -> None:
    """A negative component is subtracted where its own transform and the item's put it."""
    model = model_xml(
        big(1, 4)
        + big(7, 2)
        + '<object id="9"><components><component objectid="1"/><component objectid="7" transform='
        '"1 0 0 0 1 0 0 0 1 3 1 1"/></components></object>',
        '<item objectid="9" transform="-1 0 0 0 1 0 0 0 1 50 0 0"/>',
    )
    config = (
        f'<config><object id="9"><part id="1" subtype="normal_part"/><part id="7" subtype='
        f'"{subtype}"><metadata key="name" value="it"/></part></object></config>'
    )
    raw = read_mesh(package(tmp_path / "a.3mf", model, {BAMBU: config}))
    negative = subtype == "negative_part"
    assert volume(raw.vertices, raw.faces) == pytest.approx(60 if negative else 64)
    assert [note.kind for note in raw.notes] == ["subtracted" if negative else "left-out"]


@pytest.mark.parametrize("kind", ["ParameterModifier", "SupportBlocker", "SupportEnforcer"])
def test_what_is_left_out_is_said_but_for_our_own(tmp_path: Path, kind: str) -> None:
    far = Volume("m", box((50, 50, 50), (60, 60, 60)), BOX_FACES, kind=kind)  # type: ignore[arg-type]
    items = [Item("i", [Volume("v", box((0, 0, 0), (9, 9, 9)), BOX_FACES), far])]
    path = tmp_path / "a.3mf"
    path.write_bytes(write_3mf(items))
    found = read_3mf(path)
    assert [note.kind for note in found.notes] == ["left-out"]
    assert total(found) == pytest.approx(729)
    path.write_bytes(write_3mf(items, attachments={ATTACHMENT: b"{}"}))
    assert read_3mf(path).notes == ()


def test_hollowing_and_holes_of_a_resin_project_are_named(tmp_path: Path) -> None:
    holes = "drain_holes_format_version=1\nobject_id=1|1 2 2 0 0 -1 0.8 5\n"
    config = (
        '<config><object id="1"><metadata type="object" key="hollowing_enable" value="1"/>'
        '<volume firstid="0" lastid="11"/></object></config>'
    )
    path = package(
        tmp_path / "a.3mf",
        model_xml(OBJECT),
        {PRUSA: config, "Metadata/Slic3r_PE_sla_drain_holes.txt": holes},
    )
    text = said(read_3mf(path))
    assert "its own hollowing, its drain holes" in text
    print_config = "; printer_technology = SLA\n; hollowing_enable = 1\n"
    path = package(
        tmp_path / "b.3mf", model_xml(OBJECT), {"Metadata/Slic3r_PE.config": print_config}
    )
    assert "its own hollowing" in said(read_3mf(path))
    print_config = "; printer_technology = FFF\n; hollowing_enable = 1\n"
    path = package(
        tmp_path / "c.3mf", model_xml(OBJECT), {"Metadata/Slic3r_PE.config": print_config}
    )
    assert read_3mf(path).notes == ()


@pytest.mark.parametrize(
    ("word", "mm"),
    [
        *(("mm", 1), ("MM", 1), ("Millimeter", 1), ("millimetre", 1), ("", 1), ("cm", 10)),
        *(("in", 25.4), ("inches", 25.4), ("ft", 304.8), ("um", 1e-3), ("m", 1000), ("metre", 1e3)),
    ],
)
def test_units_as_people_write_them(tmp_path: Path, word: str, mm: float) -> None:
    path = package(tmp_path / "a.3mf", model_xml(OBJECT, attributes=f'unit="{word}"'))
    assert total(read_3mf(path)) == pytest.approx(mm**3)


def test_an_unknown_unit_is_for_the_user_to_say(tmp_path: Path) -> None:
    path = package(tmp_path / "a.3mf", model_xml(OBJECT, attributes='unit="league"'))
    with pytest.raises(InputError, match="'league'") as caught:
        read_mesh(path)
    assert "--units" in (caught.value.hint or "")
    raw = read_mesh(path, "cm")
    assert volume(raw.vertices, raw.faces) == pytest.approx(1000)
    assert raw.from_file.tolist() == np.diag([10.0, 10, 10, 1]).tolist()


# --- colours and paint

GROUPS = (
    '<basematerials id="5"><base name="red" displaycolor="#ff0000"/><base name="" displaycolor='
    '"#0000FF80"/></basematerials><m:colorgroup xmlns:m="http://schemas.microsoft.com/'
    '3dmanufacturing/material/2015/02" id="6"><m:color color="#00FF00"/></m:colorgroup>'
    '<m:texture2dgroup xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" '
    'id="7" texid="1"/>'
)


def painted(*attributes: str, own: str = "") -> str:
    """A unit box whose first faces carry attributes."""
    text = UNIT_BOX
    for face, more in zip(BOX_FACES.tolist(), attributes, strict=False):
        corners = 'v1="{}" v2="{}" v3="{}"'.format(*face)
        text = text.replace(f"<triangle {corners}/>", f"<triangle {corners} {more}/>")
    slic3r = 'xmlns:slic3rpe="http://schemas.slic3r.org/3mf/2017/06"'
    return model_xml(
        f'{GROUPS}<object id="1" {own}>{text}</object>', attributes=f'unit="millimeter" {slic3r}'
    )


def styles_of(found: ThreeMF) -> list[Style]:
    assert found.paint is not None
    return [found.paint.styles[label] for label in found.paint.labels.tolist()]


def test_colours_and_paint_of_every_dialect_are_read(tmp_path: Path) -> None:
    red, blue = Material("red", "#FF0000"), Material("#0000FF80", "#0000FF80")
    found = read_3mf(
        package(
            tmp_path / "a.3mf",
            painted(
                'pid="5" p1="1"',
                'pid="6" p1="0"',
                'paint_color="8"',
                'slic3rpe:mmu_segmentation="0C" slic3rpe:custom_seam="4"',
                'pid="5" p1="7"',
                'paint_color="not hexadecimal"',
                own='pid="5" pindex="0"',
            ),
        )
    )
    styles = styles_of(found)
    assert styles[0] == Style(blue)
    assert styles[1] == Style(Material("#00FF00", "#00FF00"))
    assert styles[2] == Style(red, (("colour", "8"),))
    assert styles[3] == Style(red, (("colour", "0C"), ("seam", "4")))
    assert styles[4] == PLAIN
    assert styles[5:] == [Style(red)] * 7
    assert found.notes == ()
    assert read_3mf(package(tmp_path / "b.3mf", model_xml(OBJECT))).paint is None


def test_textures_and_gradients_are_named_as_lost(tmp_path: Path) -> None:
    found = read_3mf(package(tmp_path / "a.3mf", painted('pid="7" p1="0" p2="1" p3="2"')))
    assert "textures" in said(found)
    found = read_3mf(package(tmp_path / "a.3mf", painted('pid="5" p1="0" p2="1" p3="0"')))
    assert "a colour for each corner" in said(found)
    assert styles_of(found)[0] == Style(Material("red", "#FF0000"))


def test_paint_that_splits_triangles_is_lost_in_a_mirror(tmp_path: Path) -> None:
    mirror = painted('paint_color="8"', 'paint_color="48046"').replace(
        ITEM, '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>'
    )
    found = read_3mf(package(tmp_path / "a.3mf", mirror))
    assert styles_of(found)[:2] == [Style(None, (("colour", "8"),)), PLAIN]
    assert "mirrors" in said(found)


def test_several_extruders_are_named_as_lost(tmp_path: Path) -> None:
    config = (
        '<config><object id="1"><metadata key="extruder" value="1"/>'
        '<volume firstid="0" lastid="5"><metadata key="extruder" value="2"/></volume>'
        '<volume firstid="6" lastid="11"/></object></config>'
    )
    path = package(tmp_path / "a.3mf", model_xml(OBJECT), {PRUSA: config})
    assert "2 extruders" in said(read_3mf(path))


def test_what_is_painted_is_written_and_read_again(tmp_path: Path) -> None:
    styles = (
        PLAIN,
        Style(Material("red & hot", "#FF0000")),
        Style(Material("blue", "#0000FF80"), (("colour", "8"), ("seam", "4"))),
    )
    labels = np.array([0, 1, 2] * 4)
    cube = Volume("v", box((0, 0, 0), (9, 9, 9)), BOX_FACES, paint=Paint(styles, labels))
    content = write_3mf([Item("i", [cube])])
    model = judge_strictly(content, tmp_path / "a.3mf")
    assert model.GetBaseMaterialGroups().Count() == 1
    found = read_3mf(tmp_path / "a.3mf")
    read = [style if style.material else None for style in styles_of(found)]
    assert read[1:3] == list(styles[1:])
    assert read[0] is not None  # plain faces take the object's own material, as the standard asks
    with zipfile.ZipFile(tmp_path / "a.3mf") as archive:
        text = archive.read("3D/3dmodel.model").decode()
    assert 'slic3rpe:mmu_segmentation="8"' in text
    assert '<metadata name="slic3rpe:MmPaintingVersion">1</metadata>' in text


# --- limits


def test_parts_of_one_name_are_ambiguous(tmp_path: Path) -> None:
    for other in ("3D/3DMODEL.model", "3d/./3dmodel.model", "3D/%33dmodel.model"):
        path = package(tmp_path / "a.3mf", model_xml(OBJECT), {other: model_xml(big(1, 3))})
        with pytest.raises(InputError, match="two parts of one name"):
            read_3mf(path)


def test_names_that_steer_a_terminal_are_written_out(tmp_path: Path) -> None:
    path = tmp_path / "a.3mf"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("3D/\x1b[31mPWNED\x07.model", "<x/>")
    with pytest.raises(InputError) as caught:
        read_3mf(path)
    assert r"\x1b[31mpwned\x07" in caught.value.message
    assert not {"\x1b", "\x07"} & set(caught.value.message)


EMPTY = "".join(f'<object id="{number}"/>' for number in range(2, 150_000))
BASES = f'<basematerials id="5">{"<base/>" * 150_000}</basematerials>'


def with_corner(text: str) -> str:
    """A unit box whose first vertex is somewhere else."""
    return model_xml(OBJECT.replace('x="0.0"', f'x="{text}"', 1))


def with_index(text: str) -> str:
    """A unit box whose first triangle names another vertex."""
    return model_xml(OBJECT.replace('v1="0"', f'v1="{text}"', 1))


def test_a_part_without_a_name_is_no_part(tmp_path: Path) -> None:
    path = tmp_path / "a.3mf"
    nameless = zipfile.ZipInfo("name")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("3D/3dmodel.model", model_xml(OBJECT))
        archive.writestr(nameless, "x")
        nameless.filename = ""  # as the list at the end of the file will name it
    assert "" in zipfile.ZipFile(path).namelist()
    assert len(read_3mf(path).faces) == 12


LIMITS = {
    "deep": (model_xml("<metadatagroup>" * 100_000 + "</metadatagroup>" * 100_000), "nested"),
    "objects": (model_xml(OBJECT + EMPTY), "100000 objects"),
    "items": (model_xml(OBJECT, ITEM * 250_000), "200000 items"),
    "bases": (model_xml(BASES), "materials"),
    "underscore": (with_corner("1_0"), "three numbers: 1_0"),
    "arabic": (with_index("٠"), "three numbers"),
    "digits": (with_index("9" * 5000), "three numbers"),
    "long": (with_corner("no" * 100_000), "characters"),
}


@pytest.mark.parametrize("name", list(LIMITS))
def test_each_limit_stops_early(tmp_path: Path, name: str) -> None:
    content, fact = LIMITS[name]
    path = tmp_path / "a.3mf"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:  # else the ratio refuses it
        archive.writestr("3D/3dmodel.model", content)
    began = time.process_time()
    with pytest.raises(InputError, match=fact) as caught:
        read_3mf(path)
    assert len(caught.value.message) < 400
    assert time.process_time() - began < 2.5


def test_copies_that_multiply_are_refused_before_they_are_made(tmp_path: Path) -> None:
    count = 3000
    vertices = "".join(f'<vertex x="{n}" y="{n % 7}" z="{n % 3}"/>' for n in range(count))
    faces = "".join(f'<triangle v1="{n}" v2="{n - 1}" v3="{n - 2}"/>' for n in range(2, count))
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh>"
    model = model_xml(f'<object id="1">{mesh}</object>', ITEM * 2000)
    with pytest.raises(InputError, match="copies with more than 2000000 triangles") as caught:
        read_3mf(package(tmp_path / "a.3mf", model))
    assert f"holds {count - 2}" in caught.value.message


def test_many_large_parts_in_a_small_file_are_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "a.3mf"
    large = model_xml(OBJECT).encode() + b" " * (60 << 20)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("3D/3dmodel.model", model_xml(OBJECT))
        for number in range(9):
            archive.writestr(f"3D/Objects/{number}.model", large)
    began = time.process_time()
    with pytest.raises(InputError, match="unpack to 540 MiB"):
        read_3mf(path)
    assert time.process_time() - began < 0.5


def test_volumes_that_overlap_over_and_over_are_refused(tmp_path: Path) -> None:
    volumes = '<volume firstid="0" lastid="99999999"><metadata key="modifier" value="1"/></volume>'
    config = f'<config><object id="1">{volumes * 1000}</object></config>'
    path = package(tmp_path / "a.3mf", model_xml(OBJECT), {PRUSA: config})
    with pytest.raises(InputError, match="overlap"):
        read_3mf(path)
    deep = "<a>" * 1000 + "</a>" * 1000
    path = package(tmp_path / "b.3mf", model_xml(OBJECT), {PRUSA: deep})
    with pytest.raises(InputError, match="nested deeper"):
        read_3mf(path)
