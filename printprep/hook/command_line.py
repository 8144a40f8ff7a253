"""The line to paste into the slicer, so that it runs the hook after every export.

On Linux and macOS, PrusaSlicer passes the line to the shell.  On Windows it splits the line by the
rules of Windows, and the first word must be an existing file.  The path of the G-code follows as
the last word.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Sequence


def setting_line(options: Sequence[str], *, windows: bool | None = None) -> str:
    """The line for Print Settings → Output options → Post-processing scripts.

    options : those of ``printprep hook``.
    windows : whether it is quoted by the rules of Windows, None for those of this machine.
    """
    words = [sys.executable, "-m", "printprep", "hook", *options]
    if sys.platform == "win32" if windows is None else windows:
        return subprocess.list2cmdline(words)
    return shlex.join(words)
