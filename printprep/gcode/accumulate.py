"""Adds up what the pieces of a G-code deposit, by feature, extruder and unit of filament.

The features to leave out and the weight of the filament apply at the end: slicers write the
figures of the filament after the moves.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.gcode.balance import balance_of
from printprep.gcode.bead_sizes import BeadSizes
from printprep.gcode.bodies import Bodies
from printprep.gcode.cavities import Cavities
from printprep.gcode.features import CUSTOM, SUPPORT, UNLABELLED
from printprep.gcode.filament import Filament, Key
from printprep.gcode.first_layer import SAME_LAYER_MM, LowestBeads
from printprep.gcode.lexer import read_rows
from printprep.gcode.modal_state import ModalState, StateTracker
from printprep.gcode.moments import COLUMNS, inertia_about_centre, moments_of, sums_by
from printprep.gcode.paths import Stretches, Walker
from printprep.gcode.printed import Balance, Printed
from printprep.gcode.slicer_summary import summary_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

_FIRST_LAYER_MAX = 1_000_000  # lines; a bed of 400 mm full of 0.4 mm lines holds far fewer
_WIDTH_MAX_MM = 50.0


class Accumulator:
    """Sums over the pieces of the file so far.

    cavities : solids that should stay empty;  bodies : solids that do not touch; both in the
    coordinates of the G-code.  Filament is in the unit of E until ``result``.
    """

    def __init__(
        self,
        tracker: StateTracker,
        name: str,
        cavities: Sequence[Manifold],
        bodies: Sequence[Manifold],
    ) -> None:
        self._tracker = tracker
        self._name = name
        self._cavities = Cavities(cavities) if cavities else None
        self._bodies = Bodies(bodies) if len(bodies) > 1 else None
        self._count = len(bodies)
        self._walker = Walker(name)
        self._bead_sizes = BeadSizes(tracker)
        self._line = 1
        self._motion = -1
        self._keys: dict[Key, int] = {}
        self._sums = np.zeros((0, COLUMNS))
        self._inside = np.zeros(0)
        self._low = np.zeros((0, 3))
        self._high = np.zeros((0, 3))
        self._lowest: list[LowestBeads] = []
        self._at: dict[Key, tuple[float, float, float]] = {}

    def add(self, piece: bytes) -> None:
        """Add the next piece of the file, which ends with the end of a line."""
        rows = read_rows(piece, self._name, self._line, self._motion)
        first_line = self._line
        self._line += rows.lines
        self._motion = rows.motion
        states, changed_at, became = self._tracker.feed_all(rows.others, first_line)
        changes = np.searchsorted(np.array(changed_at, dtype=np.int64), rows.line)
        state_of_row = np.array([0, *became], dtype=np.int64)[changes]
        for made in self._walker.walk(rows, state_of_row, states, first_line):
            self._deposit(made, states)

    def _deposit(self, made: Stretches, states: Sequence[ModalState]) -> None:
        group = self._groups(made, states)
        self._add_groups()
        width, height = self._bead_sizes.of(made, states)
        axis_start, axis_end = made.start_mm.copy(), made.end_mm.copy()
        axis_start[:, 2] -= height / 2
        axis_end[:, 2] -= height / 2
        wide = np.nan_to_num(width)
        moments = moments_of(axis_start, axis_end, made.filament, wide, height)
        self._sums += sums_by(group, moments, len(self._sums))
        self._widen_bounds(group, axis_start, axis_end, wide, height)
        top = made.end_mm[:, 2]
        beads = np.column_stack([made.start_mm[:, :2], made.end_mm[:, :2], top, width, height])
        # A width that the file does not give follows from the filament, whose diameter is known at
        # the end: until then the column holds minus the filament per mm.
        length = np.linalg.norm(beads[:, 2:4] - beads[:, :2], axis=1)
        missing = np.isnan(width)
        beads[missing, 5] = -(made.filament / np.maximum(length, 1e-9))[missing]
        for index in np.unique(group):
            self._lowest[index].add(beads[group == index])
            if self._lowest[index].count > _FIRST_LAYER_MAX:
                raise InputError(
                    f"{self._name} prints more than {_FIRST_LAYER_MAX} lines into its first layer; "
                    "no more are read.",
                    "Slice the model again, with a coarser resolution.",
                )
        if self._cavities is not None:
            deeper = np.where(missing, height, wide) / 2
            share = self._cavities.share_inside(axis_start, axis_end, deeper)
            self._inside += np.bincount(group, share * made.filament, minlength=len(self._sums))
            keys = list(self._keys)
            for index in np.unique(group[share > 0]):
                first = np.flatnonzero((group == index) & (share > 0))[0]
                x, y, z = (axis_start[first] + axis_end[first]) / 2
                self._at.setdefault(keys[index], (float(x), float(y), float(z)))

    def _widen_bounds(
        self, group: Int, start: Float, end: Float, width: Float, height: Float
    ) -> None:
        """Widen the bounds of groups by beads: group (n,), axes (n, 3) mm, widths, heights (n,)."""
        half = np.column_stack([width, width, height]) / 2
        low, high = np.minimum(start, end) - half, np.maximum(start, end) + half
        for index in np.unique(group):
            mine = group == index
            self._low[index] = np.minimum(self._low[index], low[mine].min(axis=0))
            self._high[index] = np.maximum(self._high[index], high[mine].max(axis=0))

    def _groups(self, made: Stretches, states: Sequence[ModalState]) -> Int:
        """(n,) index of the sums that each stretch belongs to."""
        if self._bodies is None:
            return np.array([self._group(state, 0) for state in states])[made.state]
        body = self._bodies.owner((made.start_mm + made.end_mm) / 2)
        pairs, of = np.unique(np.stack([made.state, body]), axis=1, return_inverse=True)
        groups = [self._group(states[state], each) for state, each in pairs.T.tolist()]
        return np.array(groups)[of.reshape(-1)]

    def _group(self, state: ModalState, body: int) -> int:
        key = Key(state.feature, state.tool, state.volumetric, body)
        return self._keys.setdefault(key, len(self._keys))

    def _add_groups(self) -> None:
        """Start the sums of keys that are new."""
        more = len(self._keys) - len(self._sums)
        self._sums = np.vstack([self._sums, np.zeros((more, COLUMNS))])
        self._inside = np.concatenate([self._inside, np.zeros(more)])
        self._low = np.vstack([self._low, np.full((more, 3), np.inf)])
        self._high = np.vstack([self._high, np.full((more, 3), -np.inf)])
        self._lowest += [LowestBeads() for _ in range(more)]

    def result(
        self,
        left_out: Collection[str],
        diameter_mm: float | None,
        density_g_cm3: float | None,
    ) -> Printed:
        """The whole print, after the last piece.

        Raises InputError where the file is cut off, prints nothing, or has figures beyond reason.
        """
        self._refuse_half()
        filament = Filament(self._tracker, diameter_mm, density_g_cm3)
        keys = [self._feature(key) for key in self._keys]
        volumes = np.array([filament.mm3(key) for key in keys])
        grams = np.array([filament.g_cm3(key) for key in keys]) / 1000
        kept = [
            i for i, key in enumerate(keys) if key.feature not in left_out and self._sums[i, 0] > 0
        ]
        if not kept:
            raise InputError(
                f"{self._name} prints no part of a model.",
                "Check that it is G-code for a filament printer.",
            )
        in_mm3 = self._sums * volumes[:, None]
        in_g = in_mm3 * grams[:, None]
        whole = in_g[kept].sum(axis=0)
        beads, owner = self._first_layer(kept, volumes)
        bed = float((beads[:, 4] - beads[:, 6]).min())
        balance = balance_of(whole, beads, bed)
        if balance.tilt_deg is None:
            raise InputError(f"{self._name} has a first layer that is too small to stand on.")
        bodies = []
        for body in range(self._count):
            own = [i for i in kept if keys[i].body == body]
            if own:
                bodies.append(balance_of(in_g[own].sum(axis=0), beads[owner == body], bed))
        self._refuse_nonsense(whole, balance, *bodies)
        inside = self._inside * volumes
        support = np.array([key.feature in SUPPORT for key in keys])
        by_feature = _by_feature(keys, in_g[:, 0])
        return Printed(
            mass_g=float(whole[0]),
            volume_mm3=float(in_mm3[kept, 0].sum()),
            centre_of_mass_mm=balance.centre_of_mass_mm,
            inertia_g_mm2=inertia_about_centre(whole),
            contact_polygon_mm=balance.contact_polygon_mm,
            contact_area_mm2=balance.contact_area_mm2,
            tilt_deg=balance.tilt_deg,
            bodies=tuple(bodies),
            feature_mass_g=by_feature,
            feature_volume_mm3=_by_feature(keys, in_mm3[:, 0]),
            left_out=tuple(feature for feature in by_feature if feature in left_out),
            bounds_mm=np.stack([self._low[kept].min(axis=0), self._high[kept].max(axis=0)]),
            objects=tuple(sorted(self._tracker.objects)),
            filament_mm3=float(
                sum(in_mm3[i, 0] for i, key in enumerate(keys) if key.feature != CUSTOM)
            ),
            in_cavities_mm3=float(inside.sum()),
            support_in_cavities_mm3=float(inside[support].sum()),
            in_cavities_at_mm=next(iter(self._at.values()), None),
            assumed=filament.assumed,
            labelled=self._tracker.labelled,
            slicer_summary=summary_of(self._tracker),
        )

    def _refuse_half(self) -> None:
        """Raise InputError where a mark is missing with which the slicer ends a file."""
        if self._tracker.awaited:
            marks = ", ".join(sorted(mark.decode("ascii") for mark in self._tracker.awaited))
            raise InputError(
                f"{self._name} is cut off: the line {marks!r}, with which its slicer ends a file, "
                "is missing.",
                "Export it again from the slicer.",
            )

    def _refuse_nonsense(self, moments: Float, *balances: Balance) -> None:
        """Raise InputError where a figure is no number: then nothing can be said of the print.

        moments : (10,) of the whole print.
        """
        figures = [*moments.tolist()]
        for each in balances:
            figures += [*each.centre_of_mass_mm, each.contact_area_mm2, each.tilt_deg or 0.0]
        if not np.isfinite(figures).all() or not moments[0] > 0:
            raise InputError(
                f"{self._name} has numbers that no print can have: its mass or balance cannot be "
                "computed.",
                "Slice the model again.",
            )

    def _feature(self, key: Key) -> Key:
        """The key, with custom as the feature before the first label: that is start G-code."""
        if key.feature == UNLABELLED and self._tracker.labelled:
            return key._replace(feature=CUSTOM)
        return key

    def _first_layer(self, kept: Sequence[int], volumes: Float) -> tuple[Float, Int]:
        """(n, 7) beads of the first layer, as ``LowestBeads``, and (n,) their bodies.

        kept : groups that count;  volumes : (groups,) mm³ per unit of E.
        """
        lowest = min(self._lowest[i].z_mm for i in kept)
        bodies = [key.body for key in self._keys]
        layers, owners = [], []
        for i in kept:
            if self._lowest[i].z_mm <= lowest + SAME_LAYER_MM:
                beads = self._lowest[i].beads.copy()
                missing = beads[:, 5] < 0
                # As Cura and others count, a bead without a given width has a rectangular section.
                with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
                    width = beads[missing, 5] * -volumes[i] / beads[missing, 6]
                # A blob where the nozzle hardly moves is no wide line.
                beads[missing, 5] = np.minimum(width, _WIDTH_MAX_MM)
                layers.append(beads)
                owners.append(np.full(len(beads), bodies[i]))
        return np.concatenate(layers), np.concatenate(owners)


def _by_feature(keys: Sequence[Key], values: Float) -> dict[str, float]:
    """Sums of values (n,), one for each key, by feature, without those that are 0."""
    sums: dict[str, float] = {}
    for key, value in zip(keys, values, strict=True):
        sums[key.feature] = sums.get(key.feature, 0.0) + float(value)
    return {feature: sums[feature] for feature in sorted(sums) if sums[feature] > 0}
