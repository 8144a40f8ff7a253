"""Results as JSON for programs: numbers in the units that their keys name, never NaN."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from printprep.output.numbers import number, plain, rounded
from printprep.result import cavity_figures, rounded_finding, rounded_repair
from printprep.version import __version__

if TYPE_CHECKING:
    from printprep.pipeline.check import Checked
    from printprep.pipeline.simulate import Simulated
    from printprep.result import HollowResult
    from printprep.types import Finding, Simulation


def result_json(
    result: HollowResult,
    findings: Sequence[Finding] | None = None,
    *,
    model: str | None = None,
    output: str | None = None,
) -> dict[str, Any]:
    """The result of ``hollow``: the figures that the file carries, and those of the run.

    findings : those of the part and of its print; None for those of the part alone.
    model : the file as the user named it, None for its stem.
    output : the file that was written, None if none was.
    """
    figures = result.figures().to_json()
    return {
        **figures,
        "findings": findings_json(result.findings if findings is None else findings),
        "model": figures["model"] if model is None else model,
        "output": output,
        "simulation": None if result.simulation is None else _simulation(result.simulation),
        "seconds": {stage: round(value, 3) for stage, value in result.seconds.items()},
    }


def check_json(found: Checked, *, model: str) -> dict[str, Any]:
    """The result of ``check``."""
    context, profile = found.context, found.profile
    volume_mm3 = float(context.part.volume())
    wall = context.wall
    return {
        "printprep": __version__,
        "model": model,
        "profile": profile.name,
        "size_mm": [number(side) for side in context.size_mm],
        "volume_mm3": number(volume_mm3),
        "mass_g": number(found.mass_g),
        "tilt_deg": number(context.stability.tilt_deg),
        "lean_deg": number(context.lean.angle_deg),
        "lean_azimuth_deg": number(context.lean.azimuth_deg),
        "wall_min_mm": None if wall is None else number(wall.value_mm),
        "cavities": plain(cavity_figures(context.cavities)),
        "findings": findings_json(found.findings),
        "repair": plain(rounded_repair(context.repair)),
    }


def simulate_json(found: Simulated, *, model: str) -> dict[str, Any]:
    """The result of ``simulate``."""
    return {
        "printprep": __version__,
        "model": model,
        "profile": found.profile.name,
        "tilt_deg": number(found.stability.tilt_deg),
        "lean_deg": number(found.lean.angle_deg),
        "lean_azimuth_deg": number(found.lean.azimuth_deg),
        "simulation": _simulation(found.simulation),
        "findings": findings_json(found.findings),
        "repair": plain(rounded_repair(found.solid.repair)),
    }


def findings_json(findings: Sequence[Finding]) -> list[dict[str, Any]]:
    """Findings with all their fields; an empty field is null."""
    return [plain(rounded_finding(item)) for item in findings]


def _simulation(simulation: Simulation) -> dict[str, Any]:
    return {
        "rotation_deg": round(simulation.settled.rotation_deg, 2),
        "stands": simulation.settled.stands,
        "seconds": rounded(simulation.settled.seconds),
        "azimuths": [
            {
                "azimuth_deg": rounded(item.azimuth_deg),
                "computed_deg": rounded(item.computed_deg),
                "tips_deg": None if item.tips_deg is None else round(item.tips_deg, 2),
                "falls_deg": None if item.falls_deg is None else round(item.falls_deg, 2),
            }
            for item in simulation.tippings
        ],
    }
