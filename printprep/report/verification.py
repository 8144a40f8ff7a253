"""The result of ``verify``, as JSON and for a person at a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from printprep.output.numbers import number
from printprep.report.json import findings_json
from printprep.version import __version__

if TYPE_CHECKING:
    from rich.console import Console

    from printprep.gcode.printed import Printed
    from printprep.verify.run import Verified


def verify_json(found: Verified, *, part: str | None) -> dict[str, Any]:
    """The result of ``verify``: computed and printed figures side by side.

    part : the file as the user named it, None if it was not written.
    """
    computed, printed = found.part, found.printed
    return {
        "printprep": __version__,
        "part": part,
        "slicer": found.slicer,
        "profile": computed.profile.name,
        "lean_deg": number(computed.lean.angle_deg),
        "lean_azimuth_deg": number(computed.lean.azimuth_deg),
        "computed": {
            "mass_g": number(computed.mass_g),
            "centre_of_mass_mm": [number(value) for value in computed.centre_mm],
            "tilt_deg": number(computed.tilt_deg),
            "contact_area_mm2": number(computed.contact_area_mm2),
            "bodies": len(computed.bodies),
        },
        "printed": printed_json(printed) | {"tilt_deg": number(found.tilt_deg)},
        "mass_off": number(found.mass_off, 3),
        "centre_off_mm": number(found.centre_off_mm, 3),
        "contact_off_mm": number(found.contact_off_mm, 3),
        "support_in_cavities_mm3": None
        if found.supported is None
        else number(found.supported.support_in_cavities_mm3),
        "baselines": [
            {
                "name": baseline.name,
                "mass_g": number(baseline.mass_g),
                "seconds": number(baseline.seconds),
                "tilt_deg": number(baseline.tilt_deg),
            }
            for baseline in found.baselines
        ],
        "slicer_warnings": list(found.warnings),
        "findings": findings_json(found.findings),
    }


def printed_json(printed: Printed) -> dict[str, Any]:
    """The figures of a print."""
    return {
        "mass_g": number(printed.mass_g),
        "volume_mm3": number(printed.volume_mm3),
        "centre_of_mass_mm": [number(value) for value in printed.centre_of_mass_mm],
        "inertia_g_mm2": [[number(value) for value in row] for row in printed.inertia_g_mm2],
        "tilt_deg": number(printed.tilt_deg),
        "contact_polygon_mm": [
            [number(value) for value in at] for at in printed.contact_polygon_mm
        ],
        "contact_area_mm2": number(printed.contact_area_mm2),
        "in_cavities_mm3": number(printed.in_cavities_mm3),
        "seconds": number(printed.slicer_summary.seconds),
        "filament_mm3": number(printed.filament_mm3),
        "filament_said_mm3": number(printed.slicer_summary.filament_mm3),
        "mass_by_feature_g": {
            feature: number(mass) for feature, mass in printed.feature_mass_g.items()
        },
        "left_out": list(printed.left_out),
        "assumed": list(printed.assumed),
    }


def show_verified(console: Console, found: Verified, *, with_findings: bool = True) -> None:
    """Print the summary: printed against computed, then the usual infills, then the findings."""
    from rich.table import Table

    from printprep.report.terminal import show_findings

    computed, printed = found.part, found.printed
    console.print(f"Sliced with {found.slicer}, profile {computed.profile.name}")
    facts = Table.grid(padding=(0, 2, 0, 0))
    facts.add_column(style="dim", no_wrap=True)
    facts.add_column(overflow="fold")
    off = 100 * found.mass_off
    facts.add_row(
        "mass", f"{printed.mass_g:.2f} g printed, {computed.mass_g:.2f} g computed ({off:+.1f} %)"
    )
    facts.add_row("centre of mass", f"printed {found.centre_off_mm:.2f} mm from the one computed")
    tilt = "no contact" if computed.tilt_deg is None else f"{computed.tilt_deg:.1f}°"
    facts.add_row(
        "tips at",
        f"{found.tilt_deg:.1f}° printed, {tilt} computed; should stand at {computed.lean}",
    )
    facts.add_row(
        "contact",
        f"{printed.contact_area_mm2:.0f} mm² printed, {computed.contact_area_mm2:.0f} mm² computed",
    )
    if computed.cavities:
        facts.add_row("in cavities", _volume(printed.in_cavities_mm3))
    if found.supported is not None:
        facts.add_row("support inside", _volume(found.supported.support_in_cavities_mm3))
    facts.add_row("time", _hours(printed.slicer_summary.seconds))
    for baseline in found.baselines:
        if baseline.tilt_deg >= 0:
            tips = f"tips at {baseline.tilt_deg:.1f}°"
        else:
            tips = "falls over by itself"
        facts.add_row(baseline.name, f"{baseline.mass_g:.2f} g, {_hours(baseline.seconds)}, {tips}")
    console.print(facts)
    if with_findings and found.findings:
        show_findings(console, found.findings)
    for warning in found.warnings:
        console.print(f"The slicer warns: {warning}")


def _volume(volume_mm3: float) -> str:
    return f"{volume_mm3 / 1000:.2g} cm³" if volume_mm3 > 0 else "nothing"


def _hours(seconds: float | None) -> str:
    return "time unknown" if seconds is None else f"{seconds / 3600:.1f} h"
