"""Describes one body on a bed for MuJoCo: its contact points, its mass, and the units.

Shape.  A convex body meets a plane at its vertices, so each vertex of the collision hull is a
contact point of its own.  (MuJoCo's contact of a mesh with a plane keeps three or four points,
depending on the release: an outline of many corners would stand on a few of them and tip too
early.)  The hull is that of the outside above the middle of the first layer, with the section there
extended down to the bed: the print is flat at the bottom, while a rounded foot of the mesh would
roll.

Mass.  Centre and inertia are those of the hollow body, not of the hull.  Its density changes
nothing: gravity, friction and inertia forces all grow with the mass.

Units.  Length is the body's radius of gyration, mass its own mass, time the second.  So the mass
matrix is close to the identity for a chess pawn and a garden gnome, and the solver's tolerances
mean the same for both.  With acceleration-based contacts of impedance d and time constant t the
bed gives way by about (1 − d) g t², here 0.016 µm: little against a foot of a millimetre, whose
tilt angle stays exact; friction creeps by nanometres a second.

Source: MuJoCo documentation, "Computation" (solver parameters, impedance).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.mesh.measure import arrays, mass_properties
from printprep.stand.contact import contact_of, section_at_bed

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

GRAVITY_MM_S2 = 9810.0
# The bed tilts up to this angle; friction holds well beyond it.
MOST_LEAN_DEG = 80.0
FRICTION = 1.5 * float(np.tan(np.radians(MOST_LEAN_DEG)))

_IMPEDANCE = 0.9999
_TIME_CONSTANT_STEPS = 4  # MuJoCo wants at least two
# How far the outline of the foot may move when corners are removed, as a share of the body's size.
_FOOT_TOLERANCE = 5e-4
# The hull keeps its outermost vertex in these directions: angles from straight down in degrees,
# and a number of azimuths; densest where a body that starts to tip touches the bed next.
_RINGS_DEG = (0.5, 1, 2, 3, 4.5, 6, 8, 10, 12.5, 15, 18, 21, 25, 30, 40, 50, 65, 80, 100, 130, 160)
_AROUND = 36
_POINT_RADIUS = 1e-6  # of the radius of gyration


@dataclass(frozen=True, eq=False)
class Scene:
    """A body, ready for the simulation.

    points : (n, 3) contact points relative to the centre of mass;  height : of that centre above
    the bed;  inertia : (3, 3) about it, for mass 1;  all in units of ``unit_mm``, the radius of
    gyration.  centre_mm : (3,) centre of mass, in the coordinates of the part.
    """

    points: Float
    height: float
    inertia: Float
    unit_mm: float
    centre_mm: Float

    @property
    def gravity(self) -> float:
        """Units of length per second squared."""
        return GRAVITY_MM_S2 / self.unit_mm


def scene_of(body: Manifold, first_layer_mm: float) -> Scene:
    """A single body, with its voids, as it stands on the bed.

    A body without contact is put on its lowest point.
    """
    mass = mass_properties(body)
    inertia = np.array(mass.inertia_mm5) / mass.volume_mm3
    unit_mm = float(np.sqrt(np.trace(inertia) / 2))
    points = _hull_points(body, first_layer_mm)
    centre = np.array(mass.centre_mm)
    bed = float(points[:, 2].min())
    return Scene(
        points=(points - centre) / unit_mm,
        height=(centre[2] - bed) / unit_mm,
        inertia=inertia / unit_mm**2,
        unit_mm=unit_mm,
        centre_mm=centre,
    )


def compiled(scene: Scene, step_s: float) -> Any:
    """The scene as a MuJoCo model (``mujoco.MjModel``): one free body over the plane z = 0."""
    import mujoco

    return mujoco.MjModel.from_xml_string(_mjcf(scene, step_s))


def _hull_points(body: Manifold, first_layer_mm: float) -> Float:
    """(k, 3) mm, corners of the foot on the bed and outermost vertices of the hull above it."""
    from manifold3d import CrossSection, Manifold

    vertices, _ = arrays(body)
    size = float(np.ptp(vertices, axis=0).max())
    contact = contact_of(section_at_bed(body, first_layer_mm))
    if contact is None:
        foot = np.zeros((0, 3))
    else:
        outline = CrossSection([contact.polygon_mm]).simplify(_FOOT_TOLERANCE * size)
        flat = np.asarray(outline.to_polygons()[0])
        foot = np.column_stack([flat, np.zeros(len(flat))])
        vertices = vertices[vertices[:, 2] > first_layer_mm / 2]
    points = np.concatenate([vertices, foot])
    corners, _ = arrays(Manifold.hull_points(points))
    outermost = np.unique(np.argmax(corners @ _directions().T, axis=0))
    upper = corners[outermost]
    return np.concatenate([foot, upper[upper[:, 2] > 0] if len(foot) else upper])


def _directions() -> Float:
    """(k, 3) unit vectors in rings around straight down."""
    down, around = np.meshgrid(
        np.radians(_RINGS_DEG), np.arange(_AROUND) * (2 * np.pi / _AROUND), indexing="ij"
    )
    rings = [np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), -np.cos(down)]
    return np.stack(rings, axis=-1).reshape(-1, 3)


def _mjcf(scene: Scene, step_s: float) -> str:
    """The scene in MJCF, with all digits of its numbers, so that every run has the same model."""
    from xml.etree import ElementTree as ET

    root = ET.Element("mujoco")
    ET.SubElement(root, "compiler", boundmass="0", boundinertia="0")
    ET.SubElement(
        root,
        "option",
        timestep=repr(step_s),
        gravity=_numbers([0.0, 0.0, -scene.gravity]),
        integrator="implicitfast",
        cone="elliptic",
        impratio="100",
        solver="Newton",
        iterations="100",
        tolerance="1e-12",
    )
    default = ET.SubElement(root, "default")
    ET.SubElement(
        default,
        "geom",
        condim="3",
        friction=_numbers([FRICTION, 0.0, 0.0]),
        solref=_numbers([_TIME_CONSTANT_STEPS * step_s, 1.0]),
        solimp=_numbers([_IMPEDANCE, _IMPEDANCE, 1.0]),
    )
    world = ET.SubElement(root, "worldbody")
    ET.SubElement(world, "geom", type="plane", size="0 0 1")
    body = ET.SubElement(world, "body", name="body", pos=_numbers([0.0, 0.0, scene.height]))
    ET.SubElement(body, "freejoint")
    xx, yy, zz = np.diag(scene.inertia)
    xy, xz, yz = scene.inertia[0, 1], scene.inertia[0, 2], scene.inertia[1, 2]
    ET.SubElement(
        body, "inertial", pos="0 0 0", mass="1", fullinertia=_numbers([xx, yy, zz, xy, xz, yz])
    )
    for point in np.add(scene.points, [0.0, 0.0, _POINT_RADIUS]):
        ET.SubElement(body, "geom", type="sphere", size=repr(_POINT_RADIUS), pos=_numbers(point))
    return ET.tostring(root, encoding="unicode")


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)
