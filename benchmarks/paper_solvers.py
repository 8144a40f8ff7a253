"""Compare the three solvers of the paper's objective on every model of a catalogue.

    python benchmarks/paper_solvers.py ../shared/models/catalogue.csv --set dev

Columns: free voxels n; the loss by Adam (fast) and by the plane, each in its own terms; how far the
plane is below; the share of voxels with the same material, of the whole grid and of the free voxels
alone; the plane's steps; seconds of the fast Adam, of the plane with its linear form, and of the
autograd reference (on all threads of torch, timed over --reference-steps and scaled to a full run);
and the two ratios.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import torch

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "paper"))

from paper_models import voxelize  # noqa: E402
from paper_reference import run_autograd  # noqa: E402
from rows import catalogue  # noqa: E402

from printprep.paper.adam import solve_adam  # noqa: E402
from printprep.paper.domain import build_domain  # noqa: E402
from printprep.paper.plane import solve_plane  # noqa: E402
from printprep.paper.settings import PaperSettings  # noqa: E402

HEAD = (
    "| model | n | Adam | plane | below | same, grid | same, free | steps | Adam s | plane s "
    "| autograd s | autograd / Adam | autograd / plane |"
)


def timed(function, *arguments):
    """(result, seconds)."""
    start = time.perf_counter()
    result = function(*arguments)
    return result, time.perf_counter() - start


def row(path: Path, up: str, settings: PaperSettings, reference_steps: int) -> str:
    """One line of the table."""
    domain = build_domain(voxelize(path, up, settings.resolution), settings)
    adam, adam_s = timed(solve_adam, domain, settings)
    plane, plane_s = timed(solve_plane, domain, settings)
    short = PaperSettings(resolution=settings.resolution, steps=reference_steps)
    _, short_s = timed(run_autograd, domain, short, torch.get_num_threads())
    autograd_s = short_s * settings.steps / reference_steps
    below = (adam.terms.total - plane.terms.total) / abs(adam.terms.total)
    same = adam.material == plane.material
    return (
        f"| {path.stem} | {domain.free.sum()} | {adam.terms.total:.4f} | {plane.terms.total:.4f} "
        f"| {below:.1e} | {same.mean():.3%} | {same[domain.free].mean():.3%} "
        f"| {len(plane.trace) - 1} | {adam_s:.2f} | {plane_s:.3f} | {autograd_s:.0f} "
        f"| {autograd_s / adam_s:.0f} | {autograd_s / plane_s:.0f} |"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("--set", default="dev")
    parser.add_argument("--resolution", type=int, default=64)
    parser.add_argument("--reference-steps", type=int, default=20)
    parser.add_argument("--only", nargs="*", help="file stems")
    chosen = parser.parse_args()
    settings = PaperSettings(resolution=chosen.resolution)
    warm = build_domain(np.ones((8, 8, 8), dtype=bool), settings)
    for solver in (solve_adam, solve_plane, run_autograd):
        solver(warm, PaperSettings(steps=2))
    print(HEAD)
    print("|" + " --- |" * HEAD.count(" | ") + " --- |")
    for path, up in catalogue(chosen.catalogue, chosen.only, chosen.set):
        print(row(path, up, settings, chosen.reference_steps), flush=True)


if __name__ == "__main__":
    main()
