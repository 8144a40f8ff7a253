"""Decides what becomes of the sealed voids that a model brings, before anything is hollowed.

The outside of a model is promised, its inside is not: an empty void is filled, and the space is
hollowed like all the rest, with the vaults and the drains that the process needs.  A void that
holds a body of its own is meant, as in a rattle, and stays.  On request all voids stay; then vaults
carry their ceilings, where the process needs them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from printprep.mesh.carry import facets_apart
from printprep.mesh.sealed_voids import sealed_voids
from printprep.mesh.shell_figures import pieces
from printprep.supports.policy import supported, vault_choice
from printprep.types import ModelVoids

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.progress import Progress


def settle_voids(prepared: Prepared, options: FillOptions, progress: Progress) -> Prepared:
    """The prepared model with its sealed voids filled, or kept with vaults under their ceilings."""
    from manifold3d import Manifold, OpType

    solid = prepared.solid
    with progress.stage("repair"):
        found = sealed_voids(solid.manifold)
    if not found.empty and not found.holding:
        return prepared
    holding = _volumes(found.holding)
    if prepared.model.paint is not None:
        found = replace(found, whole=facets_apart(found.whole))
    if options.voids == "fill" or not found.empty:
        voids = ModelVoids(filled_mm3=_volumes(found.empty), holding_mm3=holding)
        return replace(prepared, solid=replace(solid, manifold=found.whole), voids=voids)
    kept = found.empty
    profile = prepared.profile
    if profile.traits.ceilings_sag and vault_choice(options.vaults, profile) != "none":
        # The slicer's rule, the stricter one: no support blocker reaches into these voids.
        with progress.stage("supports"):
            kept = tuple(
                piece
                for void in kept
                for piece in pieces(supported(void, profile, "slicer")[0], profile.crumb_mm3)
            )
    settled = replace(
        solid,
        manifold=Manifold.batch_boolean([found.whole, *kept], OpType.Subtract),
        kept=kept,
        filled=found.whole,
    )
    voids = ModelVoids(kept_mm3=_volumes(found.empty), holding_mm3=holding)
    return replace(prepared, solid=settled, voids=voids)


def _volumes(solids: Sequence[Manifold]) -> tuple[float, ...]:
    return tuple(float(solid.volume()) for solid in solids)
