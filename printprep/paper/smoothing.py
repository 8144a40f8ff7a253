"""ρ̃, the smoothed density: ρ on the shell, the 3×3×3 mean of ρ on the free voxels, 0 elsewhere.

Source: Dang et al., arXiv 2511.09298.  As in the authors' code, the grid is padded with zeros.  The
kernel is symmetric, so the mean is its own adjoint: that is all the linear form needs.
"""

from __future__ import annotations

import numpy as np

from printprep.arrays import Float
from printprep.paper.domain import PaperDomain

KERNEL_SIZE = 27


def box_mean(field: Float) -> Float:
    """Mean over the 3×3×3 neighbourhood of every voxel, zero outside the grid.

    field : (nx, ny, nz) float64;  returns the same shape.
    """
    total = field
    for axis in range(3):
        padded = np.moveaxis(total, axis, 0)
        summed = padded.copy()
        summed[1:] += padded[:-1]
        summed[:-1] += padded[1:]
        total = np.moveaxis(summed, 0, axis)
    return total / KERNEL_SIZE


def smooth(rho: Float, domain: PaperDomain, *, smoothing: bool = True) -> Float:
    """Smooth a density: ρ̃.

    rho : (nx, ny, nz) float64 in [0, 1], frozen voxels included;
    smoothing : False gives ρ itself on O ∪ B (the paper's ablation "without smoothing").
    Returns (nx, ny, nz) float64.
    """
    mean = box_mean(rho) if smoothing else rho
    return np.where(domain.shell, rho, np.where(domain.free, mean, 0.0))
