"""Results for a person at a terminal: short, readable without colour, 80 columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from printprep.report.simulation import azimuth_table, simulated
from printprep.stand.lean import tilt_toward
from printprep.wording import counted

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.pipeline.check import Checked
    from printprep.pipeline.simulate import Simulated
    from printprep.result import HollowResult
    from printprep.types import AlternativeFill, Drainage, Finding, Infill, Repair, SlicerName

_STYLE = {"error": "bold red", "warning": "yellow", "info": "cyan"}
# Rules whose information is in the table already.
_IN_TABLE = frozenset({"sealed-cavity"})
# Rules about the model itself, which hollowing does not change: `check` prints their information.
_OF_THE_MODEL = frozenset(
    {"coarse-facets", "gap", "overhang-area", "trapped-volume", "wall-thickness"}
)


def show_result(
    console: Console,
    result: HollowResult,
    findings: Sequence[Finding] | None = None,
    *,
    output: str | None,
    written_for: SlicerName = "prusa",
    verbose: bool,
) -> None:
    """Print the summary of ``hollow``: what changed, the findings, and where the file is."""
    facts = _facts_table()
    facts.add_row(
        "mass",
        f"{_mass(result.solid_mass_g)} → {_mass(result.mass_g)} "
        f"({100 * result.mass_ratio:.0f} % of the solid)",
    )
    facts.add_row(
        "tips at",
        f"{_tilt(result.tilt_solid_deg)} → {_tilt(result.tilt_deg)}; should stand at {result.lean}",
    )
    if result.wall_min_mm is not None:
        facts.add_row(
            "thinnest wall",
            f"{result.wall_min_mm:.2f} mm (profile: {result.profile.wall_mm:g} mm)",
        )
    if result.simulation is not None:
        facts.add_row("simulated", simulated(result.simulation))
    if result.infill is None:
        facts.add_row("cavities", _cavities(result.part.cavities))
    else:
        facts.add_row("infill", _infill(result.infill))
        facts.add_row("figures", _figures_from(result.infill))
    if result.supports is not None:
        facts.add_row("vaults", _vaults(result))
    if result.drainage is not None and result.part.cavities:
        facts.add_row("drain holes", _drains(result.drainage))
    facts.add_row("base", _base(result))
    if result.alternative_fill is not None:
        facts.add_row(*_alternative(result.alternative_fill))
    proof = _proof(result)
    if proof is not None:
        facts.add_row("proof", proof)
    if verbose and result.density.aim_deg is not None:
        facts.add_row("solved for", f"{result.density.aim_deg:.2f}°, including the margin")
    _add_repair(facts, result.solid.repair)
    if verbose:
        total = sum(result.seconds.values())
        stages = ", ".join(f"{stage} {value:.2f}" for stage, value in result.seconds.items())
        facts.add_row("seconds", f"{total:.2f} ({stages})")
    console.print(facts)
    shown = result.findings if findings is None else findings
    hidden = _IN_TABLE if verbose else _IN_TABLE | _OF_THE_MODEL
    # What kept the part from being written is always shown
    show_findings(console, shown, hidden=frozenset() if output is None else hidden)
    console.print()
    if output is None:
        console.print("Not written: a finding reached the --fail-on level.")
        return
    console.print(Text.assemble("Written: ", (output, "bold")), soft_wrap=True)
    for sentence in _advice(result, output, written_for):
        console.print(Text(sentence))


def show_check(console: Console, found: Checked, *, verbose: bool) -> None:
    """Print the summary of ``check``."""
    context, profile = found.context, found.profile
    facts = _facts_table()
    facts.add_row("size", " × ".join(f"{side:.4g}" for side in context.size_mm) + " mm")
    facts.add_row("mass", f"{_mass(found.mass_g)} in {profile.material.name}")
    tilt = _tilt(tilt_toward(context.stability, context.lean))
    facts.add_row("tips at", f"{tilt}; should stand at {context.lean}")
    if context.wall is not None:
        facts.add_row(
            "thinnest wall", f"{context.wall.value_mm:.2f} mm (profile: {profile.wall_mm:g} mm)"
        )
    facts.add_row("cavities", _cavities(context.cavities))
    if verbose:
        facts.add_row("contact", f"{context.stability.contact_area_mm2:.4g} mm²")
        facts.add_row("triangles", f"{context.part.num_tri()}")
    _add_repair(facts, context.repair)
    console.print(facts)
    show_findings(console, found.findings)
    if not found.findings:
        console.print("\nNo issues found.")


def show_simulation(console: Console, found: Simulated, *, verbose: bool) -> None:
    """Print the summary of ``simulate``."""
    facts = _facts_table()
    facts.add_row(
        "tips at",
        f"{_tilt(tilt_toward(found.stability, found.lean))}; should stand at {found.lean}",
    )
    facts.add_row("simulated", simulated(found.simulation))
    if verbose:
        facts.add_row("contact", f"{found.stability.contact_area_mm2:.4g} mm²")
    _add_repair(facts, found.solid.repair)
    console.print(facts)
    if found.simulation.tippings:
        console.print()
        console.print(azimuth_table(found.simulation))
    show_findings(console, found.findings)


def show_findings(
    console: Console, findings: Sequence[Finding], *, hidden: frozenset[str] = _IN_TABLE
) -> None:
    """Print each finding with its fix, except information of the rules in ``hidden``."""
    shown = [item for item in findings if item.severity != "info" or item.rule not in hidden]
    if not shown:
        return
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for item in shown:
        text = Text(item.message)
        if item.fix:
            text.append(f"\n→ {item.fix}", style="dim")
        text.append(f"  [{item.rule}]", style="dim")
        table.add_row(Text(item.severity, style=_STYLE[item.severity]), text)
    console.print()
    console.print(table)


def _vaults(result: HollowResult) -> str:
    vaults = result.supports
    if vaults is None or not vaults.capitals:
        return "none needed: the ceilings print without support"
    steep = "as steep as the printer lays" if vaults.rule == "printer" else "for any slicer"
    text = f"on {vaults.columns} columns, {_mass(result.supports_mass_g)}, {steep}"
    if vaults.unsupported_mm2 or vaults.islands:
        text += f"; {vaults.unsupported_mm2:.1f} mm² of ceiling still unsupported"
    return text


def _drains(drainage: Drainage) -> str:
    """For example "5 of 3.5 mm (4 outlets, 1 vent), 0.16 cm³ of floors filled"."""
    if not drainage.drains:
        return "none"
    outlets = sum(drain.role == "outlet" for drain in drainage.drains)
    vents = len(drainage.drains) - outlets
    roles = f"{counted(outlets, 'outlet')}, {counted(vents, 'vent')}"
    text = f"{len(drainage.drains)} of {drainage.drains[0].diameter_mm:g} mm ({roles})"
    if drainage.filled_mm3 >= 1:
        text += f", {_plain(drainage.filled_mm3 / 1000)} cm³ of floors filled"
    return text


def _infill(infill: Infill) -> str:
    walls = f"{infill.density:.0%} {infill.pattern}, {infill.perimeters} perimeters"
    if not infill.ballast:
        return f"{walls}; no ballast needed"
    return f"{walls}; dense ballast adds {_mass(infill.ballast_g)}"


def _alternative(fill: AlternativeFill) -> tuple[str, str]:
    """Label and text; the mass is an estimate."""
    about = f"about {float(f'{fill.mass_g:.2g}'):g} g"
    if fill.fill == "infill":
        return "with infill", f"{about} (--fill infill)"
    return "with cavity", f"{about} without its vaults (--fill cavity)"


def _figures_from(infill: Infill) -> str:
    if infill.slicer is None:
        return "estimated without a slicer"
    times = "once" if infill.slices == 1 else f"{infill.slices} times"
    return f"measured in the G-code of {infill.slicer}, sliced {times}"


def _facts_table() -> Table:
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    return table


def _tilt(tilt_deg: float | None) -> str:
    if tilt_deg is None:
        return "no contact"
    return f"{tilt_deg:.1f}°" if tilt_deg >= 0 else f"{tilt_deg:.1f}° (falls over by itself)"


def _mass(mass_g: float) -> str:
    if mass_g >= 1000:
        return f"{_plain(mass_g / 1000)} kg"
    return f"{_plain(mass_g)} g" if mass_g >= 0.1 or mass_g == 0 else f"{_plain(1000 * mass_g)} mg"


def _plain(value: float) -> str:
    """At least three significant digits, without an exponent for what a printer can make."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}" if value < 100 else f"{value:.1f}"


def _proof(result: HollowResult) -> str | None:
    """What the certificate proves; None where there was nothing to choose."""
    certificate, aim_deg = result.density.certificate, result.density.aim_deg
    reachable = result.density.reachable_deg
    if certificate is None or aim_deg is None:
        return None
    if not result.part.cavities and (result.infill is None or not result.infill.ballast):
        return None
    if reachable is not None and reachable <= 0:
        return None
    gap = max(certificate.gap, 0.0)
    least = _mass(certificate.bound_g)
    return f"no filling of its voxels under {least} stands at {aim_deg:.1f}° (gap {gap:.1g})"


def _cavities(cavities: Sequence[Manifold]) -> str:
    if not cavities:
        return "none"
    volume_cm3 = sum(cavity.volume() for cavity in cavities) / 1000
    return f"{len(cavities)}, {_plain(volume_cm3)} cm³"


def _base(result: HollowResult) -> str:
    base = result.part.base
    if base is None:
        return "none"
    grown = f", footprint grown by {base.growth_mm:.2g} mm" if base.growth_mm else ""
    return f"seat {base.seat_mm:.2g} mm high{grown}, {_mass(result.base_mass_g)}"


def _add_repair(facts: Table, repair: Repair) -> None:
    if repair.rung == "as-is":
        return
    actions = "; ".join(action.rstrip(".") for action in repair.actions) or repair.rung
    moved_mm = round(repair.moved_max_mm, 4)
    moved = f"surface moved by up to {moved_mm:.2g} mm" if moved_mm else "surface not moved"
    facts.add_row("repair", f"{actions}; {moved}")


def _advice(result: HollowResult, output: str, written_for: SlicerName) -> list[str]:
    """How to print it: the settings that the file cannot carry."""
    profile = result.profile
    if not profile.traits.has_nozzle:
        return []
    printer = profile.printer
    advice = [
        f"Print it with a first layer of {printer.first_layer_mm:g} mm, a {printer.nozzle_mm:g} mm "
        f"nozzle and {profile.material.name}: a model file cannot carry these "
        f"(`printprep profiles export {profile.name}` writes them for PrusaSlicer)."
    ]
    if result.blocker is not None and written_for == "prusa":
        advice.append(
            "The file keeps PrusaSlicer's supports out of the cavities. Other slicers do not read "
            "that: for them, write the part with --for."
        )
    plate_only = "support_material_buildplate_only" in profile.slicer.object_settings
    if plate_only and result.part.cavities and output.lower().endswith(".3mf"):
        advice.append(
            "If you switch on supports, they start from the build plate only, so that they do not "
            "fill the cavity. Supports outside that would rest on the model are left out too."
        )
    return advice
