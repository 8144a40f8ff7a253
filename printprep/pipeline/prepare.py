"""The first steps of every run: read, place, repair, pose."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.pipeline.limits import check_memory, check_size
from printprep.pipeline.options import AS_IN_FILE, Placement
from printprep.progress import Progress
from printprep.types import NO_VOIDS, ModelVoids

if TYPE_CHECKING:
    import trimesh

    from printprep.profiles import Profile
    from printprep.types import Model, Solid


@dataclass(frozen=True, eq=False)
class Prepared:
    """A model that is ready: its own triangles, placed, and the solid made from them.

    voids : what became of its sealed voids.
    """

    model: Model
    solid: Solid
    profile: Profile
    voids: ModelVoids = NO_VOIDS


def prepare(
    model: str | Path | trimesh.Trimesh,
    profile: Profile,
    placement: Placement,
    progress: Progress,
    *,
    resolution: int = 0,
    max_memory_mib: float | None = None,
) -> Prepared:
    """Read a model (a mesh file, a voxel file or a mesh), place it, and make it into a solid.

    resolution : of the grid that follows, 0 for none;  max_memory_mib : that the run may take, None
    for what the machine has free.  A model that is too large or too small, or takes more memory, is
    refused once it is read.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.mesh.carry import facets_apart
    from printprep.mesh.repair import repair, without_crumb_shells

    with progress.stage("read"):
        placed = placed_model(model, placement)
    check_size(placed, profile, placement)
    check_memory(placed, profile, resolution, max_memory_mib)
    with progress.stage("repair"):
        placed, crumbs = without_crumb_shells(placed, profile.crumb_mm3, math.inf)
        solid = _also(repair(placed, profile.crumb_mm3), crumbs)
        if placed.paint is not None:
            solid = replace(solid, manifold=facets_apart(solid.manifold))
        if placement.pose is not None:
            placed, solid = _posed(placed, solid, placement.pose)
    return Prepared(placed, solid, profile)


def _also(solid: Solid, before: tuple[str, ...]) -> Solid:
    """The solid, with what was done before its repair."""
    if not before:
        return solid
    rung = "union" if solid.repair.rung == "as-is" else solid.repair.rung
    return replace(
        solid, repair=replace(solid.repair, rung=rung, actions=(*before, *solid.repair.actions))
    )


def placed_model(model: str | Path | trimesh.Trimesh, placement: Placement = AS_IN_FILE) -> Model:
    """A file or mesh as triangles on the bed, not yet posed.

    Raises UsageError for an invalid placement, InputError for an unreadable file.
    """
    from printprep.generators.model import read_model
    from printprep.generators.read import SUFFIXES as VOXEL_SUFFIXES
    from printprep.mesh.place import place
    from printprep.mesh.read import Choice, from_trimesh, read_mesh, refuse_parts

    choice = Choice(placement.units, placement.partial, placement.plate, placement.item)
    if isinstance(model, str | Path):
        path = Path(model)
        if path.suffix.lower() in VOXEL_SUFFIXES:
            refuse_parts(choice, str(path))
            raw = read_model(path)
        else:
            raw = read_mesh(path, choice=choice)
    else:
        refuse_parts(choice, "a mesh in memory")
        raw = from_trimesh(model, units=placement.units)
    return place(
        raw,
        up=placement.up,
        scale=placement.scale,
        height_mm=placement.height_mm,
        size_mm=placement.size_mm,
    )


def _posed(placed: Model, solid: Solid, number: int) -> tuple[Model, Solid]:
    """Model and solid in the stable pose with this number; 1 is the steadiest."""
    from printprep.stand.poses import in_pose, stable_poses

    poses = stable_poses(solid.manifold)
    if not 1 <= number <= len(poses):
        known = ", ".join(f"{k} ({p.tilt_deg:.0f}°)" for k, p in enumerate(poses, start=1))
        raise UsageError(
            f"{solid.name} has no stable pose {number}.",
            f"Its stable poses, with their tilt angles, are {known}." if poses else None,
        )
    manifold, move = in_pose(solid.manifold, poses[number - 1])
    placement = move @ solid.placement
    vertices = placed.vertices @ move[:3, :3].T + move[:3, 3]
    return (
        replace(placed, vertices=vertices, placement=placement),
        replace(solid, manifold=manifold, placement=placement),
    )
