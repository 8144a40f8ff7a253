"""Run the paper's optimization as its authors do, by Adam, without convolution or autograd.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code
(github.com/idvxlab/DensiCrafter).  Where they differ this follows the code: logits start at +10 on
the shell and −10 elsewhere (paper: ±∞), both with N(0, 1) noise, so the frozen voxels are not quite
0 and 1; the result is the density of the last evaluation, not of the best one.

One step on the device is a sigmoid, a thin mat-vec each way (4 × n, see `linear_form`) and Adam's
update, in float32 and in place.  The four moments and the few contact voxels go to the host, where
the closed forms of `objective` turn them into four slopes.  The CPU uses one thread: a step is
shorter than the start of a second thread, and sums keep their order on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import Float
from printprep.errors import UsageError
from printprep.paper.domain import PaperDomain
from printprep.paper.linear_form import LinearForm, linear_form
from printprep.paper.plane import PaperSolution, package
from printprep.paper.settings import PaperSettings

if TYPE_CHECKING:
    import torch

LOGIT = 10.0  # of the first density, authors' code
BETA1, BETA2, EPS = 0.9, 0.999, 1e-8  # Kingma & Ba, 2015, and torch's defaults


def solve_adam(
    domain: PaperDomain, settings: PaperSettings, *, device: str = "cpu"
) -> PaperSolution:
    """Minimize the paper's objective with ``settings.steps`` evaluations of Adam.

    The CPU draws the noise, so every device starts from the same logits.  The solution's ``rho``
    keeps the sigmoids of the frozen voxels, its ``trace`` the loss at each evaluation.

    Raises UsageError when torch has no such device.
    """
    theta = initial_logits(domain, settings)
    form = linear_form(domain, settings, _sigmoid(theta).astype(np.float64))
    rho, trace = _run(form, theta[domain.free], device)
    return package(form, rho, trace, None)


def initial_logits(domain: PaperDomain, settings: PaperSettings) -> np.ndarray:
    """(nx, ny, nz) float32: ±10 plus the seeded noise, + on the shell."""
    import torch

    generator = torch.Generator().manual_seed(settings.seed)
    noise = torch.randn((1, 1, *domain.shape), generator=generator)[0, 0].numpy()
    start = np.where(domain.shell, LOGIT, -LOGIT).astype(np.float32)
    logits: np.ndarray = start + noise
    return logits


def _sigmoid(theta: np.ndarray) -> np.ndarray:
    """1 / (1 + e^−θ), elementwise, of any shape."""
    value: np.ndarray = 1.0 / (1.0 + np.exp(-theta))
    return value


def _run(form: LinearForm, start: np.ndarray, device: str) -> tuple[Float, Float]:
    """Free densities (n,) at the last evaluation, and the loss (steps,) at each of them.

    start : (n,) float32, logits of the free voxels.
    """
    import torch

    where = _device(device)
    steps, rate = form.settings.steps, form.settings.rate
    trace = np.zeros(steps)
    near, table = _reached(form)

    def put(array: np.ndarray) -> torch.Tensor:
        """An array of any shape (…,), on the device."""
        return torch.from_numpy(np.ascontiguousarray(array)).to(where)

    with _one_thread(), torch.inference_mode():
        theta = put(start)
        W = put(form.W.astype(np.float32))
        neighbours, reached, sources = put(form.neighbours), put(near), put(table)
        n, m = form.count, len(form.contenders)
        rho = torch.zeros(n + 1, device=where)  # the last stays 0: a neighbour that is not free
        inner = rho[:n]
        slope, first, second, work = (torch.zeros(n, device=where) for _ in range(4))
        pulled = torch.zeros(m + 1, device=where)
        for step in range(steps):
            torch.sigmoid(theta, out=inner)
            s = form.s0 + torch.mv(W, inner).cpu().numpy()
            contact = np.zeros(0)
            if m:
                mean = rho[neighbours].mean(dim=1).cpu().numpy()
                contact = form.decay * (form.r0 + mean)
            value, q, by_contact = form.pull(s, contact)
            trace[step] = value.total
            if step == steps - 1:
                break
            torch.mv(W.T, put(q.astype(np.float32)), out=slope)
            if m:
                pulled[:m] = put((by_contact / form.neighbours.shape[1]).astype(np.float32))
                slope[reached] += pulled[sources].sum(dim=1)
            torch.addcmul(inner, inner, inner, value=-1.0, out=work)
            slope.mul_(work)
            first.lerp_(slope, 1 - BETA1)
            second.mul_(BETA2).addcmul_(slope, slope, value=1 - BETA2)
            torch.sqrt(second, out=work)
            debias = math.sqrt(1 - BETA2 ** (step + 1))
            work.div_(debias).add_(EPS)
            theta.addcdiv_(first, work, value=-rate / (1 - BETA1 ** (step + 1)))
        return inner.cpu().numpy().astype(np.float64), trace


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let torch compute on one CPU thread, and on as many as before afterwards."""
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _reached(form: LinearForm) -> tuple[np.ndarray, np.ndarray]:
    """The kernel's adjoint near the ground, as a gather.

    Returns (r,) the free voxels that a contender's mean reads, and (r, E) the contenders that read
    each, padded with m.
    """
    n, m = form.count, len(form.contenders)
    voxel = form.neighbours.reshape(-1)
    source = np.repeat(np.arange(m), form.neighbours.shape[1] if m else 0)
    kept = voxel < n
    order = np.argsort(voxel[kept], kind="stable")
    voxel, source = voxel[kept][order], source[kept][order]
    near, begin, count = np.unique(voxel, return_index=True, return_counts=True)
    table = np.full((len(near), int(count.max(initial=0))), m, dtype=np.int64)
    row = np.repeat(np.arange(len(near)), count)
    table[row, np.arange(len(voxel)) - np.repeat(begin, count)] = source
    return near, table


def _device(name: str) -> torch.device:
    """The torch device of that name; UsageError when torch cannot use it."""
    import torch

    try:
        device = torch.device(name)
    except RuntimeError as error:
        raise UsageError(f"Device {name!r} does not exist in torch.", "Use cpu or cuda.") from error
    if device.type == "cuda" and not torch.cuda.is_available():
        raise UsageError(f"Device {name!r}: torch finds no CUDA device.", "Use --device cpu.")
    return device
