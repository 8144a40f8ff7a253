"""The part of the meshlab rung that runs in a child process, which may crash or hang.

Arguments of this script: a .npz to read (vertices (n, 3) mm, faces (m, 3)), one to write, and a
recipe.  It imports nothing of printprep, so that it needs no package path.  Exit status: 0 done,
3 pymeshlab cannot be loaded, 4 the filters refused the mesh; the reason is the last line on stderr.
"""

from __future__ import annotations

import sys
from typing import Any

CANNOT_LOAD = 3
REFUSED = 4
RECIPES = ("holes", "cracks")  # gentlest first

# Corners this close, in percent of the bounding box's diagonal, are two sides of a crack.
_CRACK_PERCENT = 0.005
# Longest hole that is closed, in boundary edges; the caller judges whether closing it was right.
_LONGEST_HOLE = 100_000


def main(source: str, target: str, recipe: str) -> int:
    import numpy as np

    try:
        import pymeshlab
    except (ImportError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return CANNOT_LOAD
    with np.load(source) as given:
        mesh = pymeshlab.Mesh(given["vertices"], given["faces"].astype(np.int32))
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(mesh)
    try:
        mend(meshes, recipe, pymeshlab.PercentageValue(_CRACK_PERCENT))
    except pymeshlab.PyMeshLabException as error:
        sys.stderr.write(f"{error}\n")
        return REFUSED
    mended = meshes.current_mesh()
    np.savez(target, vertices=mended.vertex_matrix(), faces=mended.face_matrix().astype(np.int64))
    return 0


def mend(meshes: Any, recipe: str, crack: Any) -> None:
    """Remove faces that no solid has, orient the others alike, close holes.

    The recipe "cracks" first joins the sides of cracks.
    """
    if recipe == "cracks":
        meshes.meshing_merge_close_vertices(threshold=crack)
    # Faces without area stay: they connect the surface where edges meet in a T.
    meshes.meshing_remove_duplicate_faces()
    _two_manifold(meshes)
    meshes.meshing_re_orient_faces_coherently()
    meshes.meshing_close_holes(
        maxholesize=_LONGEST_HOLE, selfintersection=False, newfaceselected=False
    )
    _two_manifold(meshes)
    meshes.meshing_close_holes(
        maxholesize=_LONGEST_HOLE, selfintersection=False, newfaceselected=False
    )
    meshes.meshing_remove_unreferenced_vertices()


def _two_manifold(meshes: Any) -> None:
    """Remove edges with three faces and vertices shared by two fans; each cut can make new ones."""
    for _ in range(3):
        meshes.meshing_repair_non_manifold_edges(method="Remove Faces")
        meshes.meshing_repair_non_manifold_vertices(vertdispratio=0.0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
