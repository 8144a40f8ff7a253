"""A real model's solid and its hollowable volume, as the pipeline makes them."""

from __future__ import annotations

from pathlib import Path

from manifold3d import Manifold

from printprep.cavity.surface import cavity_surface
from printprep.grid.depth import measure_depths
from printprep.mesh.place import place
from printprep.mesh.read import read_mesh
from printprep.mesh.repair import repair
from printprep.profiles import Profile


def hollowable_of(
    path: Path, up: str, size_mm: float, profile: Profile
) -> tuple[Manifold, Manifold]:
    """The repaired solid, and its hollowable volume: all that lies deeper than the wall."""
    solid = repair(place(read_mesh(path), up=up, size_mm=size_mm))
    depths = measure_depths(
        solid,
        resolution=64,
        wall_mm=profile.wall_mm,
        min_feature_mm=profile.min_feature_mm,
        margin_mm=profile.stability.base_growth_max_mm,
    )
    return solid.manifold, cavity_surface(solid.manifold, depths.field, profile.wall_mm)
