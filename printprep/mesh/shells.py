"""The repair rungs that move no vertex: the mesh as it is, or its shells united.

A shell of negative volume is a void of the smallest solid shell around it.  First each solid shell
loses its voids, then all are united.  So a solid inside the material of another becomes part of it,
a solid that floats inside a void stays, and a void that another solid covers is filled.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import manifold3d
import numpy as np

from printprep.mesh.measure import innermost, shells, signed_volumes, try_manifold
from printprep.mesh.shell_figures import CRUMB_SHARE, without_crumbs
from printprep.mesh.weld import components
from printprep.wording import counted

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

# 0.001 mm³ is a cube of 0.1 mm, which no printer resolves.
DUST_MM3 = 1e-3
# A piece of surface thinner than this, relative to its size, lies in a plane and encloses nothing.
_FLAT = 1e-6
# Share of the volume that may be lost when the kernel merges the shortest edges.
_KEPT = 1e-6
# How far vertices move to separate folds, relative to the longest side: one step of a float32.
_NUDGE = 2.0**-23
_SEED = 20231121


@dataclass(frozen=True, eq=False)
class Candidate:
    """The solid that a repair rung gives.

    actions : what the rung did, one sentence each;  resolution_mm : cell size of a new surface,
    else None;  slack_mm3 : volume that the method may lose against the reference.
    """

    manifold: Manifold
    actions: tuple[str, ...] = ()
    resolution_mm: float | None = None
    slack_mm3: float = 0.0


@dataclass(frozen=True)
class Refusal:
    """Why a rung gives no solid; ``skipped`` where it could not be tried."""

    reason: str
    skipped: bool = False


def united(vertices: Float, faces: Int, least_mm3: float = DUST_MM3) -> Candidate | Refusal:
    """The union of a mesh's shells, or why there is none.

    vertices : (n, 3) mm;  faces : (m, 3), right side out;  least_mm3 : shells of less volume are
    left out, unless the whole model is that small.  Pieces that lie in a plane enclose
    nothing and are left out; any other open piece is a refusal, since other rungs close it.
    """
    whole, status = try_manifold(vertices, faces)
    actions = []
    if status == "NoError" and not _kept_whole(whole, vertices, faces):
        vertices, nudge = _nudged(vertices)
        whole, status = try_manifold(vertices, faces)
        if status != "NoError" or not _kept_whole(whole, vertices, faces):
            return Refusal("its folds collapse in the boolean kernel")
        actions.append(
            f"Moved vertices by up to {nudge:.1g} mm, to separate folds without thickness."
        )
    if status == "NoError":
        large, dust = without_crumbs(whole, least_mm3)
        parts, scraps, rough = large.decompose(), 0, 0
    else:
        parts, scraps, rough = _closed_pieces(vertices, faces)
        parts, dust = _without_dust(parts, least_mm3)
    if rough:
        return Refusal(
            f"{counted(rough, 'piece')} of its surface {'is' if rough == 1 else 'are'} not closed"
        )
    solids, voids = _by_sign(parts)
    if not solids:
        return Refusal("it encloses no volume")
    if scraps:
        actions.append(f"Left out {counted(scraps, 'flat piece')} of surface.")
    if dust:
        actions.append(f"Left out {counted(dust, 'shell')} too small to print.")
    joined, orphans = _join(solids, voids)
    if orphans:
        actions.append(f"Left out {counted(orphans, 'inside-out shell')}.")
    before = sum(part.volume() for part in solids) - sum(part.volume() for part in voids)
    shells_before = len(solids) + len(voids)
    if not _same(joined, before, sum(part.num_tri() for part in (*solids, *voids))):
        actions.append(
            f"United {shells_before} shells that overlap, touch or lie inside one another."
        )
    elif status == "NoError" and not actions:
        return Candidate(whole)
    joined, dust = without_crumbs(joined, least_mm3)
    if dust:
        actions.append(f"Left out {counted(dust, 'shell')} of the union, too small to print.")
    return Candidate(joined, tuple(actions))


def _kept_whole(manifold: Manifold, vertices: Float, faces: Int) -> bool:
    """Whether the kernel's clean-up kept the volume of vertices (n, 3) mm and faces (m, 3)."""
    volume = float(signed_volumes((vertices - vertices.mean(axis=0))[faces]).sum())
    return abs(float(manifold.volume()) - volume) <= _KEPT * abs(volume)


def _nudged(vertices: Float) -> tuple[Float, float]:
    """(n, 3) mm, vertices moved at random (fixed seed), and how far each may move in mm.

    Where triangles lie exactly on one another, the kernel may collapse vertices of the model into
    each other (measured: 71 mm off on a conveyor of 1.5 m).  It keeps them where they are apart by
    the smallest step that a file of single precision can hold.
    """
    length = _NUDGE * float(np.ptp(vertices, axis=0).max())
    steps = np.random.default_rng(_SEED).uniform(-1, 1, vertices.shape)
    return vertices + length * steps, length


def _closed_pieces(vertices: Float, faces: Int) -> tuple[list[Manifold], int, int]:
    """Manifolds of the closed pieces, the number of flat pieces, and that of other open ones.

    vertices : (n, 3) mm;  faces : (m, 3).
    """
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
    """Whether points (k, 3) lie in a plane."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return len(points) <= 3 or float(spread[-1]) <= _FLAT * float(spread[0])


def _without_dust(parts: list[Manifold], least_mm3: float) -> tuple[list[Manifold], int]:
    """The parts that are large enough to print, and how many are not."""
    sizes = [abs(part.volume()) for part in parts]
    limit = min(least_mm3, CRUMB_SHARE * sum(sizes))
    kept = [part for part, size in zip(parts, sizes, strict=True) if size >= limit]
    return kept, len(parts) - len(kept)


def _by_sign(parts: list[Manifold]) -> tuple[list[Manifold], list[Manifold]]:
    """The solids and the voids of parts; voids as positive solids."""
    solids: list[Manifold] = []
    voids: list[Manifold] = []
    for part in parts:
        outer, inner = shells(part)
        solids += outer
        voids += inner
    return solids, voids


def _join(solids: list[Manifold], voids: list[Manifold]) -> tuple[Manifold, int]:
    """The union of all solids without their voids, and how many voids lie in no solid."""
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
    """Whether the union changed nothing because all shells were apart."""
    changed = abs(float(joined.volume()) - volume) > 1e-9 * abs(volume)
    return not changed and int(joined.num_tri()) == triangles
