"""Parts whose figures are known by hand, and the values that the rooms pass around made of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from manifold3d import Manifold

from printprep.check import CheckContext, context_of_solid, run_rules
from printprep.mesh.measure import arrays
from printprep.mesh.quantize import quantized
from printprep.profiles import Profile, load_profile
from printprep.result import HollowResult
from printprep.stand.stability import stability
from printprep.types import (
    Base,
    Certificate,
    Density,
    Lean,
    Model,
    Part,
    Repair,
    Solid,
)


def box(size: float, height: float | None = None, z: float = 0.0) -> Manifold:
    """A box centred on the z axis, its underside at ``z``."""
    tall = size if height is None else height
    return Manifold.cube((size, size, tall)).translate((-size / 2, -size / 2, z))


def hollow_box(size: float, wall: float) -> Manifold:
    return box(size) - box(size - 2 * wall, z=wall)


def roofed(deg: float, size: float = 20.0, wall: float = 2.0) -> Manifold:
    """A block with a cavity under a pyramid whose sides lean ``deg`` from the vertical."""
    rise = (size / 2 - wall) / math.tan(math.radians(deg))
    return box(size, wall + rise + wall) - roofed_cavity(deg, size, wall)


def roofed_cavity(deg: float, size: float = 20.0, wall: float = 2.0) -> Manifold:
    """The cavity of ``roofed``."""
    half = size / 2 - wall
    rise = half / math.tan(math.radians(deg))
    floor = [(x, y, wall) for x in (-half, half) for y in (-half, half)]
    return Manifold.hull_points(np.array([*floor, (0.0, 0.0, wall + rise)]))


def context(part: Manifold, **changes: object) -> CheckContext:
    """A part as a file that came so, with any circumstance changed by name."""
    plain = context_of_solid(quantized(part), stability(part, 0.2), Lean(10.0), Repair("as-is"))
    return replace(plain, **changes)


def hollow_result(
    size: float = 20.0,
    wall: float = 2.0,
    *,
    profile: str | Profile = "fdm-pla-0.4",
    with_base: bool = False,
    name: str = "block",
    **changes: object,
) -> HollowResult:
    """A cube with a cube cavity, as the pipeline would hand it over.

    At 20 mm, wall 2 mm, PLA 1.24 g/cm³: solid 8 cm³ = 9.92 g, cavity 16³ = 4096 mm³, part
    3904 mm³ = 4.84096 g, tilt angle atan(10/10) = 45°.  The base is a plate around the foot, 2 mm
    wide and 1 mm high.
    """
    settings = load_profile(profile)
    grams = settings.material.density_g_cm3 / 1000
    solid, cavity = box(size), box(size - 2 * wall, z=wall)
    plate = box(size + 4, 1) - box(size)
    outside = solid + plate if with_base else solid
    placement = np.eye(4)
    placement[:3, 3] = (1.5, 0.0, -2.0)
    part = Part(
        manifold=quantized(outside - cavity),
        outside=outside,
        cavities=(cavity,),
        base=Base(plate, seat_mm=1.0, growth_mm=2.0) if with_base else None,
        name=name,
        placement=placement,
    )
    standing = stability(part.manifold, settings.printer.first_layer_mm)
    examined = CheckContext(
        part.manifold, outside, (cavity,), standing, Lean(10.0), Repair("as-is"), hollowed=True
    )
    vertices, faces = arrays(solid)
    result = HollowResult(
        model=Model(vertices, faces, placement, name),
        solid=Solid(solid, name, Repair("as-is"), placement),
        part=part,
        profile=settings,
        density=Density(
            rho=np.zeros((2, 2, 2)),
            planes=(None,),
            aim_deg=10.5,
            reachable_deg=None,
            certificate=Certificate(voxel_mass_g=4.9, bound_g=4.9 - 1e-9, gap=1e-9 / 4.9),
        ),
        stability_solid=stability(solid, settings.printer.first_layer_mm),
        stability=standing,
        lean=Lean(10.0),
        solid_mass_g=solid.volume() * grams,
        mass_g=part.manifold.volume() * grams,
        wall_min_mm=wall,
        findings=run_rules(examined, settings),
        seconds={"read": 0.0123456, "solve": 1.0},
    )
    return replace(result, **changes)
