"""What a reader has to say reaches the user of every command, under one id."""

from __future__ import annotations

import struct
from pathlib import Path

from manifold3d import Manifold

from printprep.check.reading import reading_findings
from printprep.mesh.write import to_bytes
from printprep.pipeline.check import check
from printprep.pipeline.hollow import hollow
from printprep.pipeline.simulate import simulate
from printprep.types import ReadNote


def test_a_note_is_a_finding_of_its_kind() -> None:
    note = ReadNote("cut-short", "The file is cut short.", "Download it again.")
    (found,) = reading_findings([note])
    assert (found.rule, found.severity) == ("cut-short", "warning")
    assert (found.message, found.fix) == (note.message, note.fix)


def test_check_hollow_and_simulate_say_what_was_read(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    data = to_bytes(Manifold.cube((30, 30, 30)), ".stl")
    path.write_bytes(data[:80] + struct.pack("<I", 0) + data[84:])
    for found in (check(path), hollow(path, resolution=12, self_support=False), simulate(path)):
        assert [item.rule for item in found.findings].count("facet-count") == 1
