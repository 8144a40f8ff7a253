"""The colours and the paint of a part: carried from the model, and what a file cannot carry."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.mesh.carry import Carried, carried
from printprep.mesh.quantize import quantized, quantized_arrays
from printprep.threemf.painting import ORCA_STROKES, PRUSA_STROKES

if TYPE_CHECKING:
    from printprep.types import Finding, Model, Part, Repair, SlicerName

# Less than this share of the painted surface is a seam between two colours, not a loss.
_LOST_SHARE = 0.02
_AGAIN = "Paint the part again in the slicer."


def carried_paint(model: Model, part: Part, repair: Repair) -> Carried | None:
    """The model's paint on the faces of the part's ``quantized_arrays``, None without paint."""
    if model.paint is None:
        return None
    moved = part.placement @ np.linalg.inv(model.placement)
    vertices = model.vertices @ moved[:3, :3].T + moved[:3, 3]
    slack_mm = repair.moved_max_mm if repair.resolution_mm is not None else 0.0
    return carried(
        model.paint,
        vertices,
        model.faces,
        *quantized_arrays(quantized(part.manifold)),
        slack_mm=slack_mm,
    )


def strokes_for(slicer: SlicerName) -> Mapping[str, str]:
    """The attribute of a triangle for each kind of paint that a slicer reads."""
    if slicer == "prusa":
        return PRUSA_STROKES
    return ORCA_STROKES if slicer == "orca" else {}


def colour_findings(
    paint: Carried | None, path: Path, slicer: SlicerName = "prusa"
) -> tuple[Finding, ...]:
    """What of a part's paint the file at ``path`` does not hold."""
    if paint is None or not paint.labels.any():
        return ()
    suffix = path.suffix.lower()
    if suffix != ".3mf":
        message = f"A {suffix} file holds no colours: those of the model are lost."
        return (finding("colours-lost", message, "Write a .3mf file.", severity="warning"),)
    used = {kind for label in np.unique(paint.labels) for kind, _ in paint.styles[label].strokes}
    unknown = sorted(used - set(strokes_for(slicer)))
    if unknown:
        message = f"A file for {slicer} holds no paint: that of {', '.join(unknown)} is lost."
        return (finding("colours-lost", message, _AGAIN, severity="warning"),)
    if paint.lost_mm2 <= _LOST_SHARE * paint.painted_mm2:
        return ()
    return (
        finding(
            "colours-lost",
            f"Of {paint.painted_mm2:.0f} mm² of painted surface, {paint.lost_mm2:.0f} mm² lie on "
            "triangles that the part no longer has as they were; there the colours are coarser.",
            _AGAIN,
            severity="warning",
        ),
    )
