"""The figures of a part, of its print and of a checked file, in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from printprep.page.content import Curve, Dot, Fact, FindingRow, Group, Source, Tone
from printprep.page.words import cost, hours, mass, material_used, plain, tilt
from printprep.version import __version__
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.output.figures import Figures
    from printprep.page.meshes import Meshes
    from printprep.pipeline.check import Checked
    from printprep.pipeline.explore import Point
    from printprep.profiles import Profile
    from printprep.types import Finding, Lean, Simulation
    from printprep.verify.run import Verified


def cards(figures: Figures, profile: Profile) -> tuple[Fact, ...]:
    """The figures of a part to see first."""
    found = [
        Fact(
            "Mass",
            f"{mass(figures.solid_mass_g)} → {mass(figures.mass_g)}",
            f"{100 * figures.mass_ratio:.0f} % of the solid",
        ),
        Fact(
            "Tips at",
            f"{tilt(figures.tilt_solid_deg)} → {tilt(figures.tilt_deg)}",
            f"should stand at {lean_of(figures)}",
            _stands(figures.tilt_deg, figures.lean_deg),
        ),
    ]
    if figures.wall_min_mm is not None:
        thin = figures.wall_min_mm < profile.wall_mm - 0.05
        found.append(
            Fact(
                "Thinnest wall",
                f"{figures.wall_min_mm:.2f} mm",
                f"profile: {profile.wall_mm:g} mm",
                "bad" if thin else "good",
            )
        )
    price = cost(figures.mass_g, profile)
    if price is None:
        found.append(Fact("Material", *material_used(figures.mass_g, profile)))
    else:
        solid = cost(figures.solid_mass_g, profile)
        found.append(Fact("Cost of material", f"{solid} → {price}"))
    return tuple(found)


def groups(
    figures: Figures, profile: Profile, simulation: Simulation | None = None
) -> tuple[Group, ...]:
    """All figures of a part, by what they are about."""
    return (_material(figures, profile), _inside(figures), _standing(figures, simulation))


def _material(figures: Figures, profile: Profile) -> Group:
    rows = [
        Fact("Mass", mass(figures.mass_g), f"in {profile.material.name}"),
        Fact("Solid model", mass(figures.solid_mass_g)),
        Fact("Material", *material_used(figures.mass_g, profile)),
    ]
    price = cost(figures.mass_g, profile)
    if price is not None:
        rows.append(
            Fact("Cost", price, f"the solid would cost {cost(figures.solid_mass_g, profile)}")
        )
    other = figures.alternative_fill
    if other is not None:
        rows.append(
            Fact(
                f"With --fill {other.fill}",
                f"about {float(f'{other.mass_g:.2g}'):g} g",
                "an estimate" + (", without its vaults" if other.fill == "cavity" else ""),
            )
        )
    if figures.certificate is not None and figures.aim_deg is not None:
        rows.append(
            Fact(
                "Proof",
                f"no filling under {mass(figures.certificate.bound_g)}",
                f"of the same voxels stands at {figures.aim_deg:.1f}°",
            )
        )
    return Group("Material", tuple(rows))


def _inside(figures: Figures) -> Group:
    rows = []
    if figures.infill is None:
        volume = sum(item.volume_mm3 for item in figures.cavities.items) / 1000
        value = f"{figures.cavities.count}, {plain(volume)} cm³" if volume else "none"
        rows.append(Fact("Cavities", value))
    else:
        infill = figures.infill
        rows.append(
            Fact(
                "Infill",
                f"{infill.density:.0%} {infill.pattern}, {counted(infill.perimeters, 'perimeter')}",
            )
        )
        rows.append(Fact("Ballast", mass(infill.ballast_g) if infill.ballast_g else "none"))
        how = infill.weighed_with
        rows.append(Fact("Weighed", "estimated" if how is None else f"in the G-code of {how}"))
    vaults = figures.supports
    if vaults is not None:
        value = f"on {counted(vaults.columns, 'column')}, {mass(vaults.added_g)}"
        rows.append(
            Fact(
                "Vaults",
                value if vaults.capitals else "none needed",
                f"for the {vaults.rule}’s overhang rule",
            )
        )
        if vaults.unsupported_mm2:
            rows.append(Fact("Ceiling not supported", f"{vaults.unsupported_mm2:.1f} mm²"))
    drains = figures.drains
    if drains is not None:
        outlets = sum(drain.role == "outlet" for drain in drains.items)
        if drains.items:
            value = f"{drains.count} of {drains.items[0].diameter_mm:g} mm"
            note = f"{counted(outlets, 'outlet')}, {counted(drains.count - outlets, 'vent')}"
            rows.append(Fact("Drain holes", value, note))
        else:
            rows.append(Fact("Drain holes", "none"))
    else:
        rows.append(Fact("Drain holes", "none asked for"))
    if figures.wall_min_mm is not None:
        rows.append(Fact("Thinnest wall", f"{figures.wall_min_mm:.2f} mm"))
    base = figures.base
    if base is not None:
        grown = f", footprint grown by {base.growth_mm:.2g} mm" if base.growth_mm else ""
        rows.append(Fact("Base", f"seat {base.seat_mm:.2g} mm high{grown}", mass(base.mass_g)))
    else:
        rows.append(Fact("Base", "none"))
    return Group("Inside", tuple(rows))


def _standing(figures: Figures, simulation: Simulation | None) -> Group:
    rows = [
        Fact("Tips at", tilt(figures.tilt_deg), f"the solid model: {tilt(figures.tilt_solid_deg)}"),
        Fact("Should stand at", lean_of(figures)),
    ]
    if figures.contact is not None:
        rows.append(Fact("Contact with the bed", f"{plain(figures.contact.area_mm2)} mm²"))
    x, y, z = figures.centre_of_mass_mm
    rows.append(Fact("Centre of mass", f"{x:.1f}, {y:.1f}, {z:.1f} mm".replace("-", "−")))
    if figures.reachable_deg is not None:
        rows.append(Fact("Largest lean of any filling", f"{figures.reachable_deg:.1f}°"))
    if simulation is not None:
        stands = simulation.settled.stands
        value = "stands" if stands else "falls over"
        rows.append(
            Fact(
                "Simulated",
                f"{value} freely",
                f"turned by {simulation.settled.rotation_deg:.1f}°",
                "good" if stands else "bad",
            )
        )
    return Group("Standing", tuple(rows))


def printed_group(found: Verified) -> Group:
    """The print against what was computed, and the hours of each way to print the model."""
    computed, printed = found.part, found.printed
    rows = [
        Fact(
            "Mass",
            f"{mass(printed.mass_g)} printed",
            f"{mass(computed.mass_g)} computed ({100 * found.mass_off:+.1f} %)",
        ),
        Fact("Tips at", f"{found.tilt_deg:.1f}° printed", f"{tilt(computed.tilt_deg)} computed"),
        Fact("Centre of mass", f"{found.centre_off_mm:.2f} mm", "from the one computed"),
        Fact("Time to print", hours(printed.slicer_summary.seconds), "this part"),
    ]
    rows += [
        Fact(
            f"Instead, {item.name}",
            hours(item.seconds),
            f"{mass(item.mass_g)}, "
            + (f"tips at {item.tilt_deg:.1f}°" if item.tilt_deg >= 0 else "falls over by itself"),
        )
        for item in found.baselines
    ]
    return Group("Printed", tuple(rows), f"Measured in the G-code of {found.slicer}.")


def finding_rows(findings: Sequence[Finding]) -> tuple[FindingRow, ...]:
    """Findings, worst first as they come; the ones with a place are numbered."""
    return tuple(
        FindingRow(
            item.severity,
            item.rule,
            item.message,
            item.fix,
            None if item.at_mm is None else number,
        )
        for number, item in enumerate(findings)
    )


def verdict(
    findings: Sequence[Finding], tilt_deg: float | None, lean: str, lean_deg: float
) -> tuple[Tone, str, str]:
    """Tone, a few words, and one sentence: whether it stands, and what else is wrong."""
    errors = sum(item.severity == "error" for item in findings)
    warnings = sum(item.severity == "warning" for item in findings)
    stands = tilt_deg is not None and tilt_deg >= lean_deg - 0.05
    if tilt_deg is None:
        words = "It does not touch the bed"
    elif tilt_deg < 0:
        words = "It falls over by itself"
    else:
        words = f"It stands at {lean}" if stands else f"It tips at {tilt_deg:.1f}°"
    goal = f"It tips at {tilt(tilt_deg)}" if stands else f"It should stand at {lean}"
    if errors:
        more = f" and {counted(warnings, 'warning')}" if warnings else ""
        return "bad", words, f"{goal}. {counted(errors, 'error')}{more} below."
    if warnings:
        return (
            ("warn" if stands else "bad"),
            words,
            f"{goal}. {counted(warnings, 'warning')} below.",
        )
    return ("good" if stands else "bad"), words, f"{goal}. No errors and no warnings."


def lean_of(figures: Figures) -> str:
    """The lean at which the part should stand, in words."""
    from printprep.types import Lean

    return str(Lean(figures.lean_deg, figures.lean_azimuth_deg))


def _stands(tilt_deg: float | None, lean_deg: float) -> Tone:
    return "good" if tilt_deg is not None and tilt_deg >= lean_deg - 0.05 else "bad"


def check_cards(found: Checked) -> tuple[Fact, ...]:
    """The figures of a checked file to see first."""
    context, profile = found.context, found.profile
    size = " × ".join(f"{side:.3g}" for side in context.size_mm)
    cards = [
        Fact("Size", f"{size} mm"),
        Fact("Mass", mass(found.mass_g), f"in {profile.material.name}"),
        Fact(
            "Tips at",
            tilt(context.stability.tilt_deg),
            f"should stand at {context.lean}",
            _stands(context.stability.tilt_deg, context.lean.angle_deg),
        ),
        Fact("Material", *material_used(found.mass_g, profile)),
    ]
    price = cost(found.mass_g, profile)
    if price is not None:
        cards.append(Fact("Cost of material", price))
    return tuple(cards)


def check_groups(found: Checked) -> tuple[Group, ...]:
    """All figures of a checked file."""
    context = found.context
    volume = sum(float(cavity.volume()) for cavity in context.cavities) / 1000
    rows = [
        Fact("Volume", f"{plain(float(context.part.volume()) / 1000)} cm³"),
        Fact(
            "Cavities",
            f"{len(context.cavities)}, {plain(volume)} cm³" if context.cavities else "none",
        ),
        Fact("Contact with the bed", f"{plain(context.stability.contact_area_mm2)} mm²"),
        Fact("Triangles", f"{context.part.num_tri()}"),
    ]
    if context.wall is not None:
        rows.insert(2, Fact("Thinnest wall", f"{context.wall.value_mm:.2f} mm"))
    repair = context.repair
    if repair.rung != "as-is":
        rows.append(Fact("Repair", "; ".join(a.rstrip(".") for a in repair.actions) or repair.rung))
    return (Group("The model", tuple(rows)),)


def origin(source: Source, profile: Profile, meshes: Meshes) -> Group:
    """How the page was made, so that it can be made again."""
    rows = [Fact("File", source.file), Fact("SHA-256", source.sha256)]
    if source.command is not None:
        rows.insert(0, Fact("Command", source.command))
    rows += [Fact("Profile", f"{profile.name} ({profile.process})"), Fact("printprep", __version__)]
    note = None
    if meshes.moved_mm:
        note = (
            f"The picture is simplified: {meshes.shown} of {meshes.triangles} triangles, the "
            f"surface moved by at most {meshes.moved_mm:.2g} mm. All figures are those of the part."
        )
    return Group("How this page was made", tuple(rows), note)


def curve(
    points: Sequence[Point],
    lean: Lean,
    part: tuple[float | None, float] | None,
    solid: tuple[float | None, float],
    note: str,
) -> Curve | None:
    """The chart of mass over lean; None where no filling stands.

    part, solid : tilt angle and mass to mark; a part without contact is left out, and one that
    falls over by itself is marked at 0°.
    """
    if len(points) < 2:
        return None
    dots = []
    if part is not None and part[0] is not None:
        dots.append(Dot(max(part[0], 0.0), part[1], "this part", "part"))
    if solid[0] is not None:
        name = "solid model" if solid[0] >= 0 else "solid model, falls over"
        dots.append(Dot(max(solid[0], 0.0), solid[1], name, "solid"))
    along = tuple((point.lean_deg, point.mass_g) for point in points)
    return Curve(along, tuple(dots), lean.angle_deg, note)
