"""The part as a file: a 3MF with its print settings, or only the triangles.

Every format is written from the manifold that was checked: float32 coordinates, welded, cavities as
inverted shells of the same mesh, so that slicers keep them hollow.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.output.limits import check_infill_output, check_output

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.mesh.carry import Carried
    from printprep.output.figures import Figures
    from printprep.profiles import Profile
    from printprep.types import Infill, Part, SlicerName

JSON_PART = "Metadata/printprep.json"
THUMBNAIL_SIZE = 256  # pixels


@dataclass(frozen=True, eq=False)
class Contents:
    """Everything that a file of a part is made from.

    infill : the slicer's infill inside the part, None for a part with cavities.
    blocker : where a slicer makes no supports, None for anywhere.
    paint : of the part's faces, in the order of ``quantized_arrays``; None where there is none.
    """

    part: Part
    profile: Profile
    infill: Infill | None
    figures: Figures
    blocker: Manifold | None = None
    paint: Carried | None = None


def write_part(contents: Contents, path: str | Path, slicer: SlicerName = "prusa") -> None:
    """Write a part in one step; the suffix chooses the format.

    slicer : the slicer to write a 3MF for; it holds settings of an object for PrusaSlicer, or for
        OrcaSlicer and BambuStudio.

    Raises
    ------
    UsageError : a suffix other than .3mf, .stl, .obj, .ply.
    OutputError : the file cannot be written; an existing file is then unchanged.
    """
    from printprep.files import write_atomically

    target = Path(path)
    check_output(target)
    write_atomically(target, part_bytes(contents, target.suffix, slicer))


def part_bytes(contents: Contents, suffix: str, slicer: SlicerName = "prusa") -> bytes:
    """The content of the file; the same contents and version give the same bytes.

    Raises UsageError for a suffix or slicer that cannot carry the infill.
    """
    from printprep.mesh.quantize import quantized
    from printprep.mesh.write import to_bytes

    manifold = quantized(contents.part.manifold)
    if contents.infill is not None:
        check_infill_output(suffix, slicer)
    if suffix.lower() == ".3mf":
        return _as_3mf(contents, manifold, slicer)
    return to_bytes(manifold, suffix)


def _as_3mf(contents: Contents, manifold: Manifold, slicer: SlicerName) -> bytes:
    from printprep.mesh.quantize import quantized_arrays
    from printprep.output.colours import strokes_for
    from printprep.output.item import infill_item, solid_item
    from printprep.output.numbers import to_text
    from printprep.output.orca_keys import orca_item
    from printprep.render.thumbnail import thumbnail_png
    from printprep.threemf.write import write_3mf
    from printprep.version import __version__

    name, profile, infill = contents.part.name, contents.profile, contents.infill
    if infill is not None:
        item = infill_item(manifold, infill.ballast, name, profile, contents.paint)
    else:
        item = solid_item(manifold, name, profile, blocker=contents.blocker, paint=contents.paint)
    if slicer == "orca":
        item = orca_item(item)
    return write_3mf(
        [item],
        thumbnail_png=thumbnail_png(*quantized_arrays(manifold), THUMBNAIL_SIZE),
        attachments={JSON_PART: to_text(contents.figures.to_json()).encode("ascii")},
        metadata={"Title": name, "Application": f"printprep {__version__}"},
        dialect=slicer if slicer == "prusa" or slicer == "orca" else "plain",
        strokes=strokes_for(slicer),
    )
