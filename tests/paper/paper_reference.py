"""The paper's optimization the plain way: a 3-D convolution, autograd and torch's own Adam.

Source: Dang et al., arXiv 2511.09298, and the authors' published code, whose formulation this is
(not their lines).  Slow on purpose: what the fast solver and the plane are measured against.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch

from printprep.paper.adam import initial_logits
from printprep.paper.domain import PaperDomain
from printprep.paper.settings import PaperSettings


@dataclass(frozen=True, eq=False)
class Reference:
    """smoothed : (nx, ny, nz) ρ̃ at the last evaluation;  trace : the loss at each."""

    smoothed: np.ndarray
    trace: np.ndarray


class Autograd:
    """The loss of a density on one domain, as a differentiable function of its logits."""

    def __init__(self, domain: PaperDomain, settings: PaperSettings, dtype=torch.float32) -> None:
        self.settings, self.dtype = settings, dtype
        self.shell = torch.from_numpy(domain.shell)
        self.kept = torch.from_numpy(domain.shell | domain.free)
        self.free = torch.from_numpy(domain.free)
        self.ground = domain.ground
        self.axes = torch.meshgrid(
            *(torch.arange(length, dtype=dtype) for length in domain.shape), indexing="ij"
        )
        self.kernel = torch.full((1, 1, 3, 3, 3), 1 / 27, dtype=dtype)

    def smooth(self, rho: torch.Tensor) -> torch.Tensor:
        """ρ̃ by convolution."""
        mean = rho
        if self.settings.smoothing:
            mean = torch.nn.functional.conv3d(rho[None, None], self.kernel, padding=1)[0, 0]
        value = torch.where(self.shell, rho, mean)
        return torch.where(self.kept, value, torch.zeros_like(value))

    def loss(self, smoothed: torch.Tensor) -> torch.Tensor:
        """The loss of ρ̃."""
        s = self.settings
        x, y, z = self.axes
        mass = smoothed.sum()
        center = [(axis * smoothed).sum() / mass for axis in (x, y, z)]
        above = smoothed[:, :, self.ground :]
        decay = 4.0 ** -torch.arange(above.shape[2], dtype=self.dtype)
        soft = (above * decay).max(dim=2).values
        offset = torch.stack((center[0] - x[:, :, 0], center[1] - y[:, :, 0]), dim=-1)
        total = torch.zeros((), dtype=self.dtype)
        if s.center:
            total = total + (offset.norm(dim=-1) * soft).sum() / soft.sum()
        if s.region:
            total = total - soft.sum()
        if s.height:
            total = total + center[2] - self.ground
        if s.mass:
            total = total + s.mass_weight * mass / s.resolution**3
        return total


def run_autograd(domain: PaperDomain, settings: PaperSettings, threads: int = 1) -> Reference:
    """``settings.steps`` evaluations in float32, an Adam step after each but the last.

    threads : of torch; small grids are quicker on one, and stay quick on a busy machine.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(threads)
    try:
        return _run(domain, settings)
    finally:
        torch.set_num_threads(before)


def _run(domain: PaperDomain, settings: PaperSettings) -> Reference:
    problem = Autograd(domain, settings)
    theta = torch.from_numpy(initial_logits(domain, settings)).requires_grad_(True)
    adam = torch.optim.Adam([theta], lr=settings.rate)
    trace = []
    for _ in range(settings.steps):
        adam.zero_grad()
        smoothed = problem.smooth(torch.sigmoid(theta))
        loss = problem.loss(smoothed)
        loss.backward()
        theta.grad *= problem.free
        last = smoothed.detach().numpy().copy()
        trace.append(loss.item())
        adam.step()
    return Reference(last, np.array(trace))
