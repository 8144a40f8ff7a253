"""Features of G-code (perimeter, infill, support …): one name for the labels of all slicers.

The names are those of PrusaSlicer (libslic3r's ExtrusionRole), in lower case.  SuperSlicer adds a
few; OrcaSlicer and BambuStudio use others (`;TYPE:` or `; FEATURE:`); Cura and ideaMaker write
capitals; CraftWare writes `;segType:`.  Simplify3D writes `; feature skirt` (before version 4,
`; skirt`), and KISSlicer `; 'Perimeter Path', …`.
"""

from __future__ import annotations

CUSTOM = "custom"
UNLABELLED = "unlabelled"
OTHER = "other"
SUPPORT = frozenset({"support material", "support material interface"})

# Features that are removed after printing, or never belong to the model.
LEFT_OUT = SUPPORT | {"skirt", "brim", "wipe tower", CUSTOM}

_NAMES = {
    # PrusaSlicer; since 2.6 brim is a role of its own
    "perimeter": "perimeter",
    "external perimeter": "external perimeter",
    "overhang perimeter": "overhang perimeter",
    "internal infill": "internal infill",
    "solid infill": "solid infill",
    "top solid infill": "top solid infill",
    "bridge infill": "bridge infill",
    "ironing": "ironing",
    "gap fill": "gap fill",
    "skirt": "skirt",
    "brim": "brim",
    "skirt/brim": "skirt",
    "support material": "support material",
    "support material interface": "support material interface",
    "wipe tower": "wipe tower",
    "custom": CUSTOM,
    # SuperSlicer
    "internal perimeter": "perimeter",
    "internal bridge infill": "bridge infill",
    "thin wall": "external perimeter",
    "mixed": OTHER,
    "milling": CUSTOM,
    # OrcaSlicer, BambuStudio
    "inner wall": "perimeter",
    "outer wall": "external perimeter",
    "overhang wall": "overhang perimeter",
    "sparse infill": "internal infill",
    "internal solid infill": "solid infill",
    "top surface": "top solid infill",
    "bottom surface": "solid infill",
    "bridge": "bridge infill",
    "internal bridge": "bridge infill",
    "gap infill": "gap fill",
    "support": "support material",
    "support interface": "support material interface",
    "support transition": "support material",
    "prime tower": "wipe tower",
    "multiple": OTHER,
    "undefined": OTHER,
    # Cura
    "wall-outer": "external perimeter",
    "wall-inner": "perimeter",
    "skin": "solid infill",
    "fill": "internal infill",
    "support-interface": "support material interface",
    "prime-tower": "wipe tower",
    # ideaMaker
    "raft": "support material",
    "solid-fill": "solid infill",
    "gap-fill": "gap fill",
    "dense-support": "support material interface",
    "wipe-tower": "wipe tower",
    "ooze-wall": "skirt",
    "shield": "skirt",
    # CraftWare
    "hshell": "solid infill",
    "innerhair": "gap fill",
    "loop": "perimeter",
    "infill": "internal infill",
    "supporttouch": "support material interface",
    "softsupport": "support material interface",
    "pillar": "wipe tower",
    # Simplify3D
    "outer perimeter": "external perimeter",
    "inner perimeter": "perimeter",
    "single extrusion": "gap fill",
    "solid layer": "solid infill",
    "dense support": "support material interface",
    "prime pillar": "wipe tower",
    "ooze shield": "skirt",
    # KISSlicer
    "crown": "solid infill",
    "solid": "solid infill",
    "stacked sparse infill": "internal infill",
    "support (may stack)": "support material",
    "skirt/brim/raft": "skirt",
    "brim/skirt": "skirt",
    "travel/ironing": "ironing",
}

SIMPLIFY3D_BARE = frozenset(
    {
        "skirt", "brim", "raft", "outer perimeter", "inner perimeter", "gap fill", "infill",
        "single extrusion", "solid layer", "bridge", "support", "dense support", "prime pillar",
        "ooze shield",
    }
)  # fmt: skip
"""Comments that are labels by themselves in Simplify3D before version 4."""


def feature_of(label: str) -> str:
    """The feature that a slicer's label stands for; an unknown label is ``other``, model."""
    return _NAMES.get(label.strip().lower(), OTHER)
