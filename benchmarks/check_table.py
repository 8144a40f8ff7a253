"""Try every rule on every closed-form case, and table misses and false alarms.

    python benchmarks/check_table.py -o docs/checks.md

The cases are those of tests/check/check_cases.py.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "check"))

from check_cases import CASES, Case, found_in

from printprep.check import RULES
from printprep.types import Finding

_INTRO = """\
# What is checked, and how far the checks can be trusted

`printprep check FILE` runs every rule on any mesh or 3MF, whichever program made it.
`printprep hollow` runs the same rules on what it writes. This page says how the rules measure, and
how they did on models whose answer is known.

A finding has a rule, a severity, a sentence for the person who prints and a fix for the person who
changes the model. Where it makes sense it also has a value, its limit, a unit, a place in mm, an
area and a volume (see `--json`). With `--fail-on warning` or `--fail-on error` the exit code is 1
when a finding reaches that level.

## How each rule measures

- **Thickness.** There is one measuring point per square millimetre of surface. At each point
  printprep takes the largest ball that touches the surface there and that no facing side cuts into.
  A side faces the point when it is within 30° of parallel. So edges, corners and facets do not
  count as thin, and a wedge counts only where it is sharper than 30°. A place that is thin in both
  directions across is a pin; a place that is thin in one direction is a wall. Facets are allowed a
  tenth of the limit. What lies flat on the bed does not count. Around sealed cavities, the wall is
  the exact distance between the two surfaces. On a plate, a spherical shell, a wedge and a cone the
  map is within 2 % or 0.02 mm everywhere (tests/thickness).
- **Gaps.** They are measured in the same way, in the empty space outside. Two sides form a gap
  where they stay apart; a crease is not a gap.
- **Draining.** printprep follows a ball as wide as the drain hole of the profile. The grid is a
  sixth of the ball's width; where it matters, the clearance is measured on the triangles
  themselves. A hole as wide as the ball lets it through, a hole 0.1 mm narrower does not. A space
  that the ball cannot leave at all is sealed, or its way out is too small; then the width of the
  way out is measured. A space that the ball can leave only by rising, as the part stands, holds a
  pool. A pool is a warning in a space at least twice as wide as its ways out, and information in
  the open, as in a mug. Pockets smaller than the ball are left out.
- **Suction cups.** A cup is an empty region of a layer with no way to the outside through the
  layers up to its own. The plate closes whatever opens toward it. A layer is a two-hundredth of the
  longest side.
- **Unsupported ceilings** are found by the slicer's own rule for support, layer by layer.
- **The triangles of the file** are checked before anything is repaired.
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-o", "--output", type=Path, required=True, help="markdown page")
    arguments = parser.parse_args()
    found = [(case, found_in(case)) for case in CASES]
    arguments.output.write_text(page(found), encoding="utf-8")
    wrong = sum(
        {(item.rule, item.severity) for item in items} != case.wanted for case, items in found
    )
    return 1 if wrong else 0


def page(found: list[tuple[Case, tuple[Finding, ...]]]) -> str:
    return "\n".join([_INTRO, *_rules(found), "", *_cases(found), ""])


def _rules(found: list[tuple[Case, tuple[Finding, ...]]]) -> list[str]:
    counts: dict[str, Counter[str]] = {rule: Counter() for rule in RULES}
    for case, items in found:
        wanted = {rule for rule, _ in case.wanted}
        reported = {item.rule for item in items}
        for rule, count in counts.items():
            count[
                ("found" if rule in reported else "missed")
                if rule in wanted
                else ("false" if rule in reported else "silent")
            ] += 1
    lines = [
        "## Every rule on every case",
        "",
        f"The cases are {len(found)} solids in closed form, most of them just on one side of a "
        "limit (tests/check/check_cases.py). This page is written by benchmarks/check_table.py. "
        "Rules without a failing case are about what `hollow` itself did.",
        "",
        "| rule | what for | found | missed | false alarms | rightly silent |",
        "|---|---|---|---|---|---|",
    ]
    for rule, check in RULES.items():
        count = counts[rule]
        what = " ".join((check.__doc__ or "").split("\n\n")[0].split())
        lines.append(
            f"| `{rule}` | {what} | {count['found']} | {count['missed']} | {count['false']} | "
            f"{count['silent']} |"
        )
    return lines


def _cases(found: list[tuple[Case, tuple[Finding, ...]]]) -> list[str]:
    lines = ["## The cases", "", "| solid | process | findings |", "|---|---|---|"]
    for case, items in found:
        text = "; ".join(_finding_text(item) for item in items) or "nothing"
        lines.append(f"| {case.name} | {case.process} | {text} |")
    return lines


def _finding_text(item: Finding) -> str:
    text = f"{item.severity} `{item.rule}`"
    if item.value is not None:
        text += f" {item.value:.4g}"
        text += f" of {item.limit:.4g}" if item.limit is not None else ""
        text += f" {item.unit}" if item.unit else ""
    return text


if __name__ == "__main__":
    sys.exit(main())
