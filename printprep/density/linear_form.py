"""s and the ground layer as linear functions of the free densities: no convolution, no autograd.

Mass and first moments of ρ̃ are linear in ρ, so with the kernel's adjoint applied once to
(1, x, y, z) on the free voxels

    s = (M, M c_x, M c_y, M c_z) = s₀ + W ρ,        W : 4 × n,

and the gradient of every free voxel is the 4-vector ∂L/∂s times its column of W.  What else the
loss needs is the soft contact g (see `objective`), which only a few voxels near the ground can
raise; for them ρ̃ = r₀ + K ρ with K the rows of the kernel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from printprep.density.objective import Float, PaperSettings, Terms, gradient, terms
from printprep.density.paper_domain import PaperDomain
from printprep.density.smoothing import box_mean, smooth

Int = NDArray[np.int64]

DECAY = 4.0  # the soft contact's loss per layer above ground, authors' code


@dataclass(frozen=True, eq=False)
class LinearForm:
    """The objective of one domain, written over its n free voxels.

    domain, settings : as given.
    frozen : (nx, ny, nz) float64, ρ off the free voxels (0 on them).
    voxels : (n, 3) int64 x, y, z indices of the free voxels, in C order.
    reference : (3,) float64 voxel indices of the origin of s and columns: the grid's middle in x
        and y, the ground layer in z.
    s0 : (4,) float64;  W : (4, n) float64.
    columns : (C, 2) float64 relative to reference, the C_open that can change first.
    floor : (C,) float64, the contact the shell gives.
    contenders : (m,) int64 into the n, the free voxels that can raise their column above its floor.
    r0 : (m,) float64, ρ̃ of the contenders at ρ = 0;  decay : (m,) float64, 4^(−k).
    neighbours : (m, 27 or 1) int64 into the n, n itself for a voxel that is not free.
    slots : (C_open, E) int64 into the m, m itself for an empty slot.
    """

    domain: PaperDomain
    settings: PaperSettings
    frozen: Float
    voxels: Int
    reference: Float
    s0: Float
    W: Float
    columns: Float
    floor: Float
    contenders: Int
    r0: Float
    decay: Float
    neighbours: Int
    slots: Int

    @property
    def count(self) -> int:
        """n, the number of free voxels."""
        return len(self.voxels)

    def moments(self, rho: Float) -> Float:
        """(4,) s of the free densities (n,)."""
        return self.s0 + self.W @ rho

    def contact(self, rho: Float) -> Float:
        """(m,) 4^(−k) ρ̃ of the contenders, for the free densities (n,)."""
        padded = np.append(rho, 0.0)
        share = 1.0 / self.neighbours.shape[1] if len(self.neighbours) else 1.0
        lifted: Float = self.decay * (self.r0 + share * padded[self.neighbours].sum(axis=1))
        return lifted

    def ground(self, contact: Float) -> Float:
        """(C,) g, from the contenders' values (m,)."""
        g = self.floor.copy()
        opened = len(self.slots)
        if opened:
            best = np.append(contact, 0.0)[self.slots].max(axis=1)
            g[:opened] = np.maximum(g[:opened], best)
        return g

    def terms(self, rho: Float) -> Terms:
        """Loss terms at the free densities (n,)."""
        g = self.ground(self.contact(rho))
        return terms(self.moments(rho), g, self.columns, self.settings)

    def gradient(self, rho: Float) -> tuple[Float, Float]:
        """∂L/∂ρ (n,) and q = ∂L/∂s (4,) at the free densities (n,).

        Where several layers of a column tie for the contact the lowest takes the gradient, and
        none does when the shell's floor is at least as high.
        """
        contact = self.contact(rho)
        g = self.ground(contact)
        q, by_g = gradient(self.moments(rho), g, self.columns, self.settings)
        slope: Float = q @ self.W
        opened = len(self.slots)
        if opened:
            values = np.append(contact, 0.0)[self.slots]
            winner = np.take_along_axis(self.slots, values.argmax(axis=1)[:, None], axis=1)[:, 0]
            wins = values.max(axis=1) > self.floor[:opened]
            pull = by_g[:opened][wins] * self.decay[winner[wins]] / self.neighbours.shape[1]
            padded = np.append(slope, 0.0)
            np.add.at(padded, self.neighbours[winner[wins]], pull[:, None])
            slope = padded[:-1]
        return slope, q

    def field(self, rho: Float) -> Float:
        """(nx, ny, nz) ρ̃ on the grid, from the free densities (n,)."""
        whole = self.frozen.copy()
        whole[tuple(self.voxels.T)] = rho
        return smooth(whole, self.domain, smoothing=self.settings.smoothing)


def linear_form(
    domain: PaperDomain, settings: PaperSettings, frozen: Float | None = None
) -> LinearForm:
    """The linear form of a domain.

    frozen : (nx, ny, nz) float64, ρ of the voxels that are not free; None for 1 on the shell and 0
        elsewhere (Adam's reproduction freezes the noisy sigmoids the authors' code starts from).
    """
    rho0 = np.where(domain.free, 0.0, domain.shell if frozen is None else frozen)
    voxels = np.argwhere(domain.free)
    nx, ny, _ = domain.shape
    reference = np.array([(nx - 1) / 2, (ny - 1) / 2, domain.ground], dtype=np.float64)
    s0, W = _moment_rows(domain, settings, rho0, voxels, reference)
    open_ground = _ground(domain, settings, rho0, voxels)
    columns, floor, contenders, decay, slots = open_ground
    number = np.full(domain.shape, len(voxels), dtype=np.int64)
    number[domain.free] = np.arange(len(voxels))
    at = voxels[contenders]
    if settings.smoothing:
        around = np.stack(np.meshgrid(*[[0, 1, 2]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        padded = np.pad(number, 1, constant_values=len(voxels))
        neighbours = padded[tuple(np.moveaxis(at[:, None] + around, -1, 0))]
        r0 = box_mean(rho0)[tuple(at.T)]
    else:
        neighbours = contenders[:, None]
        r0 = np.zeros(len(at))
    return LinearForm(
        domain, settings, rho0, voxels, reference, s0, W,
        columns - reference[:2], floor, contenders, r0, decay, neighbours, slots,
    )  # fmt: skip


def _moment_rows(
    domain: PaperDomain, settings: PaperSettings, rho0: Float, voxels: Int, reference: Float
) -> tuple[Float, Float]:
    """s₀ and W: the adjoint of the smoothing applied to (1, x, y, z) on the free voxels."""
    axes = [np.arange(n) - r for n, r in zip(domain.shape, reference, strict=True)]
    x, y, z = np.meshgrid(*axes, indexing="ij", sparse=True)
    s0 = np.zeros(4)
    W = np.zeros((4, len(voxels)))
    for row, weight in enumerate((np.ones(1), x, y, z)):
        on_free = np.where(domain.free, weight, 0.0)
        adjoint = box_mean(on_free) if settings.smoothing else on_free
        W[row] = adjoint[domain.free]
        spread = adjoint if settings.smoothing else np.zeros_like(rho0)
        s0[row] = np.sum(rho0 * (np.where(domain.shell, weight, 0.0) + spread))
    return s0, W


def _ground(
    domain: PaperDomain, settings: PaperSettings, rho0: Float, voxels: Int
) -> tuple[Float, Float, Int, Float, Int]:
    """Columns (open ones first) and their floors, the contenders with 4^(−k), and their slots."""
    above = slice(domain.ground, None)
    layers = DECAY ** -np.arange(domain.shape[2] - domain.ground, dtype=np.float64)
    floor = np.max(np.where(domain.shell, rho0, 0.0)[:, :, above] * layers, axis=2)
    can = domain.free[:, :, above] & (layers > floor[:, :, None])
    opened = can.any(axis=2)
    closed = ~opened & (floor > 0)
    columns = np.concatenate((np.argwhere(opened), np.argwhere(closed)))
    found = np.argwhere(can)  # C order, so column by column and upward within each
    number = np.full(domain.shape, -1, dtype=np.int64)
    number[domain.free] = np.arange(len(voxels))
    contenders = number[found[:, 0], found[:, 1], found[:, 2] + domain.ground]
    column = np.cumsum(np.append(False, np.any(found[1:, :2] != found[:-1, :2], axis=1)))
    column = column[: len(found)]
    rank = np.arange(len(found)) - np.searchsorted(column, column)
    slots = np.full((int(opened.sum()), int(rank.max(initial=-1)) + 1), len(found), np.int64)
    slots[column, rank] = np.arange(len(found))
    heights = floor[tuple(columns.T)]
    return columns.astype(np.float64), heights, contenders, layers[found[:, 2]], slots
