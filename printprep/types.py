"""The frozen values that cross from one room of printprep to the next.

Axis order is x, y, z; z is up; the bed is z = 0.  Lengths are mm, volumes mm³, masses g, angles
degrees, densities g/cm³.  ``eq=False`` where a field is an array or a mesh: identity is meant.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int


Severity = Literal["info", "warning", "error"]
Unit = Literal["mm", "mm2", "mm3", "deg", "g", "percent"]  # of a finding's value and limit
SlicerName = Literal["prusa", "orca", "cura", "generic"]  # whose settings a file is written for
Rung = Literal["as-is", "union", "meshlab", "remesh"]


@dataclass(frozen=True, eq=False)
class Model:
    """Triangles as they came in, welded, in mm, z up, sitting on the bed, centred on x = y = 0.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64, counter-clockwise seen from outside.
    placement : (4, 4) float64, file coordinates → these coordinates.
    name : the file's stem (never a path).
    """

    vertices: Float
    faces: Int
    placement: Float
    name: str


@dataclass(frozen=True)
class Repair:
    """What it took to make a solid of the model.

    rung : the step of the ladder that sufficed.
    actions : one short sentence each, in order; empty when rung is "as-is".
    moved_max_mm, moved_mean_mm : how far the model's surface lies from the solid's, over samples.
    resolution_mm : cell size of the remesh, None on the other rungs.
    """

    rung: Rung
    actions: tuple[str, ...] = ()
    moved_max_mm: float = 0.0
    moved_mean_mm: float = 0.0
    resolution_mm: float | None = None


@dataclass(frozen=True, eq=False)
class Solid:
    """A valid manifold of positive volume (shells inside it are true voids), on the bed, in mm."""

    manifold: Manifold
    name: str
    repair: Repair
    placement: Float


@dataclass(frozen=True)
class MassProperties:
    """Integrals over a closed mesh at unit density.

    volume_mm3; centre_mm : (x, y, z); inertia_mm5 : 3×3 nested tuple about the centre of mass
    (multiply by g/mm³ for g·mm²).
    """

    volume_mm3: float
    centre_mm: tuple[float, float, float]
    inertia_mm5: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Finding:
    """One thing the user should know.

    rule : stable id of the rule;  value, limit : numbers in ``unit`` or None;
    message : what is so, for the one who prints;  fix : the way out, for the one who changes it.
    at_mm : where, or None;  area_mm2, volume_mm3 : how much of it, None where it has none.
    """

    rule: str
    severity: Severity
    message: str
    fix: str | None = None
    value: float | None = None
    limit: float | None = None
    unit: Unit | None = None
    at_mm: tuple[float, float, float] | None = None
    area_mm2: float | None = None
    volume_mm3: float | None = None


@dataclass(frozen=True)
class Lean:
    """A lean the part must stand: by an angle, in every direction or toward one azimuth.

    azimuth_deg : from +x counter-clockwise, None for every direction.
    """

    angle_deg: float
    azimuth_deg: float | None = None

    def __str__(self) -> str:
        if self.azimuth_deg is None:
            return f"{self.angle_deg:g}°"
        return f"{self.angle_deg:g}° toward azimuth {self.azimuth_deg:g}°"


@dataclass(frozen=True, eq=False)
class Grid:
    """A regular grid of cell centres.

    origin_mm : (3,) centre of cell (0, 0, 0);  pitch_mm : edge of a cubic cell;
    shape : (nx, ny, nz).
    """

    origin_mm: Float
    pitch_mm: float
    shape: tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Domain:
    """What may change and what may not, on one grid; arrays of shape ``grid.shape``.

    depth_mm : float64, signed distance to the model's surface, positive inside; exact in the
    narrow band around the wall's inner face, elsewhere at least on the right side of it.
    shell, interior, base, free : bool, by cell centre (free = interior; the base is geometry).
    share : float64 in [0, 1], the part of each cell that lies deeper than the wall, the weight of
    a free voxel in the linear program.
    body : int64, −1 outside, else which disjoint body of the solid the cell belongs to.
    """

    grid: Grid
    depth_mm: Float
    shell: Bool
    interior: Bool
    base: Bool
    free: Bool
    share: Float
    body: Int


@dataclass(frozen=True)
class Plane:
    """The half-space {x : normal · x > offset_mm} that stays empty; below it is filled."""

    normal: tuple[float, float, float]
    offset_mm: float


@dataclass(frozen=True)
class Certificate:
    """Proof that no lighter filling of the same voxels stands at the same lean.

    voxel_mass_g : mass of the filling found;  bound_g : no filling weighs less (weak duality);
    gap : (voxel_mass_g − bound_g) / voxel_mass_g.
    """

    voxel_mass_g: float
    bound_g: float
    gap: float


@dataclass(frozen=True, eq=False)
class Density:
    """The optimized interior.

    rho : float64 of the grid's shape, 1 solid, 0 empty, over the whole model.
    planes : one per body: the plane above which the cavity lies, or None when nothing is filled;
    None in all: no plane, the cavity is where rho is below one half.
    aim_deg : the lean solved for (margin included), None for the paper's objective.
    reachable_deg : largest lean any filling reaches, None when the lean asked for is feasible.
    """

    rho: Float
    planes: tuple[Plane | None, ...] | None
    aim_deg: float | None
    reachable_deg: float | None
    certificate: Certificate | None


@dataclass(frozen=True, eq=False)
class Base:
    """New material around the feet: a seat (columns down to the bed) and a grown footprint."""

    manifold: Manifold
    seat_mm: float
    growth_mm: float


@dataclass(frozen=True, eq=False)
class Part:
    """What is printed.

    manifold : the whole part, cavities as inverted shells;  outside : model with its base, with
    the voids the model already had;  cavities : positive solids that were taken out, one each.
    """

    manifold: Manifold
    outside: Manifold
    cavities: tuple[Manifold, ...]
    base: Base | None
    name: str
    placement: Float


@dataclass(frozen=True, eq=False)
class Stability:
    """How a part stands on the bed; the weakest body of it when there are several.

    support_polygon_mm : (k, 2) counter-clockwise hull of the contact, empty when nothing touches;
    contact_area_mm2 : of the section itself, not of its hull;
    tilt_deg : the lean at which it tips over the weakest edge, negative when it tips by itself,
    None when it has no contact;
    weakest_edge : index of the edge from vertex i to i + 1, with its outward azimuth.
    """

    support_polygon_mm: Float
    contact_area_mm2: float
    centre_of_mass_mm: tuple[float, float, float]
    tilt_deg: float | None
    weakest_edge: int | None
    weakest_azimuth_deg: float | None


@dataclass(frozen=True)
class Settled:
    """What became of a part that was let go on the bed; the worst body of it when several.

    rotation_deg : how far it had turned in the end;  stands : whether that is less than falling.
    seconds : of simulated time.
    """

    rotation_deg: float
    stands: bool
    seconds: float


@dataclass(frozen=True)
class Tipping:
    """What becomes of a part that leans ever more toward one azimuth.

    azimuth_deg : the direction it leans toward, from +x counter-clockwise.
    computed_deg : its tilt angle that way, from support polygon and centre of mass; negative when
    it tips by itself.
    tips_deg : the lean at which its foot comes off the bed in simulation.
    falls_deg : the lean at which it goes over; more than tips_deg where another part of it, a
    wing or a tail, comes down on the bed and holds it.
    Both are 0 when it happens on the level bed, None when not up to the largest lean tried.
    """

    azimuth_deg: float
    computed_deg: float
    tips_deg: float | None
    falls_deg: float | None


@dataclass(frozen=True)
class Simulation:
    """A part in the hands of a physics engine: let go, and on a bed that tilts slowly.

    tippings : one for each azimuth tried, none for a part that has no contact.
    """

    settled: Settled
    tippings: tuple[Tipping, ...]


@dataclass(frozen=True)
class Supports:
    """The vaults that carry a cavity's ceilings from inside, over all the room for cavities.

    added_mm3 : what they take of the room; where ballast fills it too, nothing is counted twice.
    unsupported_mm2, islands : what the slicer's acceptance rule still flags.
    """

    capitals: int
    columns: int
    added_mm3: float
    unsupported_mm2: float
    islands: int


@dataclass(frozen=True)
class Drain:
    """A round hole from a cavity to the outside.

    role : an outlet empties a pool, a vent lets air in;  cavity : index among the part's.
    centre_mm : the middle of its mouth, on the outside;  axis : unit vector, outward.
    length_mm : of its axis in material.
    """

    role: Literal["outlet", "vent"]
    cavity: int
    centre_mm: tuple[float, float, float]
    axis: tuple[float, float, float]
    diameter_mm: float
    length_mm: float


@dataclass(frozen=True)
class Drainage:
    """How a part drains as it stands on the plate.

    drains : cavity by cavity, outlets first.
    filled_mm3 : of the cavities' floors, where liquid would stand that no outlet takes.
    closed_mm3 : volumes of cavities that no hole opens: they are filled.
    """

    drains: tuple[Drain, ...]
    filled_mm3: float
    closed_mm3: tuple[float, ...]


@dataclass(frozen=True)
class Advice:
    """What would make a lean that is out of reach feasible.

    growth_mm : least growth of the footprint, in steps of half a millimetre, at which some filling
    reaches it; None when none up to 30 mm does.
    poses_deg : tilt angles of the solid in its stable poses, the steadiest first.
    """

    growth_mm: float | None
    poses_deg: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Infill:
    """A part whose inside is the slicer's sparse infill, and what of it prints dense instead.

    pattern, density, perimeters, layers : what the object carries;  ballast : solids that cover
    what prints dense, in the part's coordinates;  ballast_g : what they add to the sparse print.
    moments : (4,) volume in mm³ of all that is deposited, and its first moments in mm⁴.
    slicer : its name and version where the print was weighed in its G-code, None where it is
    estimated;  slices : how often it was asked.
    """

    pattern: str
    density: float
    perimeters: int
    layers: int
    ballast: tuple[Manifold, ...]
    ballast_g: float
    moments: Float
    slicer: str | None
    slices: int

    @property
    def centre_mm(self) -> tuple[float, float, float]:
        """The centre of mass of the print."""
        x, y, z = (float(value) for value in self.moments[1:] / self.moments[0])
        return x, y, z


@dataclass(frozen=True)
class AlternativeFill:
    """What the fill that was not chosen would weigh, estimated."""

    fill: str
    mass_g: float
