"""What a 3MF is written from: items on the bed, each of volumes with their purpose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.types import Paint

VolumeKind = Literal[
    "ModelPart", "NegativeVolume", "ParameterModifier", "SupportBlocker", "SupportEnforcer"
]


@dataclass(frozen=True, eq=False)
class Volume:
    """A closed mesh and its purpose.

    vertices : (n, 3) mm;  faces : (m, 3) indices into them, counter-clockwise seen from outside;
    settings : slicer keys of this volume only (useful on a ParameterModifier);
    paint : colours of the faces, None where there are none.
    """

    name: str
    vertices: Float
    faces: Int
    kind: VolumeKind = "ModelPart"
    settings: Mapping[str, str] = field(default_factory=dict)
    paint: Paint | None = None


@dataclass(frozen=True, eq=False)
class Item:
    """One object on the bed z = 0; the slicer does not move it.

    settings : slicer keys of the object;  translation_mm : place of its origin, (x, y, z).
    """

    name: str
    volumes: Sequence[Volume]
    settings: Mapping[str, str] = field(default_factory=dict)
    translation_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
