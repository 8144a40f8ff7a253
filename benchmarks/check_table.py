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

`printprep check FILE` runs every rule on any mesh or 3MF, from any program; `printprep hollow` runs
the same rules on the part it writes. A finding has a rule, a severity, a message, a fix, and where
they make sense a value, its limit, a unit, a place in mm, an area and a volume (`--json`). With
`--fail-on warning|error` a finding of that severity makes the exit code 1.

## How it is measured

- **Thickness** at a point is the diameter of the largest ball that touches the surface there and
  that no facing side cuts into; a side faces where it is within 30° of parallel. Every square
  millimetre has such a point. So edges, corners and facets are not thin; a wedge sharper than 30°
  is. A pin is thin in both directions across, a wall in one. Facets get an allowance of a tenth,
  and surfaces flat on the bed do not count. Around sealed cavities the wall is the exact distance
  of the two surfaces. Against a plate, a shell of a sphere, a wedge and a cone the map is within
  2 % or 0.02 mm everywhere (tests/thickness).
- **Gaps** are measured in the same way in the empty space outside, where two sides stay apart; a
  crease is not a gap.
- **Drainage.** The test follows a ball as wide as the profile's drain on a grid of a sixth of its
  width, and measures the clearance on the triangles themselves where it decides: a hole of the
  ball's own width lets it through, one 0.1 mm narrower does not. A space that the ball cannot leave
  is sealed, or its way out is too narrow, and its width is measured. A space that the ball leaves
  only by rising, as the part stands, is a pool: a warning inside a space twice as wide as its ways
  out, information in the open, as in a mug. Pockets smaller than the ball do not count.
- **Suction cups** are empty regions of a layer with no way to the outside through the layers up to
  it; the plate closes what opens to it. Layers are a two-hundredth of the longest side.
- **Unsupported ceilings** follow the slicer's own acceptance rule, layer by layer.
- **The file's own triangles** are checked before any repair.
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
        f"{len(found)} solids in closed form, most of them just on one side of a limit "
        "(tests/check/check_cases.py; this page is written by benchmarks/check_table.py). "
        "Rules without a failing case report what `hollow` did.",
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
