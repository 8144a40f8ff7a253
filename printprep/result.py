"""The result of ``hollow``: the part, its figures as a file carries them, and how to write it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.mesh.measure import bodies, volume_and_centre
from printprep.output.numbers import number, place, rounded
from printprep.stand.contact import contact_of, section_at_bed
from printprep.stand.lean import tilt_toward

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.mesh.carry import Carried
    from printprep.output.figures import (
        BaseFigures,
        Cavities,
        ContactFigures,
        Drains,
        Figures,
        Place,
        SparseInfill,
        Vaults,
    )
    from printprep.output.part_file import Contents
    from printprep.profiles import Profile
    from printprep.types import (
        Advice,
        AlternativeFill,
        Certificate,
        Density,
        Drainage,
        Finding,
        Infill,
        Lean,
        Model,
        Part,
        Plane,
        Repair,
        Simulation,
        SlicerName,
        Solid,
        Stability,
        Supports,
    )


@dataclass(frozen=True, eq=False)
class Workings:
    """What a part was computed from; no file contains it.

    program : the linear programs;  depths : below the model's surface.
    deep, hollowable : all deeper than the wall, and the same without the vaults; None where no
    cavity was cut.
    """

    program: Program
    depths: Depths
    deep: Manifold | None
    hollowable: Manifold | None


@dataclass(frozen=True, eq=False)
class HollowResult:
    """Everything that ``hollow`` computes.  Masses are geometric volume times material density.

    With ``infill`` instead of cavities, mass and stability are those of the print.

    model : as placed;  solid : repaired;  part : what is printed.
    stability_solid, stability : how solid and part stand.
    lean : the lean at which the part should stand.
    blocker : where the file tells a slicer to make no supports, None if nowhere.
    wall_min_mm : thinnest wall between a cavity and the outside, None without a cavity.
    paint : colours of the part's outside, carried from the model; None where it has none.
    seconds : duration of each stage;  workings : for a picture of the inside.  No file contains
    either.
    """

    model: Model
    solid: Solid
    part: Part
    profile: Profile
    density: Density
    stability_solid: Stability
    stability: Stability
    lean: Lean
    solid_mass_g: float
    mass_g: float
    wall_min_mm: float | None
    findings: tuple[Finding, ...]
    advice: Advice | None = None
    supports: Supports | None = None
    blocker: Manifold | None = None
    drainage: Drainage | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)
    simulation: Simulation | None = None
    infill: Infill | None = None
    alternative_fill: AlternativeFill | None = None
    paint: Carried | None = None
    workings: Workings | None = None

    @property
    def lean_deg(self) -> float:
        """Angle of the requested lean."""
        return self.lean.angle_deg

    @property
    def mass_ratio(self) -> float:
        """Mass of the part over mass of the solid."""
        return self.mass_g / self.solid_mass_g

    @property
    def base_mass_g(self) -> float:
        """Mass in g that the base adds to the model, 0 without a base."""
        added_mm3 = float(self.part.outside.volume() - self.solid.whole.volume())
        return added_mm3 * float(self.profile.material.density_g_cm3) / 1000

    @property
    def supports_mass_g(self) -> float:
        """Mass in g of the vaults in the whole hollowable volume, 0 without vaults."""
        added_mm3 = 0.0 if self.supports is None else self.supports.added_mm3
        return added_mm3 * float(self.profile.material.density_g_cm3) / 1000

    @property
    def tilt_solid_deg(self) -> float | None:
        """Tilt angle of the solid, toward the lean's azimuth if it has one; None: no contact."""
        return tilt_toward(self.stability_solid, self.lean)

    @property
    def tilt_deg(self) -> float | None:
        """Tilt angle of the part, toward the lean's azimuth if it has one; None: no contact."""
        return tilt_toward(self.stability, self.lean)

    @property
    def centre_mm(self) -> tuple[float, float, float]:
        """Centre of mass (x, y, z) of the part, or with infill of its print."""
        if self.infill is not None:
            return self.infill.centre_mm
        return volume_and_centre(self.part.manifold)[1]

    def figures(self) -> Figures:
        """The figures that a file of the part carries."""
        return _figures_of(self)

    def contents(self) -> Contents:
        """Everything that a file of the part is made from."""
        from printprep.output.part_file import Contents

        return Contents(
            self.part, self.profile, self.infill, self.figures(), self.blocker, self.paint
        )

    def write(
        self, path: str | Path, slicer: SlicerName = "prusa", *, without_blocker: bool = False
    ) -> None:
        """Write the part; the suffix chooses the format (.3mf carries the settings of its slicer).

        without_blocker : also write vaults for the printer into a file that cannot carry the
            support blocker; such a part must be sliced without supports.

        Raises
        ------
        UsageError : a suffix other than .3mf, .stl, .obj, .ply; or a file that cannot carry the
            support blocker that the vaults count on.
        OutputError : the file cannot be written; an existing file is then unchanged.
        """
        from printprep.output.limits import check_blocker
        from printprep.output.part_file import write_part

        if not without_blocker and self.supports is not None:
            check_blocker(self.supports.rule, Path(path).suffix, slicer)
        write_part(self.contents(), path, slicer)


def _figures_of(result: HollowResult) -> Figures:
    from printprep.output.figures import Figures
    from printprep.version import __version__

    profile, density, part = result.profile, result.density, result.part
    rows = [[rounded(float(item), 9) for item in row] for row in part.placement]
    return Figures(
        printprep=__version__,
        model=result.model.name,
        profile=profile.name,
        settings=profile.model_dump(mode="json", exclude={"name"}),
        placement=(_four(rows[0]), _four(rows[1]), _four(rows[2]), _four(rows[3])),
        solid_mass_g=rounded(result.solid_mass_g),
        mass_g=rounded(result.mass_g),
        mass_ratio=rounded(result.mass_ratio),
        bounds_mm=_bounds(part.manifold, 4),
        centre_of_mass_mm=place(result.centre_mm, 4),
        contact=_contact(part.manifold, profile.printer.first_layer_mm),
        bodies=len(bodies(part.manifold)),
        tilt_solid_deg=number(result.tilt_solid_deg),
        tilt_deg=number(result.tilt_deg),
        lean_deg=rounded(result.lean_deg),
        lean_azimuth_deg=number(result.lean.azimuth_deg),
        aim_deg=number(density.aim_deg),
        reachable_deg=number(density.reachable_deg),
        advice=_advice(result.advice),
        supports=_vaults(result),
        drains=_drains(result.drainage),
        infill=_infill(result.infill),
        alternative_fill=_alternative(result.alternative_fill),
        wall_min_mm=number(result.wall_min_mm),
        cavities=cavity_figures(part.cavities),
        base=_base(result),
        certificate=_certificate(density.certificate),
        findings=tuple(rounded_finding(item) for item in result.findings),
        repair=rounded_repair(result.solid.repair),
        planes=_planes(density.planes),
    )


def rounded_finding(item: Finding) -> Finding:
    """A finding with its numbers rounded as in JSON."""
    return replace(
        item,
        value=number(item.value),
        limit=number(item.limit),
        at_mm=None if item.at_mm is None else place(item.at_mm),
        area_mm2=number(item.area_mm2),
        volume_mm3=number(item.volume_mm3),
    )


def rounded_repair(repair: Repair) -> Repair:
    """A repair with its numbers rounded as in JSON."""
    return replace(
        repair,
        moved_max_mm=round(repair.moved_max_mm, 4),
        moved_mean_mm=round(repair.moved_mean_mm, 4),
        resolution_mm=number(repair.resolution_mm),
    )


def cavity_figures(cavities: Sequence[Manifold]) -> Cavities:
    """The number of cavities, each with its volume and bounding box."""
    from printprep.output.figures import Cavities, Cavity

    items = tuple(Cavity(rounded(void.volume()), _bounds(void, 3)) for void in cavities)
    return Cavities(len(items), items)


def _four(row: Sequence[float]) -> tuple[float, float, float, float]:
    a, b, c, d = row
    return a, b, c, d


def _bounds(manifold: Manifold, decimals: int) -> tuple[Place, Place]:
    x0, y0, z0, x1, y1, z1 = manifold.bounding_box()
    return place((x0, y0, z0), decimals), place((x1, y1, z1), decimals)


def _contact(part: Manifold, first_layer_mm: float) -> ContactFigures | None:
    from printprep.output.figures import ContactFigures

    contact = contact_of(section_at_bed(part, first_layer_mm))
    if contact is None:
        return None
    polygon = tuple(
        (round(float(x), 4) + 0.0, round(float(y), 4) + 0.0) for x, y in contact.polygon_mm
    )
    return ContactFigures(polygon, rounded(contact.area_mm2))


def _advice(advice: Advice | None) -> Advice | None:
    if advice is None:
        return None
    return replace(
        advice,
        growth_mm=number(advice.growth_mm),
        poses_deg=tuple(rounded(tilt) for tilt in advice.poses_deg),
    )


def _vaults(result: HollowResult) -> Vaults | None:
    from printprep.output.figures import Vaults

    supports = result.supports
    if supports is None:
        return None
    return Vaults(
        rule=supports.rule,
        capitals=supports.capitals,
        columns=supports.columns,
        added_mm3=rounded(supports.added_mm3),
        added_g=rounded(result.supports_mass_g),
        unsupported_mm2=rounded(supports.unsupported_mm2),
        islands=supports.islands,
    )


def _drains(drainage: Drainage | None) -> Drains | None:
    from printprep.output.figures import Drains

    if drainage is None:
        return None
    items = tuple(
        replace(
            drain,
            centre_mm=place(drain.centre_mm),
            axis=(rounded(drain.axis[0]), rounded(drain.axis[1]), rounded(drain.axis[2])),
            diameter_mm=rounded(drain.diameter_mm),
            length_mm=rounded(drain.length_mm, 3),
        )
        for drain in drainage.drains
    )
    return Drains(
        count=len(items),
        items=items,
        filled_mm3=rounded(drainage.filled_mm3),
        closed_mm3=tuple(rounded(volume) for volume in drainage.closed_mm3),
    )


def _infill(infill: Infill | None) -> SparseInfill | None:
    from printprep.output.figures import SparseInfill

    if infill is None:
        return None
    return SparseInfill(
        pattern=infill.pattern,
        density=rounded(infill.density),
        perimeters=infill.perimeters,
        solid_layers=infill.layers,
        ballast_g=rounded(infill.ballast_g),
        weighed_with=infill.slicer,
        slices=infill.slices,
    )


def _alternative(fill: AlternativeFill | None) -> AlternativeFill | None:
    return None if fill is None else replace(fill, mass_g=rounded(fill.mass_g, 3))


def _base(result: HollowResult) -> BaseFigures | None:
    from printprep.output.figures import BaseFigures

    base = result.part.base
    if base is None:
        return None
    return BaseFigures(rounded(base.seat_mm), rounded(base.growth_mm), rounded(result.base_mass_g))


def _planes(planes: Sequence[Plane | None] | None) -> tuple[Plane | None, ...] | None:
    if planes is None:
        return None
    return tuple(None if plane is None else _plane(plane) for plane in planes)


def _plane(plane: Plane) -> Plane:
    nx, ny, nz = (rounded(value, 9) for value in plane.normal)
    return replace(plane, normal=(nx, ny, nz), offset_mm=rounded(plane.offset_mm, 9))


def _certificate(certificate: Certificate | None) -> Certificate | None:
    if certificate is None:
        return None
    return replace(
        certificate,
        voxel_mass_g=rounded(certificate.voxel_mass_g, 9),
        bound_g=rounded(certificate.bound_g, 9),
        gap=rounded(certificate.gap, 3),
    )
