"""Check the viewer's sources and write its bundle, as `python3 dev.py page` does."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(arguments: list[str]) -> int:
    """Exit code of the first npm command that fails, 69 without npm."""
    npm = shutil.which("npm")
    if npm is None:
        sys.stderr.write("dev.py: error: npm is not installed; it comes with Node 18 or newer\n")
        return 69
    last = "check" if arguments == ["--check"] else "build"
    steps = [["run", "--silent", task] for task in ("types", "lint", last)]
    if not _installed():
        steps.insert(0, ["ci", "--no-audit", "--no-fund", "--loglevel=error"])
    for step in steps:
        code = subprocess.run([npm, *step], cwd=HERE, check=False).returncode
        if code:
            return code
    return 0


def _installed() -> bool:
    """Whether the packages of the lock file are there; npm notes what it installed."""
    noted, lock = HERE / "node_modules" / ".package-lock.json", HERE / "package-lock.json"
    return noted.is_file() and noted.stat().st_mtime >= lock.stat().st_mtime


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
