"""Fuzzes the reader of binary G-code with atheris, guided by coverage.

    pip install atheris
    python tests/fuzz/fuzz_bgcode.py corpus/bgcode -max_total_time=1200 -rss_limit_mb=2048

The seeds have no checksums, which would stop nearly every change at the door.  A find is written as
crash-…; make it a case of tests/bgcode/test_bgcode.py.
"""

from __future__ import annotations

import sys
from pathlib import Path

import atheris

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
sys.path[:0] = [str(ROOT), *(str(TESTS / room) for room in ("gcode", "bgcode", "fuzz"))]

with atheris.instrument_imports(include=["printprep"]):
    from bgcode_files import binary, block
    from gcode_fuzzing import fuzz
    from gcode_texts import beads

    import printprep.bgcode.content
    import printprep.gcode.accumulate
    import printprep.gcode.source  # noqa: F401  what is imported late is instrumented too

TEXT = beads(lines=2, layers=1).encode()
THUMBNAIL = block(5, b"\x89PNG", checksum=False)
SEEDS = (
    *(binary(TEXT, how=how, encoding=how % 3, checksum=False) for how in range(4)),
    binary(TEXT, encoding=1, checksum=False, extra=[THUMBNAIL, block(4, b"a=1\n", checksum=False)]),
    binary(TEXT),
)

if __name__ == "__main__":
    fuzz(sys.argv, SEEDS, ".bgcode")
