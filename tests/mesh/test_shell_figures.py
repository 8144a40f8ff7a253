"""Shells measured all at once, and crumbs left out."""

from __future__ import annotations

import numpy as np
import pytest
import solids
from manifold3d import Manifold

from printprep.mesh.measure import arrays, together
from printprep.mesh.repair import repair
from printprep.mesh.shell_figures import pieces, shell_figures, without_crumbs
from printprep.types import Model


def with_crumbs(count: int) -> Manifold:
    """A block of 20 mm with a void of 4 mm, and crumbs of 0.05 mm in a row above it."""
    block = solids.box(20, 20, 20) - solids.box(4, 4, 4).translate((0, 0, 8))
    crumb = solids.box(0.05, 0.05, 0.05)
    row = [crumb.translate((0.1 * (k % 100), 0.1 * (k // 100), 21.0)) for k in range(count)]
    return together([*block.decompose(), *row])


def test_figures_of_a_block_with_a_void() -> None:
    figures = shell_figures(*arrays(with_crumbs(0)))
    assert sorted(figures.volume_mm3) == pytest.approx([-64, 8000])
    void = int(np.argmin(figures.volume_mm3))
    assert figures.low_mm[void] == pytest.approx([-2, -2, 8])
    assert figures.high_mm[void] == pytest.approx([2, 2, 12])


def test_vertices_without_faces_belong_to_no_shell() -> None:
    vertices, faces = arrays(with_crumbs(3))
    plain = shell_figures(vertices, faces)
    strewn = shell_figures(np.concatenate([[[99.0, 99.0, 99.0]], vertices]), faces + 1)
    assert len(plain.volume_mm3) == 5
    for name in ("label", "volume_mm3", "low_mm", "high_mm"):
        assert np.array_equal(getattr(plain, name), getattr(strewn, name))


def test_crumbs_go_and_all_else_stays() -> None:
    left, crumbs = without_crumbs(with_crumbs(40), 0.01)
    assert crumbs == 40
    assert left.volume() == pytest.approx(8000 - 64)
    assert left.num_tri() == 24
    same, none = without_crumbs(left, 0.01)
    assert none == 0 and same is left


def test_a_model_that_is_all_small_is_no_crumb() -> None:
    speck = solids.box(0.05, 0.05, 0.05)
    assert without_crumbs(speck, 1.0)[1] == 0


def test_pieces_are_without_what_floats_in_them() -> None:
    room = solids.box(20, 20, 20) - solids.box(4, 4, 4).translate((0, 0, 8))
    (piece,) = pieces(room, 1.0)
    assert piece.volume() == pytest.approx(8000)
    assert pieces(Manifold(), 1.0) == ()
    assert pieces(solids.box(1, 1, 1), 2.0) == ()


def test_repair_leaves_out_what_the_printer_cannot_make() -> None:
    vertices, faces = arrays(with_crumbs(3000))
    model = Model(vertices, faces, np.eye(4), "crumbs")
    solid = repair(model, crumb_mm3=0.01)
    assert solid.manifold.num_tri() == 24
    assert any("too small to print" in action for action in solid.repair.actions)
