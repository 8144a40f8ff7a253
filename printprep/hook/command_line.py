"""The line a user pastes into the slicer, so that it runs the hook after every export.

PrusaSlicer hands the line to the shell on Linux and macOS, and splits it by Windows' own rules
there, where the first word must be a file that exists; the G-code's path follows as last word.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Sequence


def setting_line(options: Sequence[str], *, windows: bool | None = None) -> str:
    """The line for Print Settings → Output options → Post-processing scripts.

    options : of ``printprep hook``;  windows : by whose rules it is quoted, None for this machine.
    """
    words = [sys.executable, "-m", "printprep", "hook", *options]
    if sys.platform == "win32" if windows is None else windows:
        return subprocess.list2cmdline(words)
    return shlex.join(words)
