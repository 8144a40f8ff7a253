"""Every finding that printprep can print: its id, its unit, its severities, what it prevents.

Ids never change: scripts filter on them.  Every part of the program makes its findings with
:func:`finding`, which takes the unit and the severity from this catalogue.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from printprep.types import Finding, Severity, Unit
from printprep.wording import printable


@dataclass(frozen=True)
class Kind:
    """One kind of finding.

    unit : of value and limit; None for a count, or for a finding without a value.
    severities : those it can have; where there are several, the rule chooses one.
    prevents : the mistake or surprise it prevents, in a few words.
    """

    id: str
    unit: Unit | None
    severities: tuple[Severity, ...]
    prevents: str


_INFO: tuple[Severity, ...] = ("info",)
_WARNING: tuple[Severity, ...] = ("warning",)
_ERROR: tuple[Severity, ...] = ("error",)

_KINDS = (
    # the triangles of the file
    Kind("coarse-facets", "mm", _INFO, "facets that show on a round model"),
    Kind("degenerate-triangles", None, _INFO, "triangles without area, which some programs drop"),
    Kind("non-manifold-edges", None, _WARNING, "programs that separate bodies differently"),
    Kind("open-surface", None, _ERROR, "holes that each slicer closes in its own way"),
    Kind("orientation", None, _WARNING, "a solid that a slicer takes for a void"),
    Kind("overlapping-shells", None, _INFO, "programs that disagree on what is inside"),
    Kind("repaired", "mm", ("info", "warning"), "a slicer that guesses what is inside"),
    Kind("self-intersection", None, _WARNING, "programs that disagree on what is inside"),
    Kind("watertight", None, _ERROR, "a cavity that a slicer fills, or an open layer"),
    # what a reader made of the file
    Kind("colours-lost", None, ("info", "warning"), "a part that is printed in one colour"),
    Kind("cut-short", None, _WARNING, "half a model taken for a whole one"),
    Kind("facet-count", None, _INFO, "facets that another program drops, or adds"),
    Kind("left-out", None, _INFO, "a project of which only a part was read"),
    Kind("read-together", None, _INFO, "several objects hollowed where one was meant"),
    Kind("subtracted", None, _INFO, "a hole that came from a project without a word"),
    # size and place
    Kind("fits-bed", "mm", _ERROR, "a part that does not fit into the printer"),
    Kind("tiny-model", "mm", _ERROR, "a file in another unit, which prints far too small"),
    # walls, pins, gaps
    Kind("gap", "mm", _INFO, "surfaces that fuse together"),
    Kind("min-feature", "mm", _WARNING, "a pin that breaks off, or that a slicer leaves out"),
    Kind("wall-thickness", "mm", ("info", "warning", "error"), "a wall with holes, or that breaks"),
    # ceilings and overhangs
    Kind("overhang-area", "mm2", _INFO, "unexpected supports"),
    Kind("support-blocker", "mm2", _WARNING, "supports inside, or missing outside"),
    Kind("unsupported-ceiling", "mm2", _WARNING, "a ceiling that sags into the cavity"),
    # what stays inside
    Kind("drain-filled", "mm3", _INFO, "a cavity left solid for no visible reason"),
    Kind("drain-too-small", "mm", _ERROR, "a drain hole too narrow to drain anything"),
    Kind("nothing-to-hollow", None, _INFO, "a part left solid for no visible reason"),
    Kind("no-vent", "mm3", _INFO, "resin that runs out slowly, or not at all"),
    Kind("sealed-cavity", "mm3", ("info", "error"), "resin or powder that can never get out"),
    Kind("suction-cup", "mm2", _WARNING, "layers that a vacuum tears as they leave the film"),
    Kind("trapped-volume", "mm3", ("info", "warning"), "resin that leaks, or cures inside"),
    # the voids of the model
    Kind("void-filled", "mm3", _INFO, "surprise at a void that is gone"),
    Kind("void-kept", "mm3", _INFO, "surprise at a void that was not filled"),
    # standing
    Kind("contact-area", "mm2", _WARNING, "a tall print that comes loose from the bed"),
    Kind("lean-out-of-reach", "deg", _ERROR, "more ballast where only feet or pose help"),
    Kind("no-contact", "mm2", _ERROR, "a body that starts in mid-air"),
    Kind("simulated-fall", "deg", _ERROR, "a part that falls over by itself"),
    Kind("simulated-tip", "deg", _ERROR, "a part that tips at less than the lean"),
    Kind("simulation-disagrees", "deg", _WARNING, "a computed tilt angle that is wrong"),
    Kind("tilt", "deg", _ERROR, "a part that falls over"),
    # the print, measured in its G-code
    Kind("another-print", None, _WARNING, "a comparison with the wrong part"),
    Kind("features-unknown", None, _WARNING, "a skirt or a support taken for a foot"),
    Kind("filament-count", "mm3", _WARNING, "figures that the slicer's own count contradicts"),
    Kind("filled-cavity", "mm3", _ERROR, "a cavity that the slicer prints solid"),
    Kind("printed-centre-of-mass", "mm", _WARNING, "a print that balances differently"),
    Kind("printed-contact", "mm", _WARNING, "a support polygon smaller than computed"),
    Kind("printed-mass", "g", _WARNING, "a print heavier than computed"),
    Kind("printed-tilt", "deg", _ERROR, "a print that falls over"),
    Kind("several-objects", None, _WARNING, "one set of figures for several objects"),
    Kind("support-in-cavity", "mm3", _ERROR, "supports that no one can remove"),
    # what the user of a file must know
    Kind("infill-estimated", None, _WARNING, "an estimate taken for a measurement"),
    Kind("no-blocker", None, _WARNING, "supports that no one can remove"),
    Kind("no-plugs", None, _INFO, "a search for a file that was not written"),
    Kind("no-settings", None, _WARNING, "a print with settings that were not computed for"),
    Kind("set-by-hand", None, _INFO, "a print with settings that were not computed for"),
    Kind("vaults-for-slicer", None, _INFO, "a heavier part for no visible reason"),
)

CATALOGUE: Mapping[str, Kind] = MappingProxyType({kind.id: kind for kind in _KINDS})


def finding(
    kind_id: str,
    message: str,
    fix: str | None = None,
    *,
    severity: Severity | None = None,
    value: float | None = None,
    limit: float | None = None,
    at_mm: tuple[float, float, float] | None = None,
    area_mm2: float | None = None,
    volume_mm3: float | None = None,
) -> Finding:
    """Make a finding of a kind in the catalogue, with that kind's unit.

    Parameters
    ----------
    message : what is so, with its number;  fix : what to do about it.
    severity : one that the kind can have; not needed where it can have only one.
    value, limit : in the kind's unit.  The rest is as in :class:`printprep.types.Finding`.

    Raises
    ------
    ValueError : the catalogue lacks that kind, or the kind cannot have that severity.
    """
    kind = CATALOGUE.get(kind_id)
    if kind is None:
        raise ValueError(f"{kind_id} is not in the catalogue of findings")
    if severity is None and len(kind.severities) == 1:
        severity = kind.severities[0]
    if severity not in kind.severities:
        raise ValueError(f"{kind_id} must be {' or '.join(kind.severities)}, not {severity}")
    return Finding(
        rule=kind_id,
        severity=severity,
        message=printable(message),
        fix=None if fix is None else printable(fix),
        value=value,
        limit=limit,
        unit=kind.unit if value is not None or limit is not None else None,
        at_mm=at_mm,
        area_mm2=area_mm2,
        volume_mm3=volume_mm3,
    )
