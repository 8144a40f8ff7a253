"""Real files, sound and broken: each has the outcome it deserves, and none a traceback."""

from __future__ import annotations

from pathlib import Path

import pytest

from printprep.errors import GeometryError, InputError
from printprep.mesh.measure import distance_to_mesh_mm
from printprep.mesh.place import place
from printprep.mesh.read import read_mesh
from printprep.mesh.repair import repair

pytestmark = pytest.mark.corpus

MENDED = {
    "barrel_large": "meshlab",
    "candle_melted": "union",
    "chair": "meshlab",
    "demosthenes-low-res": "meshlab",
    "lionstatue": "meshlab",
    "rabbit": "union",
    "suzanne": "meshlab",
    "teapot": "meshlab",
}

NASTY: dict[str, str | type[Exception]] = {
    "admesh__block_remove-unconnected-bad.stl": "union",
    "admesh__conveyor_fill-holes-bad.stl": "meshlab",
    "admesh__conveyor_normal-directions-bad.stl": "union",
    "alecjacobson__alligator.obj": GeometryError,
    "assimp__3DSMaxExport.STL": "meshlab",
    "assimp__malformed.obj": InputError,
    "assimp__sphereWithHole.stl": "meshlab",
    "assimp__triangle_with_empty_solid.stl": GeometryError,
    "cnr__greek_helmet.obj": "meshlab",
    "cnr__many_small_holes.ply": GeometryError,
    "cnr__non_manif_hole.ply": GeometryError,
    "derived__nan_inf_M3_hex_nut.stl": InputError,
    "derived__truncated_M3_hex_nut.stl": InputError,
    "elalish__1514499.stl": "as-is",
    "elalish__472042.stl": "as-is",
    "elalish__88566.stl": "as-is",
    "elalish__boxNotManifold.obj": "meshlab",
    "elalish__openscad-nonmanifold-crash.obj": "remesh",
    "james__x_bunny.stl": InputError,
    "james__z_mesh.stl": InputError,
    "libigl__degenerated.obj": GeometryError,
    "libigl__sliver_tet.ply": "as-is",
    "libigl__two-boxes-bad-self-union.ply": "union",
    "mikedh__busted.STL": "as-is",
    "mikedh__chair_model.obj": GeometryError,
    "mikedh__empty.stl": InputError,
    "mikedh__nancolor.obj": "as-is",
    "mikedh__notenoughindices.obj": InputError,
    "mikedh__soup.stl": GeometryError,
    "mikedh__two_objects_mixed_case_names.stl": "as-is",
    "odedstein__cube_no_bottom.obj": "meshlab",
    "odedstein__plane_holes.obj": "meshlab",
    "openscad__bad-stl-tardis.stl": "as-is",
    "openscad__bad-stl-wing.stl": "as-is",
    "openscad__cubes-touching.stl": "as-is",
    "openscad__empty.stl": InputError,
    "openscad__issue1580-zero-area-triangle.stl": "as-is",
    "openscad__nonmanifold.stl": "meshlab",
    "openscad__toomanyvertices.stl": InputError,
    "openscad__unparseable.stl": InputError,
    "prusa3d__20mmbox-CR.stl": "as-is",
    "prusa3d__20mmbox-CRLF.stl": "as-is",
    "prusa3d__20mmbox-nonstandard.stl": "as-is",
    "sgsellan__sphere_binary_solid_header.stl": "as-is",
    "slic3r__20mmbox.stl": InputError,
    "wolph__CubeInvalidUnicode.stl": "as-is",
    "wolph__Moon_Chinese.stl": "as-is",
}

# Volumes known by what the file shows, in mm³.
VOLUMES = {
    "elalish__boxNotManifold.obj": 0.001,
    "mikedh__nancolor.obj": 1.0,
    "mikedh__two_objects_mixed_case_names.stl": 2.0,
    "odedstein__cube_no_bottom.obj": 8.0,
    "openscad__cubes-touching.stl": 2.0,
    "openscad__issue1580-zero-area-triangle.stl": 1000.0,
    "openscad__nonmanifold.stl": 1.0,
    "prusa3d__20mmbox-CR.stl": 8000.0,
    "prusa3d__20mmbox-CRLF.stl": 8000.0,
    "prusa3d__20mmbox-nonstandard.stl": 8000.0,
    "wolph__CubeInvalidUnicode.stl": 8.0,
}


def test_every_nasty_file_has_an_outcome(models_dir: Path) -> None:
    assert {path.name for path in (models_dir / "nasty").iterdir()} == set(NASTY)


@pytest.mark.parametrize("name", sorted(NASTY))
def test_nasty(models_dir: Path, name: str) -> None:
    expected = NASTY[name]
    path = models_dir / "nasty" / name
    if isinstance(expected, str):
        solid = repair(place(read_mesh(path)))
        assert solid.repair.rung == expected
        assert solid.manifold.status().name == "NoError"
        assert solid.manifold.volume() > 0
        assert solid.manifold.bounding_box()[2] == 0
        if name in VOLUMES:
            assert solid.manifold.volume() == pytest.approx(VOLUMES[name], rel=1e-6)
    else:
        with pytest.raises(expected) as caught:
            repair(place(read_mesh(path)))
        assert path.stem in str(caught.value)
        assert "\n" not in str(caught.value)
        assert caught.value.hint  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", [
    "angle_block", "armadillo", "barrel_large", "boot", "bottle_A_brown", "bunny", "candle_melted",
    "cat-low-resolution", "chair", "cow", "decimated-max", "demosthenes-low-res", "fandisk",
    "featuretype", "fish_low_resolution", "fuze", "goathead", "hand_closed", "human_man",
    "koala_low_resolution", "lionstatue", "nefertiti-lowres", "penguin", "plane", "rabbit",
    "rocker-arm", "scorpion_low_resolution", "skull_low_resolution", "spot_low_resolution",
    "stuffedtoy", "suzanne", "teapot", "torus", "wingnut",
])  # fmt: skip
def test_dev_models_become_solids(dev_models: dict[str, object], name: str) -> None:
    row = dev_models[name]
    model = place(read_mesh(row.path), up=row.up, size_mm=100)  # type: ignore[attr-defined]
    solid = repair(model)
    assert solid.repair.rung == MENDED.get(name, "as-is")
    assert solid.manifold.status().name == "NoError"
    assert solid.manifold.bounding_box()[2] == 0
    assert solid.repair.moved_mean_mm < 0.01
    if solid.repair.rung == "as-is":  # the outside is the input's, to the last bit
        mesh = solid.manifold.to_mesh64()
        points = mesh.vert_properties[:, :3]
        assert distance_to_mesh_mm(points, model.vertices, model.faces).max() == 0
        assert solid.manifold.num_tri() == len(model.faces)
