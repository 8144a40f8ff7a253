"""The rules that a part is checked against, one rule in each file.

The same rules check the parts that printprep writes and any other mesh.
``run_rules(context, profile)`` runs them all; importing a rule here registers it.
"""

from printprep.check import (  # noqa: F401  (imported to register their rules)
    coarse_facets,
    contact_area,
    degenerate_triangles,
    drain_filled,
    drain_too_small,
    fits_bed,
    gap,
    lean_out_of_reach,
    min_feature,
    no_contact,
    no_vent,
    non_manifold_edges,
    nothing_to_hollow,
    open_surface,
    orientation,
    overhang_area,
    overlapping_shells,
    repaired,
    sealed_cavity,
    self_intersection,
    suction_cup,
    support_blocker,
    tilt,
    tiny_model,
    trapped_volume,
    unsupported_ceiling,
    void_filled,
    void_kept,
    wall_thickness,
    watertight,
)
from printprep.check.context import CheckContext, context_of_solid
from printprep.check.registry import RULES, Rule, at_or_above, rule, run_rules, sorted_findings
from printprep.check.walls import Wall, wall_min_mm

__all__ = [
    "RULES",
    "CheckContext",
    "Rule",
    "Wall",
    "at_or_above",
    "context_of_solid",
    "rule",
    "run_rules",
    "sorted_findings",
    "wall_min_mm",
]
