"""The plugs for a part's drain holes as a 3MF, each as its own object, in rows on the bed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Drainage, Part

# The gap between two plugs, wide enough for their brims.
GAP_MM = 5.0


def write_plugs(part: Part, drainage: Drainage, profile: Profile, path: str | Path) -> None:
    """Write a plug for every drain hole, in one step.

    Raises OutputError if the file cannot be written, ValueError for a part without drain holes.
    """
    from printprep.files import write_atomically

    write_atomically(Path(path), plugs_3mf(part, drainage, profile))


def plugs_3mf(part: Part, drainage: Drainage, profile: Profile) -> bytes:
    """The content of the file; the same part and version give the same bytes.

    Raises ValueError for a part without drain holes.
    """
    from printprep.drainage.plugs import plug
    from printprep.mesh.quantize import quantized, quantized_arrays
    from printprep.threemf.write import Item, Volume, write_3mf
    from printprep.version import __version__

    drains = drainage.drains
    if not drains:
        raise ValueError(f"{part.name} has no drain holes to plug")
    width, depth, _ = profile.printer.bed_mm
    pitch = max(drain.diameter_mm for drain in drains) + GAP_MM
    each_row = max(1, int((width - GAP_MM) // pitch))
    items = []
    for number, drain in enumerate(drains):
        name = f"plug {number + 1}, {drain.role}"
        vertices, faces = quantized_arrays(quantized(plug(drain, part.outside)))
        row, place = divmod(number, each_row)
        in_row = min(each_row, len(drains) - row * each_row)
        middle = (width / 2 + (place - (in_row - 1) / 2) * pitch, depth / 2 + row * pitch)
        move = (*middle, 0.0 - float(vertices[:, 2].min()))
        items.append(Item(name, [Volume(name, vertices, faces)], translation_mm=move))
    return write_3mf(
        items,
        metadata={"Title": f"{part.name} plugs", "Application": f"printprep {__version__}"},
    )
