"""The part as a file: 3MF with the settings it must be printed with, or bare triangles.

Everything is written from one manifold, the one that was checked: float32 coordinates, welded,
cavities as inverted shells of the same mesh, which is how slicers keep them hollow.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import OutputError, UsageError
from printprep.types import Finding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.profiles import Profile
    from printprep.types import HollowResult, SlicerName

SUFFIXES = (".3mf", ".stl", ".obj", ".ply")
JSON_PART = "Metadata/printprep.json"
THUMBNAIL_SIZE = 256


def write_part(result: HollowResult, path: str | Path, slicer: SlicerName = "prusa") -> None:
    """Write a part whole or not at all; the suffix chooses the format.

    slicer : whose settings go into a 3MF; all but PrusaSlicer take only the shape from it.

    Raises
    ------
    UsageError : a suffix other than .3mf, .stl, .obj, .ply.
    OutputError : the file cannot be written there; what was there before is then untouched.
    """
    from printprep.files import write_atomically

    target = Path(path)
    check_output(target)
    write_atomically(target, part_bytes(result, target.suffix, slicer))


def check_output(path: Path) -> None:
    """Find out before the long work whether a part can be written to ``path``.

    Raises UsageError for an unknown suffix, OutputError for a folder that is missing, cannot be
    written to, or stands where the file should.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(
            f"{path}: {path.suffix or 'a name without suffix'} is no format of ours.",
            f"Use one of {', '.join(SUFFIXES)}; .3mf carries the print settings.",
        )
    if path.is_dir():
        raise OutputError(f"{path} is a folder, not a file.", "Name a file inside it.")
    if not path.parent.is_dir():
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} does not exist.",
            "Make the folder first, or name another one.",
        )
    if not os.access(path.parent, os.W_OK):
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} may not be written to.",
            "Name a folder you may write to.",
        )


def part_bytes(result: HollowResult, suffix: str, slicer: SlicerName = "prusa") -> bytes:
    """The file's content; the same result and version give the same bytes."""
    from printprep.infill.options import check_infill_output
    from printprep.mesh.quantize import quantized
    from printprep.mesh.write import to_bytes

    manifold = quantized(result.part.manifold)
    if result.infill is not None:
        check_infill_output(suffix, slicer)
    if suffix.lower() == ".3mf":
        return _as_3mf(result, manifold, plain=slicer != "prusa")
    return to_bytes(manifold, suffix)


def format_findings(
    profile: Profile, path: Path, slicer: SlicerName = "prusa"
) -> tuple[Finding, ...]:
    """What the file at ``path`` leaves behind of the profile's settings."""
    if slicer != "prusa":
        return (_manual_settings(profile, slicer),)
    suffix = path.suffix.lower()
    if suffix == ".3mf" or not profile.object_settings:
        return ()
    settings = ", ".join(f"{key}={value}" for key, value in sorted(profile.object_settings.items()))
    return (
        Finding(
            "no-settings",
            "warning",
            f"A {suffix} file carries no print settings; mass and stand hold only with them: "
            f"{settings}.",
            "Write a .3mf, or set them in the slicer by hand.",
        ),
    )


def _manual_settings(profile: Profile, slicer: SlicerName) -> Finding:
    from printprep.output.manual_settings import manual_settings

    program, settings = manual_settings(profile, slicer)
    return Finding(
        "set-by-hand",
        "info",
        f"{program} takes only the shape from this file; mass and stand hold with these settings: "
        f"{'; '.join(settings)}.",
        "Set them before you slice.",
    )


def _as_3mf(result: HollowResult, manifold: Manifold, *, plain: bool) -> bytes:
    from printprep.mesh.quantize import quantized_arrays
    from printprep.output.item import item_of
    from printprep.render.thumbnail import thumbnail_png
    from printprep.report.json import embedded_json, to_text
    from printprep.threemf.write import Item, Volume, write_3mf
    from printprep.version import __version__

    vertices, faces = quantized_arrays(manifold)
    name = result.part.name
    width, depth, _ = result.profile.printer.bed_mm
    if result.infill is not None:
        item = item_of(manifold, result.infill.ballast, name, result.profile)
    else:
        item = Item(
            name=name,
            volumes=[Volume(name, vertices, faces)],
            settings=result.profile.object_settings,
            translation_mm=(width / 2, depth / 2, 0.0 - float(vertices[:, 2].min())),
        )
    return write_3mf(
        [item],
        thumbnail_png=thumbnail_png(vertices, faces, THUMBNAIL_SIZE),
        attachments={JSON_PART: to_text(embedded_json(result)).encode("ascii")},
        metadata={"Title": name, "Application": f"printprep {__version__}"},
        plain=plain,
    )
