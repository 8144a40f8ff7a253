"""The loop around the slicer, with a slicer whose law is known: it must end where that stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from infill_parts import leaning, solid_of
from manifold3d import Manifold

from printprep.infill.ballast import Ballasted, weighed_ballast
from printprep.infill.estimate import infill_program, measured_depths
from printprep.infill.trial_print import Weighed
from printprep.mesh.measure import mass_properties
from printprep.profiles import load_profile
from printprep.stand.contact import contact_of, section_at_bed
from printprep.stand.stability import balanced
from printprep.types import Lean, Part


def moments_of(solid: Manifold) -> np.ndarray:
    found = mass_properties(solid)
    return found.volume_mm3 * np.array([1.0, *found.centre_mm])


class KnownSlicer:
    """Walls of ``wall_mm``, inside them ``sparse`` throughout, or dense where the ballast is.

    Neither is what the estimate takes them for, and the feet are ``squeezed`` narrower.
    """

    slices = 0

    def __init__(self, wall_mm: float, sparse: float, squeezed_mm: float) -> None:
        self.room = leaning(wall_mm)
        self.sparse = sparse
        self.squeezed_mm = squeezed_mm

    def weigh(self, part: Part, ballast: Sequence[Manifold], apart: Sequence[Manifold]) -> Weighed:
        assert len(apart) == 1
        self.slices += 1
        total = moments_of(part.manifold) - (1 - self.sparse) * moments_of(self.room)
        for solid in ballast:
            total = total + (1 - self.sparse) * moments_of(solid ^ self.room)
        section = section_at_bed(part.manifold, 0.2).offset(-self.squeezed_mm)
        x, y, z = (float(value) for value in total[1:] / total[0])
        return Weighed(total[None], (balanced(contact_of(section), (x, y, z)),))


def settle(trial_slicer: KnownSlicer, lean_deg: float) -> Ballasted:
    profile = load_profile("fdm-pla-0.4", {"stability.lean_margin_deg": 0.1})
    solid = solid_of(leaning())
    program = infill_program(solid, measured_depths(solid, profile, 40), profile)
    found = weighed_ballast(
        solid_of(leaning()),
        program,
        "never",
        Lean(lean_deg),
        0.15,
        trial_slicer,  # type: ignore[arg-type]
    )
    assert found is not None
    return found


@pytest.mark.parametrize("wall_mm", [0.8, 1.4])
@pytest.mark.parametrize("sparse", [0.05, 0.3])
@pytest.mark.parametrize("squeezed_mm", [0.0, 0.3])
def test_it_ends_where_the_print_stands_and_has_nothing_to_spare(
    wall_mm: float, sparse: float, squeezed_mm: float
):
    trial_slicer = KnownSlicer(wall_mm, sparse, squeezed_mm)
    found = settle(trial_slicer, 13.0)
    assert 13.0 <= found.stability.tilt_deg <= 13.0 + 0.1 + 0.3
    # What is handed on is what was printed, not what was computed
    again = KnownSlicer(wall_mm, sparse, squeezed_mm).weigh(
        found.part, found.ballast, [found.part.manifold]
    )
    np.testing.assert_allclose(found.moments, again.moments[0], atol=1e-6)
    assert found.stability.tilt_deg == pytest.approx(again.stabilities[0].tilt_deg)
    assert trial_slicer.slices <= 5


def test_what_stands_without_ballast_gets_none():
    trial_slicer = KnownSlicer(1.2, 0.1, 0.0)
    found = settle(trial_slicer, 8.0)
    assert found.ballast == ()
    # Box and room share their middle; the contact is cut at 0.1 mm, where the shear is 0.03 mm
    expected = np.degrees(np.arctan((4 + 0.03) / 20))
    assert found.stability.tilt_deg == pytest.approx(expected, abs=1e-6)


def test_out_of_reach_it_is_said_how_far_ballast_goes():
    found = settle(KnownSlicer(1.2, 0.1, 0.0), 40.0)
    assert found.density.reachable_deg is not None
    assert 11.3 < found.density.reachable_deg < 40.0
    assert found.ballast
