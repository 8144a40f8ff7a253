"""Every finding that printprep can print: its id, its unit, its severities, what it prevents.

Ids never change: scripts filter on them.  A finding is made with :func:`finding`, which takes unit
and severity from here, wherever in the program it is made.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from printprep.types import Finding, Severity, Unit


@dataclass(frozen=True)
class Kind:
    """One kind of finding.

    unit : of value and limit; None for a plain count, or for a finding without a value.
    severities : the ones it can have; with more than one, the rule chooses.
    prevents : the mistake it saves the user from, in a few words.
    """

    id: str
    unit: Unit | None
    severities: tuple[Severity, ...]
    prevents: str


_INFO: tuple[Severity, ...] = ("info",)
_WARNING: tuple[Severity, ...] = ("warning",)
_ERROR: tuple[Severity, ...] = ("error",)

_KINDS = (
    # the file's own triangles
    Kind("coarse-facets", "mm", _INFO, "facets that show on a round model"),
    Kind("degenerate-triangles", None, _INFO, "triangles without area that programs drop"),
    Kind("non-manifold-edges", None, _WARNING, "a surface that programs part differently"),
    Kind("open-surface", None, _ERROR, "holes that a slicer closes its own way"),
    Kind("orientation", None, _WARNING, "a solid that is taken for a void"),
    Kind("overlapping-shells", None, _INFO, "programs that differ on what is inside"),
    Kind("repaired", "mm", ("info", "warning"), "a slicer that guesses what a surface means"),
    Kind("self-intersection", None, _WARNING, "programs that differ on what is inside"),
    Kind("watertight", None, _ERROR, "a cavity that a slicer fills, a layer left open"),
    # size and place
    Kind("fits-bed", "mm", _ERROR, "a part that the printer cannot hold"),
    Kind("tiny-model", "mm", _ERROR, "a file in another unit that prints as a crumb"),
    # walls, pins, gaps
    Kind("gap", "mm", _INFO, "surfaces that grow together"),
    Kind("min-feature", "mm", _WARNING, "a pin that breaks off or is left out"),
    Kind("wall-thickness", "mm", ("info", "warning", "error"), "a wall with holes, or that breaks"),
    # ceilings and overhangs
    Kind("overhang-area", "mm2", _INFO, "supports that come as a surprise"),
    Kind("unsupported-ceiling", "mm2", _WARNING, "a ceiling that sags into the cavity"),
    # what stays inside
    Kind("drain-filled", "mm3", _INFO, "doubt about why a cavity was left solid"),
    Kind("drain-too-small", "mm", _ERROR, "a hole through which nothing runs"),
    Kind("nothing-to-hollow", None, _INFO, "surprise at a part that weighs what it did"),
    Kind("sealed-cavity", "mm3", ("info", "error"), "resin or powder that stays inside for good"),
    Kind("suction-cup", "mm2", _WARNING, "layers that tear off the film"),
    Kind("trapped-volume", "mm3", ("info", "warning"), "resin that leaks, or cures where it lies"),
    # standing
    Kind("contact-area", "mm2", _WARNING, "a tall print that comes loose from the bed"),
    Kind("lean-out-of-reach", "deg", _ERROR, "hope that more ballast would help"),
    Kind("no-contact", "mm2", _ERROR, "a body that starts in mid-air"),
    Kind("simulated-fall", "deg", _ERROR, "a part that falls over by itself"),
    Kind("simulated-tip", "deg", _ERROR, "a part that tips before the lean asked for"),
    Kind("simulation-disagrees", "deg", _WARNING, "trust in a computed angle that is wrong"),
    Kind("tilt", "deg", _ERROR, "a figure that falls over"),
    # the print, measured in its G-code
    Kind("another-print", None, _WARNING, "a comparison with the wrong part"),
    Kind("filament-count", "mm3", _WARNING, "trust in figures that the slicer counts otherwise"),
    Kind("filled-cavity", "mm3", _ERROR, "a cavity that the slicer prints solid"),
    Kind("printed-centre-of-mass", "mm", _WARNING, "a print that balances elsewhere"),
    Kind("printed-contact", "mm", _WARNING, "a foot that prints smaller than computed"),
    Kind("printed-mass", "g", _WARNING, "a print heavier than computed"),
    Kind("printed-tilt", "deg", _ERROR, "a print that falls over"),
    Kind("several-objects", None, _WARNING, "one figure for several prints"),
    Kind("support-in-cavity", "mm3", _ERROR, "supports that no one can take out"),
    # what a file leaves to its user
    Kind("infill-estimated", None, _WARNING, "an estimate that is taken for a measurement"),
    Kind("no-plugs", None, _INFO, "a search for a file that was not written"),
    Kind("no-settings", None, _WARNING, "a print with other settings than computed"),
    Kind("set-by-hand", None, _INFO, "a print with other settings than computed"),
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
    """A finding of a kind in the catalogue, with that kind's unit.

    Parameters
    ----------
    message : what is so, with its number;  fix : what to do about it.
    severity : one of the kind's; may be left out where the kind has only one.
    value, limit : in the kind's unit.  The rest as in :class:`printprep.types.Finding`.

    Raises
    ------
    ValueError : the catalogue has no such kind, or the kind no such severity.
    """
    kind = CATALOGUE.get(kind_id)
    if kind is None:
        raise ValueError(f"{kind_id} is not in the catalogue of findings")
    if severity is None and len(kind.severities) == 1:
        severity = kind.severities[0]
    if severity not in kind.severities:
        raise ValueError(f"{kind_id} is {' or '.join(kind.severities)}, not {severity}")
    return Finding(
        rule=kind_id,
        severity=severity,
        message=message,
        fix=fix,
        value=value,
        limit=limit,
        unit=kind.unit if value is not None or limit is not None else None,
        at_mm=at_mm,
        area_mm2=area_mm2,
        volume_mm3=volume_mm3,
    )
