"""No byte of a file brings anything out of a reader but what it reads, or a refusal.

Each example is a file that is well, with some bytes changed, cut out, doubled or put in.  The
harness beside this file goes further (CONTRIBUTING.md).
"""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from readers import READERS, Reader, refuses_or_reads

# What breaks programs: limits of numbers, odd words, characters that act.
WORDS = [
    *(b"\x00", b"\xff\xff\xff\xff", b"\x7f\xff\xff\xff", b"-1", b"1e308", b"nan", b"9" * 30),
    *(b"2_0", b'"', b"<", b">", b"[" * 40, b"\\", b"\n", b"\r", b"\x1b[31m", b"\xef\xbb\xbf"),
]


@functools.cache
def reader_of(name: str) -> Reader:
    return READERS[name]()


@st.composite
def damaged(draw: st.DrawFn, seeds: tuple[bytes, ...]) -> bytes:
    content = bytearray(draw(st.sampled_from(seeds)))
    for _ in range(draw(st.integers(0, 6))):
        at = draw(st.integers(0, max(len(content) - 1, 0)))
        how = draw(st.sampled_from(["change", "cut", "double", "word", "end"]))
        if how == "change" and content:
            content[at] = draw(st.integers(0, 255))
        elif how == "cut":
            del content[at : at + draw(st.integers(1, 40))]
        elif how == "double":
            content[at:at] = content[at : at + draw(st.integers(1, 80))]
        elif how == "word":
            word = draw(st.sampled_from(WORDS))
            content[at : at + draw(st.integers(0, len(word)))] = word
        else:
            del content[at:]
    return bytes(content)


@pytest.mark.parametrize("name", list(READERS))
def test_every_seed_is_well(name: str, tmp_path: Path) -> None:
    """Else the fuzz looks at refusals alone."""
    reader = reader_of(name)
    taken = [refuses_or_reads(reader, seed, tmp_path) for seed in reader.seeds]
    assert all(taken) or name == "part"


@pytest.mark.parametrize("name", list(READERS))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damage_is_read_or_refused(name: str, tmp_path: Path, data: st.DataObject) -> None:
    reader = reader_of(name)
    refuses_or_reads(reader, data.draw(damaged(reader.seeds)), tmp_path)
