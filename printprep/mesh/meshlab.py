"""The repair rung that uses MeshLab's filters, in a child process.

Cignoni et al., "MeshLab: an open-source mesh processing tool", 2008.  The library can crash or
hang on a broken mesh, and loads only where the system has libGL; a child process keeps printprep
safe from all three.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.children import FloodedError, HungError, run
from printprep.files import reason_of, scratch_folder
from printprep.mesh import meshlab_child
from printprep.mesh.orient import right_side_out
from printprep.mesh.shells import DUST_MM3, Candidate, Refusal, united
from printprep.mesh.weld import edge_counts, weld

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

TIMEOUT_S = 120.0


class _ChildError(Exception):
    """The child gave no mesh; ``final`` where no other recipe would help."""

    def __init__(self, reason: str, *, final: bool) -> None:
        super().__init__(reason)
        self.reason = reason
        self.final = final


def mended(
    vertices: Float, faces: Int, crumb_mm3: float = DUST_MM3
) -> Iterator[Candidate | Refusal]:
    """The solid that each recipe of filters makes, the gentlest first, or why it makes none.

    vertices : (n, 3) mm;  faces : (m, 3);  crumb_mm3 : shells of less volume are left out.
    """
    for recipe in meshlab_child.RECIPES:
        try:
            corners, triangles = _run(vertices, faces, recipe)
        except _ChildError as failure:
            yield Refusal(failure.reason, skipped=failure.final)
            if failure.final:
                return
            continue
        turned, actions = right_side_out(corners, triangles)
        candidate = united(corners, turned, crumb_mm3)
        if isinstance(candidate, Candidate):
            done = (_sentence(faces, turned), *actions, *candidate.actions)
            candidate = replace(candidate, actions=done)
        yield candidate


def _sentence(before: Int, after: Int) -> str:
    """What the filters did to faces (m, 3), in words."""
    edges = edge_counts(before)
    return (
        f"Repaired the surface with MeshLab's filters: it had {edges.open_edges} open edges and "
        f"{edges.crowded_edges} edges with more than two faces; {len(before)} triangles became "
        f"{len(after)}."
    )


def _run(vertices: Float, faces: Int, recipe: str) -> tuple[Float, Int]:
    """The filtered mesh, welded: (n, 3) mm and (m, 3), as the arguments.  Raises _ChildError."""
    if not sys.executable:
        raise _ChildError("there is no Python to start MeshLab with", final=True)
    with scratch_folder() as folder:
        source, target = folder / "given.npz", folder / "mended.npz"
        np.savez(source, vertices=vertices, faces=faces)
        # -P keeps this folder off the child's path: its modules would hide others.
        command = [sys.executable, "-P", meshlab_child.__file__, str(source), str(target), recipe]
        try:
            ended = run(command, TIMEOUT_S)
        except HungError as error:  # another recipe would hang as long
            raise _ChildError(f"the process of MeshLab's filters {error}", final=True) from error
        except FloodedError as error:
            raise _ChildError("MeshLab's filters printed without end", final=True) from error
        except OSError as error:
            raise _ChildError(
                f"MeshLab could not be started: {reason_of(error)}", final=True
            ) from error
        if ended.exit_code != 0 or not target.is_file():
            raise _failure(ended.exit_code, ended.stderr)
        with np.load(target) as result:
            return weld(result["vertices"], result["faces"])


def _failure(status: int, stderr: str) -> _ChildError:
    lines = stderr.strip().splitlines()
    last = lines[-1][:200] if lines else "no reason given"
    if status == meshlab_child.CANNOT_LOAD:
        return _ChildError(f"pymeshlab cannot be loaded here ({last})", final=True)
    if status == meshlab_child.REFUSED:
        return _ChildError(f"MeshLab's filters refused the mesh ({last})", final=False)
    return _ChildError(f"MeshLab's filters crashed (status {status})", final=False)
