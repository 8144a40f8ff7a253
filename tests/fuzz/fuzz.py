"""Fuzzes one reader with atheris, guided by coverage, for as long as you like.

    pip install 'printprep[fuzz]'
    python tests/fuzz/fuzz.py stl corpus/stl -max_total_time=1200 -rss_limit_mb=2048 -timeout=60

The first argument names a reader (those of readers.py), the others are libFuzzer's: a folder for
the corpus, which is filled with the seeds, and its options.  A find is written as crash-…; make it
a case of the tests.
"""

from __future__ import annotations

import importlib
import sys
import tempfile
import warnings
from pathlib import Path

import atheris

ROOT = Path(__file__).resolve().parent
sys.path[:0] = [str(ROOT), str(ROOT.parent.parent)]

with atheris.instrument_imports(include=["printprep"]):
    for name in (
        "printprep.cli.batch_table",
        "printprep.generators.model",
        "printprep.mesh.read",
        "printprep.mesh.subtract",
        "printprep.profiles",
        "printprep.threemf.read",
        "printprep.verify.part_3mf",
    ):
        importlib.import_module(name)
    readers = importlib.import_module("readers")


def main(arguments: list[str]) -> None:
    """Fuzz the reader that the first argument names."""
    if len(arguments) < 2 or arguments[1] not in readers.READERS:
        sys.exit(f"Name a reader: {', '.join(readers.READERS)}.")
    reader = readers.READERS[arguments[1]]()
    rest = arguments[2:]
    for folder in (Path(word) for word in rest if not word.startswith("-")):
        folder.mkdir(parents=True, exist_ok=True)
        for number, seed in enumerate(reader.seeds):
            (folder / f"seed-{number}").write_bytes(seed)
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as name:

        def one(content: bytes) -> None:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # a warning of a library is a find, too
                readers.refuses_or_reads(reader, content, Path(name))

        atheris.Setup([arguments[0], *rest], one)
        atheris.Fuzz()


if __name__ == "__main__":
    main(sys.argv)
