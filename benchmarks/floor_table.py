"""How much longer the stages of `hollow` take than the libraries under them, on the same data.

    python benchmarks/floor_table.py samples/spot.stl samples/goathead.stl -o floor.md

Each model is hollowed once in this process; what the libraries are asked is kept, and each library
is asked the same again, alone.  Their sum is the floor: no program built on them is quicker, unless
it asks less.  Modules are loaded before, and both are timed in one run.
"""

from __future__ import annotations

import argparse
import io
import os
import platform
import time
import zipfile
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import fast_simplification
import igl
import numpy as np
import trimesh
from manifold3d import Manifold, Mesh64, OpType
from rows import Row, markdown_lines
from skimage.measure import marching_cubes

from printprep.mesh.measure import arrays
from printprep.output.item import solid_item
from printprep.pipeline.hollow import hollow
from printprep.pipeline.options import Placement
from printprep.pipeline.prepare import prepare
from printprep.profiles import load_profile
from printprep.progress import SILENT
from printprep.supports import build
from printprep.threemf.write import write_3mf


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("models", type=Path, nargs="+")
    parser.add_argument("-o", "--output", type=Path, required=True, help="Markdown table")
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    chosen = parser.parse_args()
    hollow(chosen.models[0], size_mm=20.0)  # loads all modules
    lines = [f"{platform.machine()}, {os.cpu_count()} processors", ""]
    for model in chosen.models:
        rows = measured(model, chosen.size)
        lines += [f"**{model.stem}**", "", *table(rows), ""]
    chosen.output.write_text("\n".join(lines), encoding="utf-8", newline="\n")
    return 0


def measured(model: Path, size_mm: float) -> list[Row]:
    """Seconds of each stage, and of its libraries alone."""
    unions: list[tuple[Manifold, list[Manifold]]] = []
    plain = build._without

    def kept(volume: Manifold, pieces: Sequence[Any]) -> Manifold:
        unions.append((volume, [build.united([piece]) for piece in pieces]))
        return plain(volume, pieces)

    build._without = kept
    try:
        result = hollow(model, size_mm=size_mm)
    finally:
        build._without = plain
    start = time.perf_counter()
    hollow(model, size_mm=size_mm)
    whole_s = time.perf_counter() - start
    stages = hollow(model, size_mm=size_mm).seconds

    solid = prepare(model, load_profile(result.profile.name), Placement(size_mm=size_mm), SILENT)
    outside = arrays(solid.solid.manifold)
    part = arrays(result.part.manifold)
    depths, deep = result.workings.depths, result.workings.deep
    assert depths.field is not None
    field = depths.field
    wall_mm = result.profile.wall_mm
    near = np.abs(field.depth_mm - wall_mm) < 1.5 * field.grid.pitch_mm
    cells = np.argwhere(near) * field.grid.pitch_mm + field.grid.origin_mm
    coarse = np.argwhere(depths.coarse.depth_mm > 0) * depths.grid.pitch_mm + depths.grid.origin_mm
    level, faces, _, _ = marching_cubes(field.depth_mm, wall_mm)
    middles = part[0][part[1]].mean(axis=1)
    package = zipfile.ZipFile(
        io.BytesIO(write_3mf([solid_item(result.part.manifold, "part", result.profile)]))
    )
    xml = max((package.read(name) for name in package.namelist()), key=len)
    floors: list[tuple[str, str, Callable[[], object]]] = [
        ("read", "trimesh", lambda: trimesh.load(model, process=False)),
        ("repair", "manifold3d", lambda: Manifold(Mesh64(*_for_kernel(outside)))),
        ("voxelize", "libigl", lambda: [_distance(points, outside) for points in (coarse, cells)]),
        ("cavity", "scikit-image", lambda: marching_cubes(field.depth_mm, wall_mm)),
        (
            "cavity",
            "fast-simplification",
            lambda: fast_simplification.simplify(
                level.astype(np.float64), faces.astype(np.int32), target_count=deep.num_tri()
            ),
        ),
        ("supports", "manifold3d", lambda: [_cut(volume, pieces) for volume, pieces in unions]),
        ("check", "libigl", lambda: _distance(middles, outside)),
        ("check", "manifold3d", lambda: result.part.manifold.decompose()),
        ("write", "zlib", lambda: zlib.compress(xml, 6)),
    ]
    rows: list[Row] = []
    for stage, library, ask in floors:
        start = time.perf_counter()
        ask()
        rows.append({"stage": stage, "library": library, "floor": time.perf_counter() - start})
    for row in rows:
        row["ours"] = stages.get(row["stage"])
    floor = sum(row["floor"] for row in rows)
    rows.append({"stage": "all", "library": "all of these", "floor": floor, "ours": whole_s})
    return rows


def _for_kernel(mesh: tuple[Any, Any]) -> tuple[Any, Any]:
    return np.require(mesh[0], requirements=["W"]), np.require(mesh[1], np.uint64, ["W"])


def _distance(points: Any, mesh: tuple[Any, Any]) -> object:
    return igl.point_mesh_squared_distance(np.ascontiguousarray(points, dtype=np.float64), *mesh)


def _cut(volume: Manifold, pieces: Sequence[Manifold]) -> float:
    """The kernel works when the volume is asked for."""
    return float((volume - Manifold.batch_boolean(list(pieces), OpType.Add)).volume())


def table(rows: Sequence[Row]) -> list[str]:
    """The rows, and the ratio of the whole."""
    columns = [
        ("stage", "stage", "{}"),
        ("library", "library", "{}"),
        ("alone s", "floor", "{:.3f}"),
        ("the stage s", "ours", "{:.2f}"),
    ]
    ratio = rows[-1]["ours"] / rows[-1]["floor"]
    return [*markdown_lines(columns, rows), "", f"The run takes {ratio:.1f} × the libraries alone."]


if __name__ == "__main__":
    raise SystemExit(main())
