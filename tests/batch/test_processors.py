"""A worker is bound to its share of the processors, once, with all its threads."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(
    not hasattr(os, "sched_setaffinity"), reason="this system binds no processes"
)

CODE = """
import os, threading, time
from printprep.processors import bind
threading.Thread(target=time.sleep, args=(2,), daemon=True).start()
before = sorted(os.sched_getaffinity(0))
counts = [bind({slot}, {slots}) for _ in range(3)]
sets = {{tuple(sorted(os.sched_getaffinity(int(task)))) for task in os.listdir("/proc/self/task")}}
print(len(before), counts, len(sets), sorted(sets)[0])
"""


@pytest.mark.parametrize("slots", [1, 2, 1000])
def test_all_threads_have_the_same_share_however_often_it_is_asked(slots):
    code = CODE.format(slot=slots - 1, slots=slots)
    out = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True, timeout=60
    ).stdout
    total, rest = int(out.split(" ", 1)[0]), out.split(" ", 1)[1]
    share = max(1, total // slots)
    assert rest.startswith(f"[{share}, {share}, {share}] 1 (")
