"""Every rule on every case: no false alarm, none missed."""

from __future__ import annotations

import pytest
from check_cases import CASES, Case, found_in

from printprep.check import RULES

# Rules about what was done to a part: a file as it came has no such circumstance.
_OF_OURS = {
    "drain-filled",
    "lean-out-of-reach",
    "nothing-to-hollow",
    "void-filled",
    "void-kept",
    "watertight",
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_what_is_said_is_exactly_what_is_so(case: Case):
    found = found_in(case)
    assert {(item.rule, item.severity) for item in found} == case.wanted
    assert len(found) == len(case.wanted)
    for item in found:
        assert item.fix or item.severity == "info"


def test_every_rule_has_a_case_that_fails_it():
    tried = {rule for case in CASES for rule, _ in case.wanted}
    assert set(RULES) - _OF_OURS == tried
