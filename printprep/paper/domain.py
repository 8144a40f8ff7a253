"""The paper's domain: the voxels that may change, and those that may not.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code
(github.com/idvxlab/DensiCrafter).  Where text and code differ this follows the code and notes it.

Notation: Ω the grid, O the solid, ∂O its shell, O° the interior, B the base layer,
Ω_opt = O° ∪ B the free voxels.  Axis order x, y, z; z is up; lengths are voxels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from printprep.arrays import Bool
from printprep.errors import GeometryError, UsageError
from printprep.paper.settings import PaperSettings

FillRule = Literal["flood", "slices"]
ShellRule = Literal["auto", "boundary", "occupied"]


@dataclass(frozen=True, eq=False)
class PaperDomain:
    """One object on one grid; every array is bool of the same shape (nx, ny, nz).

    solid : O, hole-filled.
    shell : ∂O, the part of O that never changes.
    interior : O° = O ∖ ∂O.
    base : B, outside O; empty when the base is switched off.
    free : Ω_opt = O° ∪ B.
    ground : index of the lowest occupied layer.
    """

    solid: Bool
    shell: Bool
    interior: Bool
    base: Bool
    free: Bool
    ground: int

    @property
    def shape(self) -> tuple[int, int, int]:
        """(nx, ny, nz) of the grid."""
        nx, ny, nz = self.solid.shape
        return nx, ny, nz


def build_domain(
    occupied: Bool,
    settings: PaperSettings,
    *,
    shell: ShellRule = "auto",
    filling: FillRule = "flood",
) -> PaperDomain:
    """Find the shell, the interior and the base layer of an occupancy.

    Parameters
    ----------
    occupied : (nx, ny, nz) bool, a solid or only its surface voxels.
    settings : ε, the base layer's reach, and whether B exists.
    shell : "occupied" freezes every voxel given, as the authors do with a generator's surface
        voxels; "boundary" freezes the voxels of O with one of their six neighbours outside O or
        outside the grid, as they do with a solid; "auto" takes "occupied" when the voxels given
        leave more than half of what lies behind that boundary empty.
    filling : how O follows from the voxels given, see `fill`.

    Raises
    ------
    GeometryError : no voxel is occupied.
    UsageError : an unknown rule, or an array that is not three-dimensional bool.
    """
    _check(occupied)
    solid = fill(occupied, filling)
    boundary = solid & ~_erode(solid)
    if shell == "auto":
        behind = solid & ~boundary
        hollow = 2 * np.count_nonzero(behind & occupied) < np.count_nonzero(behind)
        shell = "occupied" if hollow else "boundary"
    if shell == "boundary":
        frozen = boundary
    elif shell == "occupied":
        # Every voxel on the boundary of the filled set is one of those given, so the boundary adds
        # nothing to them; it keeps a domain valid whatever rule filled it.
        frozen = boundary | occupied
    else:
        raise UsageError(f"Shell rule {shell!r} does not exist.", "Use auto, boundary or occupied.")
    interior = solid & ~frozen
    ground = int(np.flatnonzero(solid.any(axis=(0, 1)))[0])
    base = _base_layer(solid, ground, settings) if settings.base else np.zeros_like(solid)
    return PaperDomain(solid, frozen, interior, base, interior | base, ground)


def fill(occupied: Bool, filling: FillRule = "flood") -> Bool:
    """Fill the solid O that a set of surface voxels encloses.

    Parameters
    ----------
    occupied : (nx, ny, nz) bool.
    filling : "flood" adds every voxel that no way through face neighbours joins to the outside of
        the grid.  "slices" adds every voxel that is enclosed within its x-, its y- and its z-slice,
        each flooded on its own: the authors' rule.  It adds all that "flood" adds, and also works
        where a surface leaks through a small hole; but it closes winding channels.

    Returns
    -------
    (nx, ny, nz) bool, a superset of ``occupied``.
    """
    from scipy.ndimage import binary_fill_holes

    if filling == "flood":
        return np.asarray(binary_fill_holes(occupied), dtype=bool)
    if filling != "slices":
        raise UsageError(f"Filling {filling!r} does not exist.", "Use flood or slices.")
    enclosed = np.ones_like(occupied)
    for axis in range(3):
        slices = np.moveaxis(occupied, axis, 0)
        flooded = np.stack([binary_fill_holes(plane) for plane in slices])
        enclosed &= np.moveaxis(flooded, 0, axis)
    return enclosed


def _base_layer(solid: Bool, ground: int, settings: PaperSettings) -> Bool:
    """B: the voxels outside O with ground ≤ z < ground + ε and an L1 distance to O below ε.

    With the reach "within", L1 distances up to and including ε.  The authors' code measures them to
    the lowest ε + 1 layers of O alone, which can differ under an overhang, and wraps B around the
    edges of the grid, which is a mistake.

    solid : (nx, ny, nz) bool;  returns the same shape.
    """
    epsilon = settings.epsilon
    near = solid
    for _ in range(epsilon if settings.base_reach == "within" else epsilon - 1):
        near = _dilate(near)
    band = np.zeros_like(solid)
    band[:, :, ground : ground + epsilon] = True
    return near & band & ~solid


def _dilate(mask: Bool) -> Bool:
    """``mask`` (nx, ny, nz) and its face neighbours, within the grid; same shape."""
    grown = mask.copy()
    for axis in range(3):
        source, target = np.moveaxis(mask, axis, 0), np.moveaxis(grown, axis, 0)
        target[1:] |= source[:-1]
        target[:-1] |= source[1:]
    return grown


def _erode(mask: Bool) -> Bool:
    """The voxels of ``mask`` (nx, ny, nz) whose six face neighbours all belong to it; same shape.

    Beyond the grid nothing belongs to it.
    """
    padded = np.pad(mask, 1)
    core = mask.copy()
    for axis in range(3):
        moved = np.moveaxis(padded, axis, 0)
        inner = (slice(1, -1), slice(1, -1))
        core &= np.moveaxis(moved[:-2][(slice(None), *inner)], 0, axis)
        core &= np.moveaxis(moved[2:][(slice(None), *inner)], 0, axis)
    return core


def _check(occupied: Bool) -> None:
    """Raise unless ``occupied`` is bool of shape (nx, ny, nz) with a voxel in it."""
    if occupied.ndim != 3 or occupied.dtype != np.bool_:
        raise UsageError(
            f"The occupancy is {occupied.dtype} of shape {occupied.shape}, not bool (nx, ny, nz)."
        )
    if not occupied.any():
        raise GeometryError("The voxel grid is empty: no voxel is occupied.")
