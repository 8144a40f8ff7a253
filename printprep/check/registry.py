"""The registry of rules: a stable id, a function, and one order for the findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING

from printprep.check.catalogue import CATALOGUE
from printprep.mesh.measure import evaluate
from printprep.side_by_side import side_by_side
from printprep.types import Finding, Severity

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

Rule = Callable[["CheckContext", "Profile"], Iterable[Finding]]

_RANK: Mapping[Severity, int] = MappingProxyType({"info": 0, "warning": 1, "error": 2})
# The rules that take longest begin first, so that none of them is alone at the end.
_DEAR = frozenset({"gap", "overlapping-shells", "wall-thickness"})
RULES: dict[str, Rule] = {}
"""Every rule by its id; :func:`rule` adds one."""


def rule(rule_id: str) -> Callable[[Rule], Rule]:
    """Register a rule under an id that never changes: scripts filter on it.

    The first sentence of the rule's docstring says what it prevents, tells or explains;
    docs/checks.md quotes it.
    """

    def register(function: Rule) -> Rule:
        if rule_id not in CATALOGUE:
            raise ValueError(f"{rule_id} is not in the catalogue of findings")
        if rule_id in RULES:
            raise ValueError(f"two rules are called {rule_id}")
        RULES[rule_id] = function
        return function

    return register


def run_rules(context: CheckContext, profile: Profile) -> tuple[Finding, ...]:
    """The findings of all rules: the worst first, then by rule id, then in the rule's order."""
    evaluate(context.solids)
    dearest_first = sorted(RULES, key=lambda rule_id: (rule_id not in _DEAR, rule_id))
    found = side_by_side([partial(_found, RULES[k], context, profile) for k in dearest_first])
    by_rule = dict(zip(dearest_first, found, strict=True))
    return sorted_findings(item for rule_id in sorted(RULES) for item in by_rule[rule_id])


def _found(check: Rule, context: CheckContext, profile: Profile) -> list[Finding]:
    """The findings of one rule."""
    return list(check(context, profile))


def sorted_findings(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """The worst first, then by rule id; the findings of one rule keep their order."""
    return tuple(sorted(findings, key=lambda item: (-_RANK[item.severity], item.rule)))


def at_or_above(findings: Iterable[Finding], severity: Severity) -> tuple[Finding, ...]:
    """The findings at least as severe as ``severity``, in their order."""
    return tuple(item for item in findings if _RANK[item.severity] >= _RANK[severity])
