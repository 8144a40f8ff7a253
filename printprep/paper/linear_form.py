"""The paper's objective over the free densities, through functions that are linear in them.

Mass and first moments of ρ̃ are linear in ρ, so with the kernel's adjoint applied once to
(1, x, y, z) on the free voxels

    s = (M, M c_x, M c_y, M c_z) = s₀ + W ρ,        W : 4 × n,

and the gradient of every free voxel is the 4-vector ∂L/∂s times its column of W: no convolution, no
autograd.  Beside s the loss needs only the soft contact g (see `objective`), which few voxels near
the ground can raise; for them ρ̃ = r₀ + K ρ with K the rows of the kernel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from printprep.arrays import Float, Int
from printprep.paper.domain import PaperDomain
from printprep.paper.objective import Terms, gradient, terms
from printprep.paper.settings import PaperSettings
from printprep.paper.smoothing import box_mean, smooth

AROUND = np.stack(np.meshgrid(*[[0, 1, 2]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
"""(27, 3) the kernel's voxels, as offsets into a grid padded by one."""

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
    columns : (C, 2) float64 x, y relative to reference; the C_open that can change come first.
    floor : (C,) float64, the contact from the shell.
    contenders : (m,) int64, indices of the free voxels that can raise their column above its floor.
    r0 : (m,) float64, ρ̃ of the contenders at ρ = 0;  decay : (m,) float64, 4^(−k).
    neighbours : (m, 27 or 1) int64, indices of free voxels, n for a voxel that is not free.
    slots : (C_open, E) int64, indices of contenders, m for an empty slot.
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
        # einsum sums in one thread and one order; a threaded BLAS does not, and is no faster.
        s: Float = self.s0 + np.einsum("kn,n->k", self.W, rho)
        return s

    def contact(self, rho: Float) -> Float:
        """(m,) 4^(−k) ρ̃ of the contenders, for the free densities (n,)."""
        padded = np.append(rho, 0.0)
        share = 1.0 / self.neighbours.shape[1] if len(self.neighbours) else 1.0
        lifted: Float = self.decay * (self.r0 + share * padded[self.neighbours].sum(axis=1))
        return lifted

    def ground(self, contact: Float) -> Float:
        """(C,) g, from the contenders' contact (m,)."""
        g = self.floor.copy()
        opened = len(self.slots)
        if opened:
            best = np.append(contact, 0.0)[self.slots].max(axis=1)
            g[:opened] = np.maximum(g[:opened], best)
        return g

    def terms(self, rho: Float) -> Terms:
        """The loss terms at the free densities (n,)."""
        g = self.ground(self.contact(rho))
        return terms(self.moments(rho), g, self.columns, self.settings)

    def pull(self, s: Float, contact: Float) -> tuple[Terms, Float, Float]:
        """The loss terms, q = ∂L/∂s (4,) and ∂L/∂ρ̃ of the contenders (m,).

        s : (4,);  contact : (m,).
        Where several layers of a column tie for the contact, the lowest takes the gradient; none
        does when the shell's floor is at least as high.
        """
        g = self.floor.copy()
        opened = len(self.slots)
        by_contact = np.zeros(len(contact))
        if not opened:
            value, q, _ = gradient(s, g, self.columns, self.settings)
            return value, q, by_contact
        values = np.append(contact, 0.0)[self.slots]
        layer = values.argmax(axis=1)
        column = np.arange(opened)
        best = values[column, layer]
        wins = best > g[:opened]
        g[:opened][wins] = best[wins]
        value, q, by_g = gradient(s, g, self.columns, self.settings)
        winner = self.slots[column, layer][wins]
        by_contact[winner] = by_g[:opened][wins] * self.decay[winner]
        return value, q, by_contact

    def gradient(self, rho: Float) -> tuple[Float, Float]:
        """∂L/∂ρ (n,) and q = ∂L/∂s (4,) at the free densities (n,)."""
        _, q, by_contact = self.pull(self.moments(rho), self.contact(rho))
        slope: Float = np.einsum("k,kn->n", q, self.W)
        if len(by_contact):
            width = self.neighbours.shape[1]
            spread = np.repeat(by_contact / width, width)
            bins = np.bincount(self.neighbours.reshape(-1), spread, minlength=self.count + 1)
            slope += bins[:-1]
        return slope, q

    def field(self, rho: Float) -> Float:
        """(nx, ny, nz) ρ̃ on the grid, from the free densities (n,)."""
        whole = self.frozen.copy()
        whole[tuple(self.voxels.T)] = rho
        return smooth(whole, self.domain, smoothing=self.settings.smoothing)


def linear_form(
    domain: PaperDomain, settings: PaperSettings, frozen: Float | None = None
) -> LinearForm:
    """Build the linear form of a domain.

    frozen : (nx, ny, nz) float64, ρ of the voxels that are not free; None for 1 on the shell and 0
        elsewhere (Adam freezes the noisy sigmoids that the authors' code starts from).
    """
    rho0 = np.where(domain.free, 0.0, domain.shell if frozen is None else frozen)
    voxels = np.argwhere(domain.free)
    nx, ny, _ = domain.shape
    reference = np.array([(nx - 1) / 2, (ny - 1) / 2, domain.ground], dtype=np.float64)
    s0, W = _moment_rows(domain, settings, rho0, reference)
    columns, floor, contenders, decay, slots = _ground(domain, rho0)
    at = voxels[contenders]
    if settings.smoothing:
        neighbours = _neighbours(domain, at)
        whole = np.pad(rho0, 1)
        around = at[:, None] + AROUND
        r0 = whole[tuple(np.moveaxis(around, -1, 0))].sum(axis=1) / len(AROUND)
    else:
        neighbours = contenders[:, None]
        r0 = np.zeros(len(at))
    return LinearForm(
        domain=domain,
        settings=settings,
        frozen=rho0,
        voxels=voxels,
        reference=reference,
        s0=s0,
        W=W,
        columns=columns - reference[:2],
        floor=floor,
        contenders=contenders,
        r0=r0,
        decay=decay,
        neighbours=neighbours,
        slots=slots,
    )


def _moment_rows(
    domain: PaperDomain, settings: PaperSettings, rho0: Float, reference: Float
) -> tuple[Float, Float]:
    """s₀ (4,) and W (4, n): the smoothing's adjoint, applied to (1, x, y, z) on the free voxels.

    rho0 : (nx, ny, nz), ρ of the frozen voxels;  reference : (3,).
    """
    used = np.argwhere(domain.shell | domain.free)
    # Frozen voxels one step outside O ∪ B still reach into it through the kernel.
    low = np.maximum(used.min(axis=0) - 1, 0)
    high = np.minimum(used.max(axis=0) + 2, domain.shape)
    crop = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    free, shell, rho = domain.free[crop], domain.shell[crop], rho0[crop]
    axes = [np.arange(a, b) - r for a, b, r in zip(low, high, reference, strict=True)]
    x, y, z = np.meshgrid(*axes, indexing="ij", sparse=True)
    s0 = np.zeros(4)
    W = np.zeros((4, int(np.count_nonzero(free))))
    for row, weight in enumerate((np.ones(1), x, y, z)):
        adjoint = np.where(free, weight, 0.0)
        s0[row] = np.sum(rho * np.where(shell, weight, 0.0))
        if settings.smoothing:
            adjoint = box_mean(adjoint)
            s0[row] += np.sum(rho * adjoint)
        W[row] = adjoint[free]
    return s0, W


def _neighbours(domain: PaperDomain, at: Int) -> Int:
    """(m, 27) indices of the free voxels around the voxels (m, 3), n where one is not free."""
    n = int(np.count_nonzero(domain.free))
    number = np.full(tuple(length + 2 for length in domain.shape), n, dtype=np.int64)
    number[1:-1, 1:-1, 1:-1][domain.free] = np.arange(n)
    found: Int = number[tuple(np.moveaxis(at[:, None] + AROUND, -1, 0))]
    return found


def _ground(domain: PaperDomain, rho0: Float) -> tuple[Float, Float, Int, Float, Int]:
    """Columns (C, 2), the open ones first, their floors (C,), the contenders (m,), their 4^(−k)
    (m,), and the slots (C_open, E).

    rho0 : (nx, ny, nz), ρ of the frozen voxels.
    """
    free = domain.free[:, :, domain.ground :]
    layers = DECAY ** -np.arange(free.shape[2], dtype=np.float64)
    shell = np.where(domain.shell, rho0, 0.0)[:, :, domain.ground :]
    floor = np.max(shell * layers, axis=2)
    can = free & (layers > floor[:, :, None])
    opened = can.any(axis=2)
    columns = np.concatenate((np.argwhere(opened), np.argwhere(~opened & (floor > 0))))
    found = np.argwhere(can)  # C order: column by column, and upward within each
    number = np.cumsum(domain.free).reshape(domain.shape) - 1
    contenders = number[found[:, 0], found[:, 1], found[:, 2] + domain.ground]
    column = (np.cumsum(opened).reshape(opened.shape) - 1)[found[:, 0], found[:, 1]]
    rank = np.arange(len(found)) - np.searchsorted(column, column)
    slots = np.full((int(opened.sum()), int(rank.max(initial=-1)) + 1), len(found), np.int64)
    slots[column, rank] = np.arange(len(found))
    return (
        columns.astype(np.float64),
        floor[tuple(columns.T)],
        contenders,
        layers[found[:, 2]],
        slots,
    )
