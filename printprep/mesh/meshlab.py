"""The rung that mends the surface with MeshLab's filters, in a process of its own.

Cignoni et al., "MeshLab: an open-source mesh processing tool", 2008.  The library can crash or
hang on a broken mesh, and needs the system's libGL to load at all; neither may take printprep
down with it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh import meshlab_child
from printprep.mesh.orient import right_side_out
from printprep.mesh.shells import Candidate, Refusal, united
from printprep.mesh.weld import edge_counts, weld

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

TIMEOUT_S = 120.0


class _ChildError(Exception):
    """The process gave no mesh; ``final`` when no other recipe could fare better."""

    def __init__(self, reason: str, *, final: bool) -> None:
        super().__init__(reason)
        self.reason = reason
        self.final = final


def mended(vertices: Float, faces: Int) -> Iterator[Candidate | Refusal]:
    """What the filters make of the mesh, the gentlest recipe first, or why they make nothing."""
    for recipe in meshlab_child.RECIPES:
        try:
            corners, triangles = _run(vertices, faces, recipe)
        except _ChildError as failure:
            yield Refusal(failure.reason, skipped=failure.final)
            if failure.final:
                return
            continue
        turned, actions = right_side_out(corners, triangles)
        candidate = united(corners, turned)
        if isinstance(candidate, Candidate):
            said = (_sentence(faces, turned), *actions, *candidate.actions)
            candidate = replace(candidate, actions=said)
        yield candidate


def _sentence(before: Int, after: Int) -> str:
    edges = edge_counts(before)
    return (
        f"Mended the surface with MeshLab's filters: {edges.open_edges} open and "
        f"{edges.crowded_edges} crowded edges, {len(before)} triangles became {len(after)}."
    )


def _run(vertices: Float, faces: Int, recipe: str) -> tuple[Float, Int]:
    """The mended mesh, welded; raises _ChildError."""
    if not sys.executable:
        raise _ChildError("there is no Python to start it with", final=True)
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "given.npz", Path(folder) / "mended.npz"
        np.savez(source, vertices=vertices, faces=faces)
        # -P keeps this folder off the child's path, where its modules would shadow others.
        command = [sys.executable, "-P", meshlab_child.__file__, str(source), str(target), recipe]
        try:
            done = subprocess.run(
                command,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                errors="replace",
                timeout=TIMEOUT_S,
                check=False,
            )
        except subprocess.TimeoutExpired as error:
            reason = f"MeshLab's filters did not end within {TIMEOUT_S:g} s"
            raise _ChildError(reason, final=False) from error
        except OSError as error:
            raise _ChildError(f"MeshLab could not be started: {error}", final=True) from error
        if done.returncode != 0 or not target.is_file():
            raise _failure(done.returncode, done.stderr)
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
