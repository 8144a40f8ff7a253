"""Profiles that are no profiles: nesting, thousands of digits, marks, what has no end."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from printprep.errors import UsageError
from printprep.profiles import load_profile, profile_source

SOURCE = profile_source("sls-pa12")


def wall(text: str) -> str:
    lines = [f"wall_mm = {text}" if ln.startswith("wall_mm") else ln for ln in SOURCE.splitlines()]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "fact"),
    [
        ("[" * 12_000, "nested too deep"),
        ("{a=" * 12_000, "nested too deep"),
        ("9" * 5000, "not valid TOML"),
        ("nan", "wall_mm is nan"),
        ("inf", "wall_mm is inf"),
        ("1e999", "wall_mm is inf"),
        (f'"{"x" * 100_000}"', "characters"),
    ],
)
def test_values_that_no_profile_has(tmp_path: Path, text: str, fact: str) -> None:
    path = tmp_path / "p.toml"
    path.write_text(wall(text), encoding="utf-8")
    began = time.process_time()
    with pytest.raises(UsageError, match=fact) as caught:
        load_profile(path)
    assert len(caught.value.message) < 600
    with pytest.raises(UsageError, match="wall_mm") as caught:
        load_profile("sls-pa12", {"wall_mm": text})
    assert len(caught.value.message) < 600
    assert time.process_time() - began < 1.0


def test_a_mark_of_the_byte_order_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(SOURCE, encoding="utf-8-sig")
    assert load_profile(path).wall_mm == load_profile("sls-pa12").wall_mm


@pytest.mark.skipif(sys.platform == "win32", reason="has no devices in folders")
def test_what_has_no_end_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.symlink_to("/dev/zero")
    with pytest.raises(UsageError, match="is not a plain file"):
        load_profile(path)
    large = tmp_path / "q.toml"
    with large.open("wb") as file:
        file.truncate(20 << 30)
    with pytest.raises(UsageError, match="at most 1 MiB"):
        load_profile(large)
    with pytest.raises(UsageError, match="no profile named"):
        load_profile("a\0b")
