"""What was found out, as JSON for programs: numbers in the units their keys name, never NaN."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.stand.balance import balance_json
from printprep.stand.lean import tilt_toward
from printprep.version import __version__

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.check.context import CheckContext
    from printprep.pipeline.simulate import TriedOut
    from printprep.profiles import Profile
    from printprep.types import (
        Advice,
        Base,
        Drainage,
        Finding,
        HollowResult,
        Infill,
        Repair,
        Simulation,
    )


def to_text(data: dict[str, Any]) -> str:
    """One JSON object, in ASCII so that any terminal and pipe takes it.

    Raises ValueError for a number that is not finite: there is none in a sound report.
    """
    return json.dumps(data, indent=2, allow_nan=False)


def result_json(
    result: HollowResult, *, model: str | None = None, output: str | None = None
) -> dict[str, Any]:
    """All that ``hollow`` found out.

    model : the file as the user named it, else its stem;  output : where the part was written,
    None when it was not.
    """
    facts = _facts(result)
    return {
        **facts,
        "model": facts["model"] if model is None else model,
        "output": output,
        "simulation": None if result.simulation is None else _simulation(result.simulation),
        "seconds": {stage: round(value, 3) for stage, value in result.seconds.items()},
    }


def embedded_json(result: HollowResult) -> dict[str, Any]:
    """The same for inside the file: no time, path, user or machine, so that bytes repeat."""
    return _facts(result)


def check_json(
    context: CheckContext, findings: Sequence[Finding], profile: Profile, *, model: str
) -> dict[str, Any]:
    """What ``check`` found out about a file."""
    volume_mm3 = float(context.part.volume())
    wall = context.wall
    return {
        "printprep": __version__,
        "model": model,
        "profile": profile.name,
        "size_mm": [number(side) for side in context.size_mm],
        "volume_mm3": number(volume_mm3),
        "mass_g": number(volume_mm3 * profile.material.density_g_cm3 / 1000),
        "tilt_deg": number(context.stability.tilt_deg),
        "lean_deg": number(context.lean.angle_deg),
        "lean_azimuth_deg": number(context.lean.azimuth_deg),
        "wall_min_mm": None if wall is None else number(wall.value_mm),
        "cavities": _cavities(context.cavities),
        "findings": [finding_json(item) for item in findings],
        "repair": _repair(context.repair),
    }


def simulate_json(found: TriedOut, *, model: str) -> dict[str, Any]:
    """What ``simulate`` found out about a file."""
    return {
        "printprep": __version__,
        "model": model,
        "profile": found.profile.name,
        "tilt_deg": number(found.stability.tilt_deg),
        "lean_deg": number(found.lean.angle_deg),
        "lean_azimuth_deg": number(found.lean.azimuth_deg),
        "simulation": _simulation(found.simulation),
        "findings": [finding_json(item) for item in found.findings],
        "repair": _repair(found.solid.repair),
    }


def finding_json(finding: Finding) -> dict[str, Any]:
    """A finding with all its fields, null where it has none."""
    return {
        "rule": finding.rule,
        "severity": finding.severity,
        "message": finding.message,
        "fix": finding.fix,
        "value": number(finding.value),
        "limit": number(finding.limit),
        "unit": finding.unit,
        "at_mm": None if finding.at_mm is None else _place(finding.at_mm),
        "area_mm2": number(finding.area_mm2),
        "volume_mm3": number(finding.volume_mm3),
    }


def _supports(result: HollowResult) -> dict[str, Any] | None:
    """The vaults over all the room; what ballast swallows of them is in no sum twice."""
    found = result.supports
    if found is None:
        return None
    return {
        "capitals": found.capitals,
        "columns": found.columns,
        "added_mm3": number(found.added_mm3),
        "added_g": number(found.added_mm3 * result.profile.material.density_g_cm3 / 1000),
        "unsupported_mm2": number(found.unsupported_mm2),
        "islands": found.islands,
    }


def _drains(found: Drainage | None) -> dict[str, Any] | None:
    if found is None:
        return None
    return {
        "count": len(found.drains),
        "items": [
            {
                "role": drain.role,
                "cavity": drain.cavity,
                "centre_mm": _place(drain.centre_mm),
                "axis": [number(value) for value in drain.axis],
                "diameter_mm": number(drain.diameter_mm),
                "length_mm": number(drain.length_mm, 3),
            }
            for drain in found.drains
        ],
        "filled_mm3": number(found.filled_mm3),
        "closed_mm3": [number(volume) for volume in found.closed_mm3],
    }


def _infill(infill: Infill | None) -> dict[str, Any] | None:
    if infill is None:
        return None
    return {
        "pattern": infill.pattern,
        "density": number(infill.density),
        "perimeters": infill.perimeters,
        "solid_layers": infill.layers,
        "ballast_g": number(infill.ballast_g),
        "weighed_with": infill.slicer,
        "slices": infill.slices,
    }


def _advice(advice: Advice | None) -> dict[str, Any] | None:
    if advice is None:
        return None
    return {
        "growth_mm": number(advice.growth_mm),
        "poses_deg": [number(tilt) for tilt in advice.poses_deg],
    }


def number(value: float | None, digits: int = 6) -> float | None:
    """A plain number without the digits that are only noise."""
    return None if value is None else float(f"{value:.{digits}g}") + 0.0


def _facts(result: HollowResult) -> dict[str, Any]:
    profile = result.profile
    certificate = result.density.certificate
    return {
        "printprep": __version__,
        "model": result.model.name,
        "profile": profile.name,
        "settings": profile.model_dump(mode="json", exclude={"name"}),
        "placement": [[number(item, 9) for item in row] for row in result.part.placement],
        "solid_mass_g": number(result.solid_mass_g),
        "mass_g": number(result.mass_g),
        "mass_ratio": number(result.mass_g / result.solid_mass_g),
        **balance_json(
            result.part.manifold,
            profile.printer.first_layer_mm,
            None if result.infill is None else result.infill.centre_mm,
        ),
        "tilt_solid_deg": number(tilt_toward(result.stability_solid, result.lean)),
        "tilt_deg": number(tilt_toward(result.stability, result.lean)),
        "lean_deg": number(result.lean_deg),
        "lean_azimuth_deg": number(result.lean.azimuth_deg),
        "aim_deg": number(result.density.aim_deg),
        "reachable_deg": number(result.density.reachable_deg),
        "advice": _advice(result.advice),
        "supports": _supports(result),
        "drains": _drains(result.drainage),
        "infill": _infill(result.infill),
        "other_way": None
        if result.alternative_fill is None
        else {
            "fill": result.alternative_fill.fill,
            "mass_g": number(result.alternative_fill.mass_g, 3),
        },
        "wall_min_mm": number(result.wall_min_mm),
        "cavities": _cavities(result.part.cavities),
        "base": _base(result.part.base, base_mass_g(result)),
        "certificate": None
        if certificate is None
        else {
            "voxel_mass_g": number(certificate.voxel_mass_g, 9),
            "bound_g": number(certificate.bound_g, 9),
            "gap": number(certificate.gap, 3),
        },
        "findings": [finding_json(item) for item in result.findings],
        "repair": _repair(result.solid.repair),
    }


def base_mass_g(result: HollowResult) -> float:
    """Mass of the material the base adds to the model."""
    added_mm3 = float(result.part.outside.volume() - result.solid.manifold.volume())
    return added_mm3 * float(result.profile.material.density_g_cm3) / 1000


def _base(base: Base | None, mass_g: float) -> dict[str, float | None] | None:
    if base is None:
        return None
    return {
        "seat_mm": number(base.seat_mm),
        "growth_mm": number(base.growth_mm),
        "mass_g": number(mass_g),
    }


def _cavities(cavities: Sequence[Manifold]) -> dict[str, Any]:
    items = [
        {
            "volume_mm3": number(cavity.volume()),
            "bounds_mm": [_place(corner) for corner in np.reshape(cavity.bounding_box(), (2, 3))],
        }
        for cavity in cavities
    ]
    return {"count": len(items), "items": items}


def _simulation(simulation: Simulation) -> dict[str, Any]:
    return {
        "rotation_deg": round(simulation.settled.rotation_deg, 2),
        "stands": simulation.settled.stands,
        "seconds": number(simulation.settled.seconds),
        "azimuths": [
            {
                "azimuth_deg": number(item.azimuth_deg),
                "computed_deg": number(item.computed_deg),
                "tips_deg": None if item.tips_deg is None else round(item.tips_deg, 2),
                "falls_deg": None if item.falls_deg is None else round(item.falls_deg, 2),
            }
            for item in simulation.tippings
        ],
    }


def _repair(repair: Repair) -> dict[str, Any]:
    return {
        "rung": repair.rung,
        "actions": list(repair.actions),
        "moved_max_mm": round(repair.moved_max_mm, 4),
        "moved_mean_mm": round(repair.moved_mean_mm, 4),
        "resolution_mm": number(repair.resolution_mm),
    }


def _place(point: Sequence[float]) -> list[float]:
    return [round(float(value), 3) + 0.0 for value in point]
