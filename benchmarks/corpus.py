"""Hollow and check every model file in a folder, each in a process of its own, and table outcomes.

    python benchmarks/corpus.py FOLDER -o table.md [-p PROFILE] [--size MM] [--timeout 120]

Each part that is written is judged by lib3mf, trimesh, libigl and manifold3d (tests/promises.py).
A file that is refused, with its exit code and without a traceback, is an outcome like any other.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

SUFFIXES = (".stl", ".obj", ".ply", ".glb", ".3mf", ".npz", ".npy", ".pt")
_JUDGE = """
import json, sys
from pathlib import Path
from printprep import hollow
from promises import broken_promises
model, profile, size = sys.argv[1:]
result = hollow(Path(model), profile=profile, size_mm=float(size) if size else None)
print(json.dumps(broken_promises(result, result.solid.whole, again=None)))
"""


@dataclass(frozen=True)
class Ended:
    """How a child process ended.

    code : exit code, negative for a signal, None where it ran out of time;  mib : peak memory.
    """

    code: int | None
    seconds: float
    mib: float
    out: str
    err: str


def run(arguments: list[str], timeout_s: float) -> Ended:
    """Run a child process and measure it."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(_paths())}
    started = time.monotonic()
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(
            arguments, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=environment
        )
        code: int | None = None
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                child.returncode = code = os.waitstatus_to_exitcode(status)
                break
            if time.monotonic() - started > timeout_s:
                child.kill()
                _, _, usage = os.wait4(child.pid, 0)
                child.returncode = -9
                break
            time.sleep(0.02)
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read(1 << 20).decode("utf-8", "replace"))
    return Ended(code, time.monotonic() - started, usage.ru_maxrss / 1024, *texts)


def _paths() -> list[str]:
    root = Path(__file__).resolve().parent.parent
    return [str(root), str(root / "tests"), os.environ.get("PYTHONPATH", "")]


def row_of(file: Path, profile: str, size: float | None, timeout_s: float) -> list[str]:
    """Part, exit codes and error code, seconds, MiB, promises kept."""
    sized = [] if size is None else ["--size", f"{size:g}"]
    printprep = [sys.executable, "-m", "printprep"]
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.3mf"
        made = run(
            [*printprep, "hollow", str(file), "-p", profile, *sized, "--json", "-o", str(part)],
            timeout_s,
        )
        checked = run([*printprep, "check", str(file), "-p", profile, *sized, "--json"], timeout_s)
        kept = "—"
        if part.exists():
            size_text = "" if size is None else f"{size:g}"
            judged = run(
                [sys.executable, "-c", _JUDGE, str(file), profile, size_text], 2 * timeout_s
            )
            try:
                broken = json.loads(judged.out.splitlines()[-1])
                kept = "all" if not broken else "; ".join(broken)
            except (IndexError, ValueError):
                kept = f"not judged: {(judged.err.splitlines() or ['out of time'])[-1]}"
    traceback = "Traceback" in made.err + checked.err
    return [
        file.name,
        _code(made) + (" with a traceback" if traceback else ""),
        _code(checked),
        f"{made.seconds:.1f}",
        f"{max(made.mib, checked.mib):.0f}",
        kept,
    ]


def _code(ended: Ended) -> str:
    """Exit code and the error's own code, as --json tells it."""
    if ended.code is None:
        return "out of time"
    try:
        error = json.loads(ended.out).get("error")
    except ValueError:
        return str(ended.code)
    return f"{ended.code} {error['code']}" if error else str(ended.code)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="Markdown table")
    parser.add_argument("-p", "--profile", default="fdm-pla-0.4")
    parser.add_argument("--size", type=float, help="longest side in mm; default: as in the file")
    parser.add_argument("--timeout", type=float, default=120.0, help="seconds a command may take")
    given = parser.parse_args()
    head = ["part", "hollow", "check", "seconds", "MiB", "promises kept"]
    lines = [f"| {' | '.join(head)} |", "|" + " --- |" * len(head)]
    files = sorted(f for f in given.folder.rglob("*") if f.suffix.lower() in SUFFIXES)
    for file in files:
        row = row_of(file, given.profile, given.size, given.timeout)
        lines.append(f"| {' | '.join(cell.replace('|', '/') for cell in row)} |")
        print(lines[-1], flush=True)
        given.output.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
