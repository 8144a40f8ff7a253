"""The promises of a part, judged by programs that are not ours: trimesh, lib3mf, libigl, manifold.

Each function takes the written triangles and the model's own outside, and says what is broken.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import igl
import judges
import numpy as np
import trimesh
from manifold3d import CrossSection, Manifold, OpType
from numpy.typing import NDArray
from scipy.ndimage import label

from printprep.mesh.measure import arrays
from printprep.pipeline.check import check

if TYPE_CHECKING:
    from printprep.result import HollowResult
    from printprep.types import Drain

Float = NDArray[np.float64]

WALL_MM = 0.05  # the promise
DRILL_STEP_MM = 0.1  # between the points at which a hole is measured
OFF_MM = 0.02
LEAN_DEG = 0.3  # sections by another program
SAMPLES = 4000
SEVERITIES = ("none", "info", "warning", "error")


@dataclass(frozen=True, eq=False)
class Judged:
    """What a part is judged by.

    outside : the model with its empty voids filled, on the plate;  written : the part's triangles,
    as trimesh reads them.
    """

    result: HollowResult
    outside: Manifold
    written: judges.Mesh

    @property
    def mesh(self) -> trimesh.Trimesh:
        return trimesh.Trimesh(self.written.vertices, self.written.faces, process=False)


def broken_promises(result: HollowResult, outside: Manifold, *, again: bytes | None) -> list[str]:
    """Every promise that a part breaks, in words; none for a part that keeps them.

    again : the bytes that a second run wrote, None where there was none.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.3mf"
        result.write(path)
        if again is not None and path.read_bytes() != again:
            return ["7: a second run writes other bytes"]
        _, warnings = judges.read_strictly(path)
        # In a 3MF a support blocker lies in the same mesh as the part.
        alone = Path(folder) / "part.stl"
        result.write(alone, without_blocker=True)
        mesh = trimesh.load_mesh(alone)
        written = judges.Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int64))
        broken = [f"2: lib3mf warns: {text}" for text in warnings]
        checked = check(path, profile=result.profile, lean=result.lean)
    said = {item.rule: item.severity for item in reversed(result.findings)}
    broken += [
        f"check says what hollow did not: {item.rule}, {item.severity}"
        for item in checked.findings
        if SEVERITIES.index(item.severity) > SEVERITIES.index(said.get(item.rule, "none"))
    ]
    judged = Judged(result, outside, written)
    for promise in (_outside, _manifold, _wall, _stands, _certificate, _inside):
        broken += promise(judged)
    return broken


def _beside_drains(judged: Judged, points: Float) -> NDArray[np.bool_]:
    """Which points (n, 3) mm lie around the mouth of a drain hole."""
    near = np.zeros(len(points), dtype=bool)
    for drain in _drains(judged):
        along, across = _from_axis(drain, points)
        reach = drain.length_mm + 2 * drain.diameter_mm
        near |= (across < 0.7 * drain.diameter_mm) & (np.abs(along) < reach)
    return near


def _along_drills(judged: Judged, points: Float) -> NDArray[np.bool_]:
    """Which points (n, 3) mm may lie on the side of a drain hole, anywhere on its way in."""
    drilled = np.zeros(len(points), dtype=bool)
    for drain in _drains(judged):
        along, across = _from_axis(drain, points)
        drilled |= (across < 0.51 * drain.diameter_mm) & (along < 0)
    return drilled


def _drains(judged: Judged) -> tuple[Drain, ...]:
    drainage = judged.result.drainage
    return () if drainage is None else drainage.drains


def _from_axis(drain: Drain, points: Float) -> tuple[Float, Float]:
    """(n,) mm outward from the mouth along a hole's axis, and (n,) mm from the axis."""
    axis = np.array(drain.axis)
    away = points - np.array(drain.centre_mm)
    along = away @ axis
    return along, np.linalg.norm(away - along[:, None] * axis, axis=1)


def _bounds(solid: Manifold, points: Float, normals: Float) -> NDArray[np.bool_]:
    """Which points of a surface bound a solid: a crack or a fin of no thickness bounds nothing."""
    inside, outside = (
        _winding(points + step * normals, *arrays(solid)) > 0.5 for step in (-1e-3, 1e-3)
    )
    return inside & ~outside


def _closed_off(standing: Manifold, points: Float) -> NDArray[np.bool_]:
    """Which points lie on voids that a base closes off from the air: those are filled."""
    off = np.zeros(len(points), dtype=bool)
    for shell in standing.decompose():
        if shell.volume() < 0:
            squared, _, _ = igl.point_mesh_squared_distance(points, *arrays(shell))
            off |= squared < OFF_MM**2
    return off


def _in_own_voids(judged: Judged, points: Float) -> NDArray[np.bool_]:
    """Which points lie in voids that the model brought and that stay: their walls are its own."""
    inside = np.zeros(len(points), dtype=bool)
    for void in judged.result.part.kept:
        squared, _, _ = igl.point_mesh_squared_distance(points, *arrays(void))
        inside |= (squared < OFF_MM**2) | (_winding(points, *arrays(void)) > 0.5)
    return inside


def _outside(judged: Judged) -> list[str]:
    """1: the model's outside is the part's, but for a base and drain holes."""
    part = judged.result.part
    base = Manifold() if part.base is None else part.base.manifold
    # What a base closes off from the air is filled.
    shells = [shell for shell in (judged.outside + base).decompose() if shell.volume() > 0]
    beyond = (part.manifold - Manifold.batch_boolean(shells, OpType.Add)).volume()
    slack = 1e-3 * judged.outside.surface_area()
    broken = []
    if beyond > slack:
        broken.append(f"1: {beyond:.3g} mm³ of the part lie outside the model and its base")
    model = trimesh.Trimesh(*arrays(judged.outside), process=False)
    points, faces = trimesh.sample.sample_surface(model, SAMPLES, seed=0)
    points = np.asarray(points)
    free = ~_beside_drains(judged, points)
    if part.base is not None:
        low, high = np.reshape(base.bounding_box(), (2, 3))
        free &= ((points < low - 0.01) | (points > high + 0.01)).any(axis=1)
        free &= ~_closed_off(judged.outside + base, points)
    squared, _, _ = igl.point_mesh_squared_distance(
        points[free], judged.written.vertices, judged.written.faces
    )
    distance = np.sqrt(squared)
    allowed_mm = OFF_MM + judged.result.solid.repair.moved_max_mm  # which the report tells
    far = distance > allowed_mm
    normals = model.face_normals[faces][free]
    distance[far] *= _bounds(judged.outside, points[free][far], normals[far])
    off = float(distance.max(initial=0.0))
    if off > allowed_mm:
        broken.append(f"1: the model's surface lies {off:.3g} mm off the part")
    # Just under the model's surface there is material.
    under = points[free] - 0.3 * judged.result.profile.wall_mm * normals
    in_model = _winding(under, *arrays(judged.outside)) > 0.99
    squared, _, _ = igl.point_mesh_squared_distance(under, *arrays(judged.outside))
    in_model &= ~_in_own_voids(judged, under)
    in_model &= squared > OFF_MM**2  # beside a sharp edge they may lie on another face
    in_part = _winding(under, judged.written.vertices, judged.written.faces) > 0.5
    missing = float((in_model & ~in_part).mean()) if len(under) else 0.0
    if missing > 0:
        broken.append(f"1: {100 * missing:.2g} % of the surface has no wall under it")
    return broken


def _winding(points: Float, vertices: Float, faces: NDArray[np.int64]) -> Float:
    result: Float = igl.winding_number(
        np.ascontiguousarray(vertices), np.ascontiguousarray(faces), np.ascontiguousarray(points)
    )
    return result


def _manifold(judged: Judged) -> list[str]:
    """2: one watertight, consistently oriented manifold of the volume that the figures say."""
    mesh, result = judged.mesh, judged.result
    broken = []
    if not (mesh.is_watertight and mesh.is_winding_consistent):
        broken.append("2: trimesh finds it open, or turned inconsistently")
    expected = result.mass_g / result.profile.material.density_g_cm3 * 1000
    if not math.isclose(mesh.volume, expected, rel_tol=1e-4, abs_tol=0.01):
        broken.append(f"2: its volume is {mesh.volume:.6g} mm³, the figures say {expected:.6g}")
    status = str(result.part.manifold.status().name)
    if status != "NoError":
        broken.append(f"2: the kernel says {status}")
    inside = [shell for shell in mesh.split(only_watertight=False) if shell.volume > 0]
    bodies = [shell for shell in judged.outside.decompose() if shell.volume() > 0]
    if len(inside) > len(bodies):
        broken.append(f"6: {len(inside)} bodies are in the part, {len(bodies)} in the model")
    return broken


def _wall(judged: Judged) -> list[str]:
    """3: what is not on the outside is deeper than the wall, along a drill than half of it."""
    part, profile = judged.result.part, judged.result.profile
    surface = arrays(part.outside)
    points, _ = trimesh.sample.sample_surface(judged.mesh, SAMPLES, seed=0)
    points = np.vstack([judged.written.vertices, points])
    points = points[~_beside_drains(judged, points) & ~_in_own_voids(judged, points)]
    squared, _, _ = igl.point_mesh_squared_distance(points, *surface)
    distance = np.sqrt(squared)
    drilled = _along_drills(judged, points)
    for limit_mm, which in (
        (profile.wall_mm - WALL_MM, ~drilled),
        (profile.wall_mm / 2 - DRILL_STEP_MM - WALL_MM, drilled),
    ):
        least = float(distance[which & (distance > OFF_MM)].min(initial=np.inf))
        if least < limit_mm:
            return [f"3: a wall is {least:.3f} mm, not {limit_mm:.3f}"]
    return []


def _stands(judged: Judged) -> list[str]:
    """4: the contact's hull and the centre of mass give the lean that was asked for."""
    result = judged.result
    excused = {"lean-out-of-reach", "no-contact", "tilt"}
    if excused & {item.rule for item in result.findings}:
        return []
    if len([s for s in judged.mesh.split(only_watertight=False) if s.volume > 0]) > 1:
        return []  # bodies are judged one by one
    height = result.profile.printer.first_layer_mm / 2
    section = judged.mesh.section(plane_origin=(0, 0, height), plane_normal=(0, 0, 1))
    if section is None:
        return ["4: it does not touch the plate"]
    hull = CrossSection.hull_points(section.vertices[:, :2]).to_polygons()[0]
    x, y, z = judged.mesh.center_mass
    ends = np.roll(hull, -1, axis=0)
    along = ends - hull
    outward = np.column_stack([along[:, 1], -along[:, 0]])
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    reach = float(((hull - (x, y)) * outward).sum(axis=1).min())
    tilt = math.degrees(math.atan2(reach, z))
    if tilt < result.lean_deg - LEAN_DEG:
        return [f"4: it tips at {tilt:.2f}°, not {result.lean_deg:g}°"]
    return []


def _certificate(judged: Judged) -> list[str]:
    """5: no lighter filling stands: the certificate closes its gap."""
    proof = judged.result.density.certificate
    if proof is None or not judged.result.density.aim_deg:
        return []
    if proof.bound_g > proof.voxel_mass_g * (1 + 1e-6) or proof.gap > 1e-3:
        return [f"5: the certificate has a gap of {proof.gap:.2g}"]
    return []


def _inside(judged: Judged) -> list[str]:
    """6: where the process asks for it, no cell of the inside is shut off from the air."""
    result = judged.result
    if not result.profile.traits.must_drain:
        return []
    if "sealed-cavity" in {item.rule for item in result.findings}:
        return []
    low, high = judged.mesh.bounds
    coarse = float(max((high - low).max() / 40, 0.5))
    largest = 0.0
    for pitch in (coarse, coarse / 2, coarse / 4):  # a crack thinner than a cell falls to pieces
        largest = _largest_shut_off_mm3(judged, pitch)
        if largest <= math.pi / 6 * max(result.profile.drain.diameter_mm or 0, 3 * coarse) ** 3:
            return []
    return [f"6: {largest:.3g} mm³ are shut off inside"]


def _largest_shut_off_mm3(judged: Judged, pitch: float) -> float:
    low, high = judged.mesh.bounds
    axes = [np.arange(a - pitch, b + 2 * pitch, pitch) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    filled = _fast_winding(judged, points.reshape(-1, 3)).reshape(points.shape[:3]) > 0.5
    pieces, _ = label(~filled)
    sizes = np.bincount(pieces[pieces > 0])
    sizes[pieces[0, 0, 0]] = 0
    return float(sizes.max(initial=0)) * pitch**3


def _fast_winding(judged: Judged, points: Float) -> Float:
    result: Float = igl.fast_winding_number(
        judged.written.vertices, judged.written.faces, np.ascontiguousarray(points)
    )
    return result
