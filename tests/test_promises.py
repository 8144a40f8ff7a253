"""The judge of random solids is judged: each planted fault is found, and a sound part has none."""

from __future__ import annotations

from dataclasses import replace

import promises
import pytest
import trimesh
from judges import Mesh
from manifold3d import Manifold
from promises import Judged

from printprep import hollow
from printprep.mesh.measure import arrays
from printprep.result import HollowResult

SIZE_MM = 14.0
BLOCK = Manifold.cube((SIZE_MM,) * 3).translate((-SIZE_MM / 2, -SIZE_MM / 2, 0.0))


def judged(result: HollowResult, part: Manifold) -> Judged:
    return Judged(result, BLOCK, Mesh(*arrays(part)))


@pytest.fixture(scope="module")
def result() -> HollowResult:
    mesh = trimesh.Trimesh(*arrays(BLOCK), process=False)
    return hollow(mesh, profile="resin-standard", resolution=16)


def block_around(room_mm: float, *, off_mm: float = 0.0) -> Manifold:
    """The block, with a cubic room inside, its middle moved aside."""
    return BLOCK - Manifold.cube((room_mm,) * 3, True).translate((off_mm, 0.0, SIZE_MM / 2))


def test_a_sound_part_breaks_no_promise(result: HollowResult):
    assert promises.broken_promises(result, BLOCK, again=None) == []


def test_a_thin_wall_is_found(result: HollowResult):
    room_mm = SIZE_MM - 2 * result.profile.wall_mm
    assert promises._wall(judged(result, block_around(room_mm))) == []
    assert "3: a wall is" in promises._wall(judged(result, block_around(room_mm, off_mm=0.2)))[0]


def test_a_wall_that_is_thin_only_amid_a_face_is_found(result: HollowResult):
    room_mm = SIZE_MM - 2 * result.profile.wall_mm
    dent = Manifold.cylinder(0.8, 0.0, 3.0, 8).translate((0.0, 0.0, SIZE_MM - 0.8))
    outside = BLOCK - dent
    dented = replace(result, part=replace(result.part, outside=outside))
    part = block_around(room_mm) - dent
    assert "3: a wall is" in promises._wall(Judged(dented, outside, Mesh(*arrays(part))))[0]


def test_a_room_without_air_is_found(result: HollowResult):
    shut = block_around(6.0)
    assert "6: " in promises._inside(judged(result, shut))[0]
    assert promises._inside(judged(result, shut - Manifold.cylinder(9.0, 1.5, 1.5, 16))) == []


def test_a_crack_is_no_room_though_a_grid_cuts_it_to_pieces(result: HollowResult):
    crack = Manifold.cube((SIZE_MM, 0.8 * SIZE_MM, 0.3), True).rotate((0.0, 10.0, 0.0))
    cracked = judged(result, BLOCK - crack.translate((2.0, 0.0, SIZE_MM / 2)))
    assert promises._largest_shut_off_mm3(cracked, 0.5) > 8.2  # a ball as wide as a drain hole
    assert promises._inside(cracked) == []


def test_what_lies_beyond_or_is_missing_is_found(result: HollowResult):
    beyond = replace(result.part, manifold=BLOCK + BLOCK.translate((1.0, 0.0, 0.0)))
    grown = Judged(replace(result, part=beyond), BLOCK, Mesh(*arrays(beyond.manifold)))
    assert "lie outside the model" in promises._outside(grown)[0]
    cut = BLOCK - BLOCK.translate((10.0, 0.0, 0.0))
    assert "mm off the part" in promises._outside(judged(result, cut))[0]


def test_an_open_mesh_and_a_wrong_volume_are_found(result: HollowResult):
    vertices, faces = arrays(result.part.manifold)
    open_mesh = Judged(result, BLOCK, Mesh(vertices, faces[1:]))
    assert "open" in promises._manifold(open_mesh)[0]
    assert "its volume is" in promises._manifold(judged(result, BLOCK))[0]


def test_a_part_that_tips_is_found(result: HollowResult):
    def leaning(angle_deg: float) -> Judged:
        return judged(replace(result, lean=replace(result.lean, angle_deg=angle_deg)), BLOCK)

    assert promises._stands(leaning(44.0)) == []
    assert "4: it tips at 45" in promises._stands(leaning(46.0))[0]  # a full cube tips at 45°


def test_other_bytes_of_a_second_run_are_found(result: HollowResult):
    assert "7: " in promises.broken_promises(result, BLOCK, again=b"other")[0]
