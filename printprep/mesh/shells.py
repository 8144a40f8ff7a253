"""The rungs that move nothing: the mesh as it is, or its shells united.

A shell of negative volume is a void of the smallest solid shell around it; every solid shell loses
its own voids first, then all are united.  So a solid nested in a solid is swallowed, one that
floats inside a void stays, and a void that another solid covers is filled.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import manifold3d
import numpy as np

from printprep.mesh.measure import (
    innermost,
    inverted,
    shells,
    signed_volumes,
    together,
    try_manifold,
)
from printprep.mesh.weld import components

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

# A shell smaller than both is dust: a thousandth of a cubic millimetre is the volume of a cube a
# tenth of a millimetre wide, under half the layer of any printer here.
_DUST_OF_BOX = 1e-9
_DUST_MM3 = 1e-3
# A piece of surface thinner than this, relative to its size, lies in a plane and encloses nothing.
_FLAT = 1e-6
# Share of the volume that merging its shortest edges may cost on the way into the kernel.
_KEPT = 1e-6
# How far corners are moved to part folds, relative to the longest side: a step of a float32.
_NUDGE = 2.0**-23
_SEED = 20231121


@dataclass(frozen=True, eq=False)
class Candidate:
    """What a rung offers.

    actions : what was done, one sentence each;  resolution_mm : cell of a new surface, else None;
    slack_mm3 : volume the method may lose against the reference.
    """

    manifold: Manifold
    actions: tuple[str, ...] = ()
    resolution_mm: float | None = None
    slack_mm3: float = 0.0


@dataclass(frozen=True)
class Refusal:
    """Why a rung offers nothing; ``skipped`` when it could not even be tried."""

    reason: str
    skipped: bool = False


def united(vertices: Float, faces: Int) -> Candidate | Refusal:
    """The solid of a mesh (vertices (n, 3) mm, faces (m, 3) right side out), or why there is none.

    Pieces that lie in a plane enclose nothing and are left out; any other open piece is a reason
    to refuse, as closing it is another rung's work.
    """
    whole, status = try_manifold(vertices, faces)
    actions = []
    if status == "NoError" and not _kept_whole(whole, vertices, faces):
        vertices, nudge = _nudged(vertices)
        whole, status = try_manifold(vertices, faces)
        if status != "NoError" or not _kept_whole(whole, vertices, faces):
            return Refusal("its folds collapse in the boolean kernel")
        actions.append(f"Moved corners by up to {nudge:.1g} mm, to part folds without thickness.")
    if status == "NoError":
        parts, scraps, rough = whole.decompose(), 0, 0
    else:
        parts, scraps, rough = _closed_pieces(vertices, faces)
    if rough:
        return Refusal(
            f"{rough} of its pieces of surface {'is' if rough == 1 else 'are'} not closed"
        )
    solids, voids, dust = _without_dust(parts, vertices)
    if not solids:
        return Refusal("it encloses no volume")
    if scraps:
        actions.append(f"Left out {scraps} flat scrap{'s' if scraps > 1 else ''} of surface.")
    if dust:
        actions.append(f"Left out {dust} shell{'s' if dust > 1 else ''} too small to print.")
    joined, orphans = _join(solids, voids)
    if orphans:
        actions.append(f"Left out {orphans} inside-out shell{'s' if orphans > 1 else ''}.")
    before = sum(part.volume() for part in solids) - sum(part.volume() for part in voids)
    shells_before = len(solids) + len(voids)
    if not _same(joined, before, sum(part.num_tri() for part in (*solids, *voids))):
        actions.append(f"United {shells_before} shells that overlap, touch or lie in one another.")
    elif status == "NoError" and not actions:
        return Candidate(whole)
    solids, voids, dust = _without_dust(joined.decompose(), vertices)
    if dust and solids:
        joined = together([*solids, *(inverted(void) for void in voids)])
        actions.append(f"Left out {dust} shell{'s' if dust > 1 else ''} that uniting left as dust.")
    return Candidate(joined, tuple(actions))


def _kept_whole(manifold: Manifold, vertices: Float, faces: Int) -> bool:
    """Whether the kernel, cleaning up, kept the volume of the triangles it was given."""
    volume = float(signed_volumes((vertices - vertices.mean(axis=0))[faces]).sum())
    return abs(float(manifold.volume()) - volume) <= _KEPT * abs(volume)


def _nudged(vertices: Float) -> tuple[Float, float]:
    """Vertices moved at random, always alike, by up to the returned length in mm.

    Where triangles lie exactly on one another the kernel may collapse corners of the model into
    each other (measured: 71 mm off on a conveyor of 1.5 m).  Parted by as little as a file of
    single precision can tell, they are left alone.
    """
    length = _NUDGE * float(np.ptp(vertices, axis=0).max())
    steps = np.random.default_rng(_SEED).uniform(-1, 1, vertices.shape)
    return vertices + length * steps, length


def _closed_pieces(vertices: Float, faces: Int) -> tuple[list[Manifold], int, int]:
    """Manifolds of the closed pieces, the number of flat ones, and of other open ones."""
    closed: list[Manifold] = []
    scraps = rough = 0
    for group in components(faces, len(vertices)):
        piece, status = try_manifold(vertices, faces[group])
        if status == "NoError":
            closed += piece.decompose()
        elif _is_flat(vertices[np.unique(faces[group])]):
            scraps += 1
        else:
            rough += 1
    return closed, scraps, rough


def _is_flat(points: Float) -> bool:
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return len(points) <= 3 or float(spread[-1]) <= _FLAT * float(spread[0])


def _without_dust(
    parts: list[Manifold], vertices: Float
) -> tuple[list[Manifold], list[Manifold], int]:
    box = float(np.prod(vertices.max(axis=0) - vertices.min(axis=0)))
    limit = min(_DUST_OF_BOX * box, _DUST_MM3)
    kept = [part for part in parts if abs(part.volume()) > limit]
    solids: list[Manifold] = []
    voids: list[Manifold] = []
    for part in kept:
        outer, inner = shells(part)
        solids += outer
        voids += inner
    return solids, voids, len(parts) - len(kept)


def _join(solids: list[Manifold], voids: list[Manifold]) -> tuple[Manifold, int]:
    """All solids without their voids, and how many voids lie in no solid."""
    owners = [innermost(void, solids) for void in voids]
    owned: list[list[Manifold]] = [[] for _ in solids]
    for void, owner in zip(voids, owners, strict=True):
        if owner is not None:
            owned[owner].append(void)
    boolean = manifold3d.Manifold.batch_boolean
    subtract, add = manifold3d.OpType.Subtract, manifold3d.OpType.Add
    carved = [
        boolean([solid, *inner], subtract) if inner else solid
        for solid, inner in zip(solids, owned, strict=True)
    ]
    return (carved[0] if len(carved) == 1 else boolean(carved, add)), owners.count(None)


def _same(joined: Manifold, volume: float, triangles: int) -> bool:
    """Whether uniting changed nothing: all shells were apart."""
    changed = abs(float(joined.volume()) - volume) > 1e-9 * abs(volume)
    return not changed and int(joined.num_tri()) == triangles
