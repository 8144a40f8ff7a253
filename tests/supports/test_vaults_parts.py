"""The parts of vaults: samples, capitals, columns, feet, solids, each by what it must hold."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box

from printprep.errors import GeometryError, UsageError
from printprep.profiles import load_profile
from printprep.supports.capitals import Capitals, cover
from printprep.supports.ceiling import MOST_SAMPLES, SPACING_MM, ceiling_samples, spacing_of
from printprep.supports.column_feet import set_feet
from printprep.supports.column_forest import Forest
from printprep.supports.columns import raise_columns
from printprep.supports.distance_to_footing import DistanceToFooting
from printprep.supports.gussets import gussets
from printprep.supports.inside_lookup import LOOKUP_MM, InsideLookup
from printprep.supports.member_sizes import TIME_MM3_PER_MM, MemberSizes, built_for
from printprep.supports.set_cover import OVERLAP_MM, REACH_MM, RISE_MM, SetCover
from printprep.supports.solids import COLUMN_SIDES, INTO_MM, Frustum, columns, section, united

MEMBERS = MemberSizes(theta_deg=35.5, lean_deg=38.0, thickness_mm=1.2, slenderness=12.0)


def hollowable_volume() -> Manifold:
    """A box of air, 20 mm wide and 15 mm high, its floor at 2 mm."""
    return box(20, 20, 15).translate((0, 0, 2))


def inscribed_radius(polygon: np.ndarray) -> float:
    """Of the largest circle around the origin within a convex polygon (n, 2)."""
    way = np.roll(polygon, -1, axis=0) - polygon
    turn = polygon[:, 0] * way[:, 1] - polygon[:, 1] * way[:, 0]
    return float((turn / np.hypot(way[:, 0], way[:, 1])).min())


def built(void: Manifold) -> tuple[np.ndarray, Forest]:
    samples = ceiling_samples(void, 40.0)
    lookup = InsideLookup.of(void, LOOKUP_MM)
    nodes = cover(samples, MEMBERS, SPACING_MM**2, lookup).node_mm
    forest = Forest()
    footings = DistanceToFooting.of(lookup, MEMBERS, float(nodes[:, 2].max()))
    raise_columns(nodes, lookup, footings, MEMBERS, forest)
    set_feet(forest, lookup, MEMBERS)
    return nodes, forest


def test_a_flat_ceiling_is_sampled_everywhere():
    samples = ceiling_samples(hollowable_volume(), 40.0)
    assert len(samples) * SPACING_MM**2 == pytest.approx(400, rel=0.03)
    assert np.ptp(samples[:, 2]) < 1e-9
    assert samples[0, 2] == pytest.approx(17.0)


def test_a_vast_ceiling_has_no_more_samples_than_allowed():
    assert spacing_of(hollowable_volume(), 40.0) == SPACING_MM
    hall = Manifold.cube((500, 400, 10))
    spacing_mm = spacing_of(hall, 40.0)
    assert spacing_mm == pytest.approx(math.sqrt(0.4))
    assert len(ceiling_samples(hall, 40.0, spacing_mm)) == pytest.approx(MOST_SAMPLES, rel=0.01)


def test_a_ceiling_beyond_any_printer_is_told_at_once():
    with pytest.raises(GeometryError, match=r"measure 15000 cm²; .* 2500 cm²") as told:
        spacing_of(Manifold.cube((1500, 1000, 10)), 40.0)
    assert "--vaults none" in told.value.hint


@pytest.mark.parametrize(("deg", "sampled"), [(39, False), (41, True)])
def test_a_slope_is_sampled_on_one_side_of_the_angle(deg, sampled):
    cone = Manifold.cylinder(8 / math.tan(math.radians(deg)), 8, 0, 128)
    assert (len(ceiling_samples(cone, 40.0)) > 0) is sampled


def test_of_a_ball_the_cap_is_sampled():
    """n_z > sin θ on a sphere is a cap of radius R cos θ, seen from above."""
    samples = ceiling_samples(Manifold.sphere(10, 256), 40.0)
    area = math.pi * (10 * math.cos(math.radians(40))) ** 2
    assert len(samples) * SPACING_MM**2 == pytest.approx(area, rel=0.03)


def carried(samples: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Whether each sample is within reach of a funnel on one of the nodes."""
    d = np.hypot(*(samples[:, None, :2] - nodes[None, :, :2]).transpose(2, 0, 1))
    rise = samples[:, None, 2] - nodes[None, :, 2]
    reach = np.minimum(MEMBERS.radius_mm + rise * MEMBERS.tan - OVERLAP_MM, REACH_MM)
    return ((rise >= -1e-9) & (rise <= RISE_MM) & (d <= reach + 1e-6)).any(axis=1)


def test_capitals_carry_every_sample():
    ball = Manifold.sphere(10, 128)
    samples = ceiling_samples(ball, 40.0)
    capitals = cover(samples, MEMBERS, SPACING_MM**2, InsideLookup.of(ball, LOOKUP_MM))
    assert carried(samples, capitals.node_mm).all()


@pytest.mark.parametrize("seed", [0, 6])
def test_capitals_carry_every_sample_of_a_jagged_ceiling(seed):
    """Groups over its steps may grow wider than a funnel reaches."""
    chance = np.random.default_rng(seed)
    x, y = np.meshgrid(*[SPACING_MM * np.arange(60)] * 2, indexing="ij")
    z = np.zeros(x.shape)
    for height, along, across, phase in chance.uniform([4, 0.2, 0.2, 0], [9, 1.2, 1.2, 6], (3, 4)):
        z += height * np.sin(along * x + across * y + phase)
    samples = np.stack([x, y, z], axis=-1)[chance.random(x.shape) < 0.7]
    below = InsideLookup.of(box(40, 40, 60).translate((0, 0, -30)), LOOKUP_MM)
    assert carried(samples, cover(samples, MEMBERS, SPACING_MM**2, below).node_mm).all()


def test_of_two_sets_each_gets_its_highest_funnel():
    """A single sample is carried from where it is; two, farther apart than a disc, from below."""
    far = 2 * (MEMBERS.radius_mm - OVERLAP_MM) + 1.0
    points = np.array([[5.0, 5.0, 9.0], [0.0, 0.0, 4.0], [far, 0.0, 4.0]])
    sets = SetCover.of(points, np.array([1, 2]))
    nodes = sets.highest(np.array([[5.0, 5.0], [far / 2, 0.0]]), MEMBERS, 12)
    assert nodes[0] == pytest.approx((5, 5, 9))
    assert nodes[1] == pytest.approx((far / 2, 0, 4 - 0.5 / MEMBERS.tan))
    assert sets.tops_mm.tolist() == [9.0, 4.0]


def test_no_funnel_carries_farther_than_it_may():
    for beyond in ([2 * REACH_MM + 0.1, 0.0, 0.0], [0.0, 0.0, RISE_MM + 0.1]):
        sets = SetCover.of(np.array([[0.0, 0.0, 0.0], beyond]), np.array([2]))
        node = sets.highest(np.array([[beyond[0] / 2, 0.0]]), MEMBERS, 6)
        assert np.isinf(sets.volume_mm3(node, MEMBERS, 0.09)).all()


def test_a_wide_flat_ceiling_takes_few_funnels():
    """Discs cover a plane at best 1.21-fold (Kershner 1939); these need only carry a lattice."""
    hall = box(30, 30, 15)
    samples = ceiling_samples(hall, 40.0)
    capitals = cover(samples, MEMBERS, SPACING_MM**2, InsideLookup.of(hall, LOOKUP_MM))
    rise = capitals.top_mm - capitals.node_mm[:, 2]
    discs = math.pi * (MEMBERS.radius_mm + rise * MEMBERS.tan - OVERLAP_MM) ** 2
    assert 900 < discs.sum() < 1.3 * 900


def test_lines_of_a_lattice_know_the_inside_at_every_height():
    """Of a bubble in a ball: the same as points one by one, and nothing beyond."""
    void = Manifold.sphere(6, 48) - Manifold.sphere(3, 48)
    lookup, z = InsideLookup.of(void, 0.35), np.linspace(-8, 8, 40)
    x, y = (lookup.low_mm[k] + 0.35 * np.arange(n) for k, n in enumerate(lookup.shape))
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.stack(np.broadcast_arrays(*places.T[..., None], z), axis=-1)
    at = lookup.at_heights(z)
    assert (at[:-1] == lookup.contains(points)).all()
    assert at.any() and not at[-1].any()
    assert (lookup.nearest(places) == np.arange(len(places))).all()
    assert lookup.nearest(lookup.low_mm - [0.2, 0.0]) == -1


def test_in_the_middle_of_a_box_the_way_down_is_straight():
    """To the highest cell in the floor; in the shell and beyond there is none to go."""
    footings = DistanceToFooting.of(InsideLookup.of(hollowable_volume(), 0.35), MEMBERS, 15.0)
    cells = np.arange(footings.length_mm.shape[2])
    z = footings.low_mm[2] + footings.cell_mm[2] * cells
    way = footings.way_mm(np.column_stack([np.zeros((len(z), 2)), z]))
    assert way == pytest.approx(np.where(z > 2, z - z[z < 2].max(), 0))
    assert footings.way_mm(np.array([[4.0, 0.0, -5.0], [90.0, 0.0, -5.0]])).tolist() == [0, 0]


def test_low_cavities_get_more_and_smaller_funnels():
    """A column costs little there."""
    tops = []
    for height in (3.0, 30.0):
        hall = box(30, 30, height)
        samples = ceiling_samples(hall, 40.0)
        capitals = cover(samples, MEMBERS, SPACING_MM**2, InsideLookup.of(hall, LOOKUP_MM))
        tops.append(capitals.top_mm - capitals.node_mm[:, 2])
    assert len(tops[0]) > len(tops[1])
    assert tops[0].mean() < tops[1].mean()


def test_headroom_is_the_depth_below_inside():
    slab = box(4, 4, 1).translate((0, 0, 6))
    lookup = InsideLookup.of(box(10, 10, 12).translate((0, 0, 2)) - slab, LOOKUP_MM)
    points = np.array([[3.0, 3, 10], [0, 0, 10], [0, 0, 6.5], [0, 0, 5], [8, 0, 5], [0, 0, 20]])
    assert lookup.headroom_mm(points) == pytest.approx([8, 3, 0, 3, 0, 0])


def capital(lean: float) -> tuple[Capitals, Forest]:
    """One, 10 mm up, on a column that goes down 8 mm and ``lean`` times as far along x."""
    node = np.array([0.0, 0.0, 10.0])
    forest = Forest()
    forest.stand(forest.plant(node), node + 8 * np.array([lean, 0.0, -1.0]))
    return Capitals(node[None], np.array([12.0])), forest


def beside(out: float, rise: float = 1.5) -> np.ndarray:
    """Points over the +x side of that capital, so far beyond it."""
    d = MEMBERS.radius_mm + rise * MEMBERS.tan + out
    turn = np.radians([-4.0, 0.0, 4.0])
    return np.column_stack([d * np.cos(turn), d * np.sin(turn), np.full(3, 10.0 + rise)])


@pytest.mark.parametrize("lean", [0.0, 0.4, 0.7])
def test_a_gusset_reaches_what_a_capital_just_misses(lean):
    points = beside(0.2)
    (gusset,), left = gussets(points, *capital(lean), MEMBERS)
    assert len(left) == 0
    solid = united([gusset])
    low = solid.bounding_box()[2]
    assert 9 < low < 10  # from a little under the node
    for z in np.linspace(low, points[0, 2] + 0.2, 9):  # a disc as wide as the column fits anywhere
        assert not solid.slice(z + 1e-6).offset(0.01 - gusset.across_mm / 2).is_empty()
    for x, y in points[:, :2]:
        probe = Manifold.cylinder(0.02, 0.05, 0.05, 8).translate((x, y, points[0, 2] + 0.05))
        assert (probe - solid).is_empty()
    normals = solid.to_mesh64()
    corners = normals.vert_properties[normals.tri_verts.astype(np.int64)][:, :, :3]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    side = np.hypot(across[:, 0], across[:, 1])
    hanging = (across[:, 2] < 0) & (corners[..., 2].max(axis=1) > low + 1e-6)
    assert (-across[hanging, 2] <= side[hanging] / MEMBERS.tan * 1.05).all()


def test_what_is_too_far_from_any_capital_gets_no_gusset():
    found, left = gussets(beside(0.6), *capital(0.0), MEMBERS)
    assert not found and len(left) == 3


def test_a_column_that_leans_away_too_far_carries_no_gusset():
    found, left = gussets(beside(0.2), *capital(-0.7), MEMBERS)
    assert not found and len(left) == 3


def test_without_capitals_there_are_no_gussets():
    found, left = gussets(beside(0.2), Capitals.none(), Forest(), MEMBERS)
    assert not found and len(left) == 3


@pytest.mark.parametrize("length", [5.0, 14.4, 40.0, 90.0])
def test_a_column_sways_no_more_than_the_slenderest_thin_one(length):
    """The end of a cantilever gives way by ℓ³ / t⁴."""
    thickness = 2 * float(MEMBERS.across_mm(np.array(length)))
    allowed = (MEMBERS.slenderness * 1.2) ** 3 / 1.2**4
    assert length**3 / thickness**4 <= allowed * (1 + 1e-9)


def test_the_slenderness_is_the_profile_s():
    profiles = [load_profile("fdm-pla-0.4", {"column_slenderness": s}) for s in (6, 24)]
    thick, thin = (MemberSizes.of(p, built_for(p, "printer")) for p in profiles)
    length = np.array(20.0)
    assert thick.across_mm(length) == pytest.approx(0.6 * (20 / (6 * 1.2)) ** 0.75)
    assert thin.across_mm(length) == 0.6
    with pytest.raises(UsageError, match="column_slenderness has no meaning for resin"):
        load_profile("resin-standard", {"column_slenderness": 12})


@given(st.floats(0, 60), st.floats(0, 60))
def test_a_column_costs_its_frustums_and_its_time(above, length):
    share = np.linspace(0, 1, 4001)
    half = MEMBERS.across_mm(above + share * length)
    expected = np.trapezoid(math.pi * half**2, share * length)
    expected += TIME_MM3_PER_MM * length
    assert MEMBERS.cost_mm3(above, length) == pytest.approx(expected, rel=1e-4, abs=1e-9)


def test_a_frustum_holds_its_discs():
    solid = united([Frustum.of_discs(np.array([0, 0, 0.0]), 2.0, np.array([1, 0, 3.0]), 1.0)])
    lower, upper = solid.slice(1e-6).area(), solid.slice(3 - 1e-6).area()
    assert math.pi * 4 < lower < 1.03 * math.pi * 4
    assert math.pi < upper < 1.03 * math.pi


@pytest.mark.parametrize("lean_deg", [0.0, 20.0, 38.0])
def test_a_level_section_is_round_across_the_axis(lean_deg):
    way = np.array([0.6, 0.8, 0.0]) * math.tan(math.radians(lean_deg)) - [0, 0, 1]
    corners = section(way, 0.6)
    axis = way / np.linalg.norm(way)
    across = corners - np.outer(corners @ axis, axis)
    assert np.linalg.norm(across, axis=1) == pytest.approx(0.6 / math.cos(math.pi / COLUMN_SIDES))
    longest = np.hypot(corners[:, 0], corners[:, 1]).max()
    assert (
        longest <= 0.6 / math.cos(math.pi / COLUMN_SIDES) / math.cos(math.radians(lean_deg)) + 1e-9
    )


def test_where_two_columns_meet_the_lower_one_holds_both():
    forest = Forest()
    one, other, met = (forest.plant(np.array(p)) for p in ([3.0, 0, 9], [0.0, 3, 9], [0.0, 0, 5]))
    forest.lean_on(one, met, 5.0)
    forest.lean_on(other, met, 5.0)
    forest.stand(met, np.array([0.0, 0.0, 0.0]))
    upper, upper_too, trunk = (united([piece]) for piece in columns(forest, MEMBERS))
    below = trunk.slice(5 - 1e-6)
    for column in (upper, upper_too):
        assert (column.slice(5 + 1e-6) - below).area() < 0.01  # else it is 0.1


def test_columns_lean_within_the_limit_thicken_downward_and_stand():
    void = hollowable_volume()
    nodes, forest = built(void)
    assert len(columns(forest, MEMBERS)) >= len(nodes)
    for index in range(len(forest)):
        lower = forest.down[index]
        if lower < 0:
            assert index in forest.stands
            continue
        way = forest.place(lower) - forest.place(index)
        assert np.hypot(way[0], way[1]) <= -way[2] * MEMBERS.lean_tan * (1 + 1e-9) + 1e-9
        length = float(np.linalg.norm(way))
        if lower not in forest.stands:
            assert forest.above_mm[lower] >= forest.above_mm[index] + length - 1e-6
    floor_or_wall = np.array([forest.place(index) for index in forest.stands])
    outside = (np.abs(floor_or_wall[:, :2]).max(axis=1) > 10) | (floor_or_wall[:, 2] < 2)
    assert outside.all()


def test_columns_are_thick_across_their_axis_and_slender_within_bounds():
    _, forest = built(hollowable_volume())
    uppers = [index for index in range(len(forest)) if forest.down[index] >= 0]
    places = np.array([forest.place(index) for index in range(len(forest))])
    solids = [united([column]) for column in columns(forest, MEMBERS)]
    order = [i for i in np.argsort(-places[:, 2], kind="stable").tolist() if i in set(uppers)]
    for index, solid in zip(order, solids, strict=True):
        way = places[forest.down[index]] - places[index]
        fall, length = -way[2], np.linalg.norm(way)
        for share in (0.1, 0.9):
            height = float(places[index][2] - share * fall)
            level = np.concatenate(solid.slice(height).to_polygons())
            axis = places[index][:2] + share * way[:2]
            aside = level - axis
            if np.hypot(way[0], way[1]) > 0:  # the ellipse, seen along the axis
                along = way[:2] / np.hypot(way[0], way[1])
                toward = aside @ along
                aside = aside + np.outer(toward * (fall / length - 1), along)
            across = 2 * inscribed_radius(aside)
            above = forest.above_mm[index] + share * length
            assert across >= 1.2 - 1e-6
            # Between its ends a column is straight, where the law bends by some hundredths.
            assert across >= 0.97 * 2 * MEMBERS.across_mm(above) - 1e-6


def test_columns_hang_together_and_reach_their_shell():
    void = hollowable_volume()
    _, forest = built(void)
    solids = united(columns(forest, MEMBERS))
    shell = box(30, 30, 30).translate((0, 0, -5)) - void
    assert len((solids + shell).decompose()) == 2  # the outside, and the void around the columns
    assert INTO_MM < 0.05
