"""The reader, on real files, on assemblies of boxes, and on files that mean harm."""

from __future__ import annotations

import ctypes
import io
import subprocess
import time
import zipfile
from pathlib import Path

import lib3mf
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from threemf_shapes import BOX_FACES, box, hollow_box, volume

from printprep.errors import InputError
from printprep.threemf.package import MODEL_PART
from printprep.threemf.read import read_3mf
from printprep.threemf.write import Item, Volume, write_3mf

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="a" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>{}</Relationships>'
)


def mesh_xml(low: tuple[float, float, float], high: tuple[float, float, float]) -> str:
    vertices = "".join(
        f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in box(low, high).tolist()
    )
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in BOX_FACES.tolist())
    return f"<mesh><vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh>"


UNIT_BOX = mesh_xml((0, 0, 0), (1, 1, 1))
OBJECT = f'<object id="1" type="model">{UNIT_BOX}</object>'
ITEM = '<item objectid="1"/>'


def model_xml(resources: str, build: str = ITEM, attributes: str = 'unit="millimeter"') -> str:
    return (
        f'<model {attributes} xmlns="{CORE}" xmlns:p="{PRODUCTION}"><resources>{resources}'
        f"</resources><build>{build}</build></model>"
    )


def package(path: Path, model: str | bytes, more: dict[str, str | bytes] | None = None) -> Path:
    content = {"_rels/.rels": RELS.format(""), MODEL_PART: model, **(more or {})}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(name, data)
    return path


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_3mf(path)
    assert path.name in caught.value.message
    return caught.value.message


@pytest.mark.corpus
def test_every_mustpass_file_is_read_with_finite_solids(models_dir: Path) -> None:
    files = sorted((models_dir / "3mf" / "mustpass").glob("*.3mf"))
    assert len(files) >= 10
    for file in files:
        found = read_3mf(file)
        assert np.isfinite(found.vertices).all()
        assert 0 <= found.faces.min() <= found.faces.max() == len(found.vertices) - 1
        assert volume(found.vertices, found.faces) > 0.0, file.name


@pytest.mark.corpus
def test_mustpass_figures(models_dir: Path) -> None:
    """Closed forms of the consortium's own files: a 10 mm cube, one inch, two placed things."""
    folder = models_dir / "3mf" / "mustpass"
    cube = read_3mf(folder / "MUSTPASS_Chapter3.2b_UnitsMeasurementMM.3mf")
    assert volume(cube.vertices, cube.faces) == pytest.approx(1000.0)
    inch = read_3mf(folder / "MUSTPASS_Chapter2.2_PartNaming.3mf")
    assert np.ptp(inch.vertices, axis=0) == pytest.approx([25.4, 25.4, 25.4])
    once = read_3mf(folder / "MUSTPASS_Chapter3.4.3a_MustNotOutputNonReferencedObjects.3mf")
    assert once.names == ("cube1",)


@pytest.mark.corpus
def test_mustfail_files_are_read_or_refused_in_one_line(models_dir: Path) -> None:
    files = sorted((models_dir / "3mf" / "mustfail").glob("*.3mf"))
    assert len(files) >= 15
    refusals = 0
    for file in files:
        try:
            found = read_3mf(file)
        except InputError as error:
            refusals += 1
            assert file.name in error.message
            assert "\n" not in error.message
        else:
            assert len(found.faces) > 0
    assert 3 <= refusals < len(files)  # slips in colours leave the shape alone, a DTD does not


coordinate = st.floats(-500.0, 500.0, width=32)
side = st.floats(0.125, 100.0, width=32)
boxes = st.lists(
    st.tuples(st.tuples(coordinate, coordinate, coordinate), st.tuples(side, side, side)),
    min_size=1,
    max_size=4,
)


@given(
    boxes,
    st.sampled_from([("micron", 1e-3), ("millimeter", 1.0), ("inch", 25.4), ("foot", 304.8)]),
    st.lists(st.floats(-3.0, 3.0, width=32), min_size=12, max_size=12),
)
def test_assemblies_of_boxes_keep_their_volume_under_any_transform(
    tmp_path_factory: pytest.TempPathFactory,
    placed: list[tuple[tuple[float, float, float], tuple[float, float, float]]],
    unit: tuple[str, float],
    numbers: list[float],
) -> None:
    """Boxes as components of one object, itself moved: volume × |det| × unit³, never negative."""
    path = tmp_path_factory.mktemp("boxes") / "a.3mf"
    objects, components = [], []
    for number, (low, size) in enumerate(placed, 1):
        high = (low[0] + size[0], low[1] + size[1], low[2] + size[2])
        objects.append(f'<object id="{number}">{mesh_xml(low, high)}</object>')
        components.append(f'<component objectid="{number}" transform="1 0 0 0 1 0 0 0 1 5 6 7"/>')
    whole = f'<object id="99"><components>{"".join(components)}</components></object>'
    transform = " ".join(repr(number) for number in numbers)
    xml = model_xml(
        "".join(objects) + whole,
        f'<item objectid="99" transform="{transform}"/>',
        f'unit="{unit[0]}"',
    )
    found = read_3mf(package(path, xml))
    matrix = np.array(numbers).reshape(4, 3)
    expected_faces = 12 * len(placed)
    assert len(found.faces) == expected_faces
    single = [
        np.asarray(box(low, tuple(np.add(low, size))), np.float32).astype(np.float64)
        for low, size in placed
    ]
    corners = [(box_ + np.array([5, 6, 7])) @ matrix[:3] + matrix[3] for box_ in single]
    assert found.vertices == pytest.approx(np.vstack(corners) * unit[1], rel=1e-9, abs=1e-6)
    scale = abs(np.linalg.det(matrix[:3])) * unit[1] ** 3
    for number, (_, size) in enumerate(placed):
        faces = found.faces[12 * number : 12 * number + 12]
        got = volume(found.vertices - found.vertices[faces[0, 0]], faces)
        length = np.abs(found.vertices).max() + 1.0
        assert got == pytest.approx(np.prod(size) * scale, rel=1e-6, abs=1e-9 * length**3)


def test_a_mirroring_transform_does_not_turn_the_inside_out(tmp_path: Path) -> None:
    build = '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>'
    found = read_3mf(package(tmp_path / "m.3mf", model_xml(OBJECT, build)))
    assert volume(found.vertices, found.faces) == pytest.approx(1.0)


def test_what_is_not_printed_is_left_out(tmp_path: Path) -> None:
    support = f'<object id="2" type="support">{UNIT_BOX}</object>'
    build = f'{ITEM}<item objectid="2"/><item objectid="1" printable="0"/>'
    found = read_3mf(package(tmp_path / "a.3mf", model_xml(OBJECT + support, build)))
    assert len(found.faces) == 12


def test_extension_elements_with_core_names_are_passed_over(tmp_path: Path) -> None:
    foreign = '<x:slices xmlns:x="urn:x"><x:vertex x="no"/><vertex x="no"/></x:slices>'
    found = read_3mf(package(tmp_path / "a.3mf", model_xml(foreign + OBJECT)))
    assert len(found.faces) == 12


def test_objects_in_other_parts_are_found_by_their_path(tmp_path: Path) -> None:
    """As BambuStudio and OrcaSlicer save: every object in a part of its own, named in any case."""
    whole = (
        '<object id="5"><components>'
        '<component p:path="/3D/Objects/a.model" objectid="1" transform="2 0 0 0 2 0 0 0 2 0 0 0"/>'
        '<component p:path="/3d/objects/A.model" objectid="7"/></components></object>'
    )
    other = model_xml(OBJECT + OBJECT.replace('id="1"', 'id="7"'), "")
    config = (
        '<config><object id="5"><metadata key="name" value="x"/><part id="1" subtype='
        '"normal_part"/><part id="7" subtype="modifier_part"/></object></config>'
    )
    parts: dict[str, str | bytes] = {"3D/Objects/a.model": other}
    model = model_xml(whole, '<item objectid="5"/>')
    found = read_3mf(package(tmp_path / "a.3mf", model, parts))
    assert volume(found.vertices, found.faces) == pytest.approx(9.0)
    parts["Metadata/model_settings.config"] = config
    found = read_3mf(package(tmp_path / "b.3mf", model, parts))
    assert volume(found.vertices, found.faces) == pytest.approx(8.0)
    parts["Metadata/model_settings.config"] = config.replace("modifier_part", "negative_part")
    found = read_3mf(package(tmp_path / "c.3mf", model, parts))
    assert volume(found.vertices, found.faces) == pytest.approx(8.0)
    (negative,) = found.negatives
    assert volume(negative.vertices, negative.faces) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["ParameterModifier", "SupportBlocker", "SupportEnforcer"])
def test_modifiers_leave_with_their_vertices(tmp_path: Path, kind: str) -> None:
    vertices, faces = hollow_box(10.0, 1.0)
    far = Volume("m", box((50, 50, 50), (60, 60, 60)), BOX_FACES, kind=kind)  # type: ignore[arg-type]
    path = tmp_path / "a.3mf"
    path.write_bytes(write_3mf([Item("i", [far, Volume("v", vertices, faces), far])]))
    found = read_3mf(path)
    assert found.vertices.max() == 10.0
    assert volume(found.vertices, found.faces) == pytest.approx(1000.0 - 512.0)


def test_what_lib3mf_writes_is_read(tmp_path: Path) -> None:
    """Inches, a mesh used twice as a component, the whole moved by the build item."""
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.Inch)
    mesh = model.AddMeshObject()
    points = box((0, 0, 0), (1, 2, 3)).tolist()
    mesh.SetGeometry(
        [lib3mf.Position((ctypes.c_float * 3)(*point)) for point in points],
        [lib3mf.Triangle((ctypes.c_uint32 * 3)(*face)) for face in BOX_FACES.tolist()],
    )
    pair = model.AddComponentsObject()
    pair.SetName("pair")
    pair.AddComponent(mesh, wrapper.GetIdentityTransform())
    pair.AddComponent(mesh, wrapper.GetTranslationTransform(10.0, 0.0, 0.0))
    model.AddBuildItem(pair, wrapper.GetTranslationTransform(0.0, 0.0, 4.0))
    path = tmp_path / "a.3mf"
    model.QueryWriter("3mf").WriteToFile(str(path))
    found = read_3mf(path)
    assert found.names == ("pair",)
    assert volume(found.vertices, found.faces) == pytest.approx(2 * 6 * 25.4**3)
    assert found.vertices.min(axis=0) == pytest.approx([0.0, 0.0, 4 * 25.4])
    assert found.vertices.max(axis=0) == pytest.approx([11 * 25.4, 2 * 25.4, 7 * 25.4])


@pytest.mark.slicer
def test_what_the_slicer_itself_exports_is_read(prusa_slicer: Path, tmp_path: Path) -> None:
    """Its own export points to a thumbnail that is not there."""
    vertices, faces = hollow_box(20.0, 2.0)
    ours, theirs = tmp_path / "ours.3mf", tmp_path / "theirs.3mf"
    ours.write_bytes(write_3mf([Item("i", [Volume("v", vertices, faces)], {}, (90, 80, 0))]))
    command = [str(prusa_slicer), "--dont-arrange", "--export-3mf", "-o", str(theirs), str(ours)]
    subprocess.run(command, check=True, capture_output=True, timeout=60)
    with zipfile.ZipFile(theirs) as archive:
        assert "thumbnail.png" in archive.read("_rels/.rels").decode()
        assert "Metadata/thumbnail.png" not in archive.namelist()
    found = read_3mf(theirs)
    assert volume(found.vertices, found.faces) == pytest.approx(8000.0 - 4096.0, rel=1e-6)
    assert found.vertices.min(axis=0) == pytest.approx([90.0, 80.0, 0.0], abs=1e-4)
    assert found.attachments == {}


@pytest.mark.parametrize(
    "rels", ["", RELS.replace("3dmodel.model", "elsewhere.model"), RELS.replace("/3D", "3d")]
)
def test_missing_dangling_or_odd_relationships_do_not_matter(tmp_path: Path, rels: str) -> None:
    more: dict[str, str | bytes] = {"_rels/.rels": rels.format("") or "<none/>"}
    assert len(read_3mf(package(tmp_path / "a.3mf", model_xml(OBJECT), more)).faces) == 12


@pytest.mark.parametrize(
    ("model", "says"),
    [
        (model_xml(OBJECT, ""), "prints nothing"),
        (model_xml(OBJECT, '<item objectid="8"/>'), "object 8"),
        (model_xml(OBJECT, "<item/>"), "no objectid"),
        (model_xml(OBJECT, '<item objectid="1" transform="1 0 0"/>'), "twelve numbers"),
        (model_xml(OBJECT, '<item objectid="1" transform="1 0 0 0 1 0 0 0 nan 0 0 0"/>'), "twelve"),
        (model_xml(OBJECT.replace('v1="0"', 'v1="8"')), "does not exist"),
        (model_xml(OBJECT.replace('v1="0"', 'v1="-1"')), "does not exist"),
        (model_xml(OBJECT.replace('v1="0"', f'v1="{10**30}"')), "triangle 0"),
        (model_xml(OBJECT.replace('v1="0"', "")), "triangle 0"),
        (model_xml(OBJECT.replace('x="0.0"', 'x="wide"')), "vertex 0"),
        (model_xml(OBJECT.replace('x="0.0"', 'x="nan"')), "not finite"),
        (model_xml(OBJECT.replace('x="0.0"', 'x="1e999"')), "not finite"),
        (model_xml(OBJECT * 2), "two objects"),
        (model_xml(OBJECT, attributes='unit="league"'), "league"),
        (model_xml(OBJECT, attributes='requiredextensions="p q" xmlns:q="urn:q"'), "urn:q"),
        (model_xml(UNIT_BOX), "outside an object"),
        (model_xml(OBJECT)[:-20], "unclosed token"),
        ("<html/>", "not <model>"),
        (b"\x00\x01", "not well-formed"),
        ("", "no element found"),
        (
            model_xml('<object id="1"><components><component objectid="1"/></components></object>'),
            "contain themselves",
        ),
        (
            '<!DOCTYPE model [<!ENTITY a "b">]>' + model_xml(OBJECT),
            "document type or entities",
        ),
        (
            '<!DOCTYPE model SYSTEM "file:///etc/passwd">' + model_xml(OBJECT),
            "document type or entities",
        ),
    ],
)
def test_broken_models_get_one_clear_line(tmp_path: Path, model: str | bytes, says: str) -> None:
    message = refused(package(tmp_path / "odd name.3mf", model))
    assert says in message
    assert "\n" not in message


def test_components_that_multiply_are_stopped(tmp_path: Path) -> None:
    """Ten levels of ten components each: 10^10 boxes in a few hundred bytes."""
    levels = [OBJECT] + [
        f'<object id="{level}"><components>'
        + f'<component objectid="{level - 1}"/>' * 10
        + "</components></object>"
        for level in range(2, 12)
    ]
    began = time.perf_counter()
    message = refused(package(tmp_path / "a.3mf", model_xml("".join(levels), ITEM[:-3] + '1"/>')))
    assert "too" in message
    assert time.perf_counter() - began < 30.0


def test_parts_that_unpack_to_far_more_than_they_hold_are_refused(tmp_path: Path) -> None:
    bomb = model_xml(OBJECT).encode() + b" " * (80 << 20)
    assert "unpacks to 80 MiB" in refused(package(tmp_path / "a.3mf", bomb))


def test_configs_larger_than_any_are_refused(tmp_path: Path) -> None:
    config = "<config>" + "<a/>" * (3 << 20) + "</config>"
    path = package(
        tmp_path / "a.3mf", model_xml(OBJECT), {"Metadata/Slic3r_PE_model.config": config}
    )
    assert "larger than" in refused(path)


def test_an_object_of_modifiers_alone_prints_nothing(tmp_path: Path) -> None:
    config = (
        '<config><object id="1"><volume firstid="0" lastid="11"><metadata type="volume" '
        'key="modifier" value="1"/></volume></object></config>'
    )
    path = package(
        tmp_path / "a.3mf", model_xml(OBJECT), {"Metadata/Slic3r_PE_model.config": config}
    )
    assert "prints nothing" in refused(path)


def test_names_never_reach_the_file_system(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    path = package(inside / "a.3mf", model_xml(OBJECT), {"../evil.model": "x", "/abs.txt": "y"})
    assert len(read_3mf(path).faces) == 12
    assert sorted(entry.name for entry in tmp_path.rglob("*")) == ["a.3mf", "inside"]


def test_files_that_are_no_3mf(tmp_path: Path) -> None:
    path = tmp_path / "a.3mf"
    with pytest.raises(InputError, match="does not exist"):
        read_3mf(path)
    path.write_bytes(b"")
    assert "is empty: 0 bytes" in refused(path)
    path.write_bytes(b"solid nothing")
    assert "cannot be opened as a 3MF" in refused(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("readme.txt", "hello")
    assert "no 3D model" in refused(path)


@given(st.data())
def test_no_damage_gets_past_as_anything_but_a_refusal(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    """A valid file, cut or with bytes changed, is read or refused; nothing else escapes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", data.draw(st.sampled_from([0, 8]))) as archive:
        archive.writestr("_rels/.rels", RELS.format(""))
        archive.writestr(MODEL_PART, model_xml(OBJECT))
    content = bytearray(buffer.getvalue())
    for _ in range(data.draw(st.integers(0, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    keep = data.draw(st.integers(0, len(content)))
    path = tmp_path_factory.mktemp("damage") / "a.3mf"
    path.write_bytes(bytes(content[:keep] if data.draw(st.booleans()) else content))
    try:
        read_3mf(path)
    except InputError as error:
        assert "a.3mf" in error.message
