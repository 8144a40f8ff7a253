"""Every broken model goes through the whole command: a part that stays, or an error that tells."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from printprep.cli.run import run

pytestmark = pytest.mark.corpus

# The exit code of each file; the conveyors are 1.5 m long, too large for vaults.
EXITS = {
    "admesh__block_remove-unconnected-bad.stl": 0,
    "admesh__conveyor_fill-holes-bad.stl": 4,
    "admesh__conveyor_normal-directions-bad.stl": 4,
    "alecjacobson__alligator.obj": 4,
    "assimp__3DSMaxExport.STL": 0,
    "assimp__malformed.obj": 3,
    "assimp__sphereWithHole.stl": 0,
    "assimp__triangle_with_empty_solid.stl": 4,
    "cnr__greek_helmet.obj": 0,
    "cnr__many_small_holes.ply": 4,
    "cnr__non_manif_hole.ply": 4,
    "derived__nan_inf_M3_hex_nut.stl": 3,
    "derived__truncated_M3_hex_nut.stl": 3,
    "elalish__1514499.stl": 0,
    "elalish__472042.stl": 0,
    "elalish__88566.stl": 0,
    "elalish__boxNotManifold.obj": 4,
    "elalish__openscad-nonmanifold-crash.obj": 0,
    "james__x_bunny.stl": 3,
    "james__z_mesh.stl": 3,
    "libigl__degenerated.obj": 4,
    "libigl__sliver_tet.ply": 4,
    "libigl__two-boxes-bad-self-union.ply": 0,
    "mikedh__busted.STL": 0,
    "mikedh__chair_model.obj": 4,
    "mikedh__empty.stl": 3,
    "mikedh__nancolor.obj": 0,
    "mikedh__notenoughindices.obj": 3,
    "mikedh__soup.stl": 4,
    "mikedh__two_objects_mixed_case_names.stl": 0,
    "odedstein__cube_no_bottom.obj": 0,
    "odedstein__plane_holes.obj": 0,
    "openscad__bad-stl-tardis.stl": 0,
    "openscad__bad-stl-wing.stl": 0,
    "openscad__cubes-touching.stl": 0,
    "openscad__empty.stl": 3,
    "openscad__issue1580-zero-area-triangle.stl": 0,
    "openscad__nonmanifold.stl": 0,
    "openscad__toomanyvertices.stl": 3,
    "openscad__unparseable.stl": 3,
    "prusa3d__20mmbox-CR.stl": 0,
    "prusa3d__20mmbox-CRLF.stl": 0,
    "prusa3d__20mmbox-nonstandard.stl": 0,
    "sgsellan__sphere_binary_solid_header.stl": 0,
    "slic3r__20mmbox.stl": 3,
    "wolph__CubeInvalidUnicode.stl": 0,
    "wolph__Moon_Chinese.stl": 0,
}


@pytest.mark.parametrize("name", EXITS)
def test_it_ends_with_a_part_or_a_clear_error(
    name: str, models_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.3mf"
    code = run(["hollow", str(models_dir / "nasty" / name), "-o", str(out), "--json"])
    told = json.loads(capsys.readouterr().out)
    assert code == EXITS[name], told
    assert out.exists() is (code == 0)
    assert ("error" in told) is (code != 0)
