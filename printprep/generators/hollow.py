"""Hollow one sample of a generator's voxels; the package's docstring shows its use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from printprep.arrays import Bool, Float
from printprep.errors import UsageError
from printprep.generators.surface import VoxelSurface, surface_of
from printprep.generators.voxel_arrays import occupancy
from printprep.objectives import (
    DEFAULT_OBJECTIVE,
    PLANE,
    Solver,
    check_solver,
    objective_of,
)
from printprep.paper.domain import (
    FillRule,
    PaperDomain,
    ShellRule,
    build_domain,
)
from printprep.paper.settings import PaperSettings
from printprep.stand.lean import MOST_DEG

Solve = Callable[[PaperDomain], Float]
"""The density of a domain, (64, 64, 64) in [0, 1]; above one half is material."""


@dataclass(frozen=True, eq=False)
class VoxelHollow:
    """The hollowed voxels, in the generator's own form, and the cavity.

    material : V, the voxels for the generator's second stage, in the form of the input: coordinates
        (n, 3) or (n, 4) with the same number type, or a binary array (64, 64, 64); numpy or torch.
    cavity : the surface of H, closed, in [-0.5, 0.5]³.
    domain : shell, interior and base of the voxels.
    density : (64, 64, 64) float64, ρ̃.
    cavity_voxels, material_voxels : (64, 64, 64) bool, H and V.
    mass_ratio : voxels of V over voxels of the filled solid, base included.
    """

    material: Any
    cavity: VoxelSurface
    domain: PaperDomain
    density: Float
    cavity_voxels: Bool
    material_voxels: Bool
    mass_ratio: float


def hollow(
    voxels: Any,
    *,
    objective: str = DEFAULT_OBJECTIVE,
    lean_deg: float = 10.0,
    solver: str = PLANE,
    settings: PaperSettings | None = None,
    solve: Solve | None = None,
    batch: int = 0,
    device: str = "cpu",
    shell: ShellRule = "auto",
    filling: FillRule = "flood",
) -> VoxelHollow:
    """Fill the solid that voxels describe, optimize its interior, and return the material.

    Parameters
    ----------
    voxels : coordinates (n, 3) or (n, 4), or a binary array (64, 64, 64); see
        :func:`printprep.generators.voxel_arrays.occupancy`.
    objective : a name in :data:`printprep.objectives.OBJECTIVES`: "lean", the least material that
        stands at ``lean_deg`` (:mod:`printprep.paper.voxel_lean`), or "paper", the paper's terms.
    solver : of the paper's terms: "plane", or "adam" on ``device``.
    settings : the paper's parameters; None for its values.
    solve : a function from the domain to a density, in place of the objective.
    batch : the sample of a batched tensor; the result's batch column keeps its number.
    shell, filling : see `build_domain`; a surface that leaks needs filling="slices".

    Raises
    ------
    InputError : the input is not voxels.
    UsageError : options that exclude each other, or that do not exist.
    """
    occupied, form = occupancy(voxels, batch=batch)
    chosen = settings or PaperSettings()
    how = Solver(solver, device)
    if solve is not None and how != Solver():
        raise UsageError(
            "solver and device belong to an objective, not to solve.",
            "Leave out solver and device, or solve.",
        )
    row = objective_of(objective)
    check_solver(row, how)
    if not 0 <= lean_deg <= MOST_DEG:
        raise UsageError(f"A lean of {lean_deg:g}° is not between 0° and {MOST_DEG:g}°.")
    domain = build_domain(occupied, chosen, shell=shell, filling=filling)
    density = row.on_voxels(domain, lean_deg, chosen, how) if solve is None else solve(domain)
    if density.shape != domain.shape:
        raise UsageError(
            f"solve returns a density of shape {density.shape}, not {domain.shape}.",
            "Return one number for each voxel of the domain.",
        )
    material = domain.shell | (domain.free & (density > 0.5))
    cavity = domain.solid & ~material
    return VoxelHollow(
        material=form.write(material),
        cavity=surface_of(cavity),
        domain=domain,
        density=density,
        cavity_voxels=cavity,
        material_voxels=material,
        mass_ratio=np.count_nonzero(material) / np.count_nonzero(domain.solid),
    )
