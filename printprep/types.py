"""The frozen values that pass from one room of printprep to the next.

Axis order is x, y, z; z is up; the bed is z = 0.  Lengths are mm, volumes mm³, masses g, angles
degrees, densities g/cm³.  Classes with an array or a mesh compare by identity (``eq=False``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int


Severity = Literal["info", "warning", "error"]
Unit = Literal["mm", "mm2", "mm3", "deg", "g", "percent"]  # of a finding's value and limit
SlicerName = Literal["prusa", "orca", "cura", "generic"]  # whose settings a file is written for
VaultRule = Literal["printer", "slicer"]  # whose overhang rule the vaults are built for
VaultChoice = Literal["printer", "slicer", "none"]
VAULT_CHOICES: tuple[VaultChoice, ...] = get_args(VaultChoice)
Rung = Literal["as-is", "union", "meshlab", "remesh"]


@dataclass(frozen=True)
class ReadNote:
    """What a reader changed, left out or could not tell, so that the user knows what was read.

    kind : "facet-count", the file's own count of its facets is wrong;  "cut-short", the rest of the
    file is missing;  "left-out", parts of a project that are not the model's shape;
    "read-together", several objects;  "subtracted", negative volumes;  "colours-lost", colours or
    paint that no part carries.
    """

    kind: Literal[
        "facet-count", "cut-short", "left-out", "read-together", "subtracted", "colours-lost"
    ]
    message: str
    fix: str | None = None


@dataclass(frozen=True)
class Material:
    """A material of a 3MF: its name, and its colour as "#RRGGBB" or "#RRGGBBAA"."""

    name: str
    colour: str


@dataclass(frozen=True)
class Style:
    """How one triangle is coloured and painted.

    material : None where the file names none.
    strokes : pairs of what is painted ("colour", "supports", "seam", "fuzzy") and the slicers'
    code of it, the same in PrusaSlicer, BambuStudio and OrcaSlicer: hexadecimal digits, the last
    first, that say how the triangle is split and what each piece is.
    """

    material: Material | None = None
    strokes: tuple[tuple[str, str], ...] = ()

    @property
    def splits(self) -> bool:
        """Whether a code splits its triangle: the lowest two bits of its last digit say how."""
        return self.whole != self

    @property
    def whole(self) -> Style:
        """The style without the codes that split its triangle."""
        whole = tuple(stroke for stroke in self.strokes if not int(stroke[1][-1], 16) & 3)
        return self if len(whole) == len(self.strokes) else Style(self.material, whole)


PLAIN = Style()


@dataclass(frozen=True, eq=False)
class Paint:
    """The colours and the paint of a mesh.

    styles : the first one is ``PLAIN``;  labels : (m,) the style of each face.
    """

    styles: tuple[Style, ...]
    labels: Int


@dataclass(frozen=True, eq=False)
class Model:
    """The triangles of the input, welded, in mm, z up, on the bed, centred on x = y = 0.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64, counter-clockwise seen from outside.
    placement : (4, 4) float64, file coordinates → these coordinates.
    name : the file's stem, never a path.
    notes : what the reader has to say;  paint : colours of the faces, None where there are none.
    blockers : where the file tells a slicer to make no supports, each as vertices (n, 3) in file
    coordinates and faces (m, 3).
    """

    vertices: Float
    faces: Int
    placement: Float
    name: str
    notes: tuple[ReadNote, ...] = ()
    paint: Paint | None = None
    blockers: tuple[tuple[Float, Int], ...] = ()


@dataclass(frozen=True)
class Repair:
    """How the model was made into a solid.

    rung : the kind of repair, from the least to the most invasive.
    actions : one short sentence each, in order; empty when rung is "as-is".
    moved_max_mm, moved_mean_mm : distance of the model's surface from the solid's, over samples.
    resolution_mm : cell size of the remesh, None on the other rungs.
    """

    rung: Rung
    actions: tuple[str, ...] = ()
    moved_max_mm: float = 0.0
    moved_mean_mm: float = 0.0
    resolution_mm: float | None = None


@dataclass(frozen=True, eq=False)
class Solid:
    """A valid manifold of positive volume, on the bed, in mm; shells inside it are real voids.

    placement : (4, 4) float64, file coordinates → these coordinates.
    kept : voids of the model that stay as cavities, with their vaults, as positive solids;
    filled : the solid with these voids filled, None where there are none.
    """

    manifold: Manifold
    name: str
    repair: Repair
    placement: Float
    kept: tuple[Manifold, ...] = ()
    filled: Manifold | None = None

    @property
    def whole(self) -> Manifold:
        """The solid with all its voids filled but those that hold a body of their own."""
        return self.manifold if self.filled is None else self.filled


@dataclass(frozen=True)
class ModelVoids:
    """What became of the sealed voids that the model brought; volumes in mm³, largest first.

    filled : voids that were filled;  kept : empty voids that stay, on request;
    holding : voids that stay because a body of their own is in them.
    """

    filled_mm3: tuple[float, ...] = ()
    kept_mm3: tuple[float, ...] = ()
    holding_mm3: tuple[float, ...] = ()


NO_VOIDS = ModelVoids()


@dataclass(frozen=True)
class MassProperties:
    """Integrals over a closed mesh at unit density.

    centre_mm : centre of mass (x, y, z);  inertia_mm5 : (3, 3) about the centre of mass, rows as
    tuples (multiply by g/mm³ for g·mm²).
    """

    volume_mm3: float
    centre_mm: tuple[float, float, float]
    inertia_mm5: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Finding:
    """One fact that the user should know.

    rule : stable id of its kind;  value, limit : numbers in ``unit``, or None.
    message : what is so;  fix : what to do about it, or None.
    at_mm : the place (x, y, z), or None;  area_mm2, volume_mm3 : its extent, or None.
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
    """A lean at which the part must stand: an angle, in every direction or toward one azimuth.

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

    origin_mm : (3,) centre of cell (0, 0, 0);  pitch_mm : edge length of a cubic cell;
    shape : (nx, ny, nz).
    """

    origin_mm: Float
    pitch_mm: float
    shape: tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Domain:
    """Which cells of a grid may change and which may not; arrays of shape ``grid.shape``.

    depth_mm : float64, signed distance to the model's surface, positive inside.  It is exact in a
    narrow band around the inner face of the wall, and elsewhere at least on the right side of it.
    shell, interior, base, free : bool, by cell centre (free = interior; the base is geometry).
    share : float64 in [0, 1], the share of each cell that lies deeper than the wall: the weight of
    a free voxel in the linear program.
    body : int64, −1 outside, else the disjoint body of the solid that the cell belongs to.
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
    """A filling's plane: {x : normal · x > offset_mm} stays empty, below it is filled."""

    normal: tuple[float, float, float]
    offset_mm: float


@dataclass(frozen=True)
class Certificate:
    """Proof that no lighter filling of the same voxels stands at the same lean.

    voxel_mass_g : mass of this filling;  bound_g : no filling weighs less (weak duality);
    gap : (voxel_mass_g − bound_g) / voxel_mass_g.
    """

    voxel_mass_g: float
    bound_g: float
    gap: float


@dataclass(frozen=True, eq=False)
class Density:
    """The optimized interior.

    rho : (nx, ny, nz) float64 over the whole model, 1 solid, 0 empty.
    planes : for each body the plane above which its cavity lies, or None if nothing is filled.
    Without planes, the cavity is where rho is below one half.
    aim_deg : the lean it is solved for, including the margin; None for the paper's objective.
    reachable_deg : largest lean any filling reaches, None if the requested lean is feasible.
    """

    rho: Float
    planes: tuple[Plane | None, ...] | None
    aim_deg: float | None
    reachable_deg: float | None
    certificate: Certificate | None


@dataclass(frozen=True, eq=False)
class Base:
    """New material around the feet: a seat (columns down to the bed) and a grown footprint.

    seat_mm : height of the seat;  growth_mm : how far the footprint is grown.
    """

    manifold: Manifold
    seat_mm: float
    growth_mm: float


@dataclass(frozen=True, eq=False)
class Part:
    """What is printed.

    manifold : the whole part, cavities as inverted shells.
    outside : the model with its base, and with those of its voids that hold a body.
    cavities : positive solids that are empty in it: those that were cut, and ``kept``.
    placement : (4, 4) float64, file coordinates → these coordinates.
    kept : the voids of the model that stay.
    """

    manifold: Manifold
    outside: Manifold
    cavities: tuple[Manifold, ...]
    base: Base | None
    name: str
    placement: Float
    kept: tuple[Manifold, ...] = ()


@dataclass(frozen=True, eq=False)
class Stability:
    """How a part stands on the bed; with several bodies, how the least stable one stands.

    support_polygon_mm : (k, 2) counter-clockwise hull of the contact, empty without contact.
    contact_area_mm2 : area of the contact itself, not of its hull.
    tilt_deg : the lean at which it tips over the weakest edge, negative if it tips by itself, None
    without contact.
    weakest_edge : index i of the edge from vertex i to i + 1;  weakest_azimuth_deg : its outward
    direction.
    """

    support_polygon_mm: Float
    contact_area_mm2: float
    centre_of_mass_mm: tuple[float, float, float]
    tilt_deg: float | None
    weakest_edge: int | None
    weakest_azimuth_deg: float | None


@dataclass(frozen=True)
class Settled:
    """A part that stood freely on the bed in simulation; with several bodies, the worst of them.

    rotation_deg : how far it turned in the end;  stands : whether it did not fall over.
    seconds : simulated time.
    """

    rotation_deg: float
    stands: bool
    seconds: float


@dataclass(frozen=True)
class Tipping:
    """A part that leans more and more toward one azimuth in simulation.

    azimuth_deg : the direction it leans toward, from +x counter-clockwise.
    computed_deg : its tilt angle in that direction, from support polygon and centre of mass;
    negative if it tips by itself.
    tips_deg : the lean at which its foot leaves the bed.
    falls_deg : the lean at which it falls over; more than tips_deg if a wing or a tail comes down
    on the bed and holds it.
    Both are 0 if it happens on the level bed, None if it does not up to the largest lean tried.
    """

    azimuth_deg: float
    computed_deg: float
    tips_deg: float | None
    falls_deg: float | None


@dataclass(frozen=True)
class Simulation:
    """A part in a physics engine: standing freely, then on a bed that tilts slowly.

    tippings : one for each azimuth tried, none for a part without contact.
    """

    settled: Settled
    tippings: tuple[Tipping, ...]


@dataclass(frozen=True)
class Supports:
    """The vaults that carry the ceilings from inside, in the whole hollowable volume.

    rule : the overhang rule that they are built for.
    added_mm3 : their volume; where ballast fills it too, nothing is counted twice.
    unsupported_mm2, islands : what that rule still finds.
    """

    rule: VaultRule
    capitals: int
    columns: int
    added_mm3: float
    unsupported_mm2: float
    islands: int


@dataclass(frozen=True)
class Drain:
    """A round hole from a cavity to the outside.

    role : an outlet empties a pool, a vent lets air in;  cavity : index of the part's cavity.
    centre_mm : the middle of its mouth, on the outside;  axis : unit vector, outward.
    length_mm : length of its axis inside material.
    """

    role: Literal["outlet", "vent"]
    cavity: int
    centre_mm: tuple[float, float, float]
    axis: tuple[float, float, float]
    diameter_mm: float
    length_mm: float


@dataclass(frozen=True)
class Drainage:
    """How a part drains while it stands on the plate.

    drains : cavity by cavity, outlets first.
    filled_mm3 : volume of cavity floors that are filled, where a pool would stand below every
    outlet.
    closed_mm3 : volumes of the cavities that no hole drains; they are filled.
    """

    drains: tuple[Drain, ...]
    filled_mm3: float
    closed_mm3: tuple[float, ...]


@dataclass(frozen=True)
class Advice:
    """What would make a lean feasible that is out of reach.

    growth_mm : least growth of the footprint, in steps of half a millimetre, at which some filling
    reaches it; None if no growth up to 30 mm is enough.
    poses_deg : tilt angles of the solid in its stable poses, the steadiest first.
    """

    growth_mm: float | None
    poses_deg: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Infill:
    """The slicer's sparse infill inside a part, and the ballast that prints dense.

    pattern, density, perimeters, layers : the object's settings in the file.
    ballast : solids that cover what prints dense, in the part's coordinates;  ballast_g : the mass
    that they add to the sparse print.
    moments : (4,) volume in mm³ of all that is deposited, and its first moments x, y, z in mm⁴.
    slicer : name and version of the slicer whose G-code was weighed, None if the print is
    estimated;  slices : how often it ran.
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
        """Centre of mass (x, y, z) of the print."""
        x, y, z = (float(value) for value in self.moments[1:] / self.moments[0])
        return x, y, z


@dataclass(frozen=True)
class AlternativeFill:
    """The mass with the fill that was not chosen, estimated."""

    fill: str
    mass_g: float
