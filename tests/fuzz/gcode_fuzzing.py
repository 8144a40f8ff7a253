"""What both fuzzers of G-code ask: figures that are finite, or an error of the input, in time."""

from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path

import atheris

from printprep.errors import InputError
from printprep.gcode.measure import measure_gcode
from printprep.hook.gcode_file import annotate


def fuzz(arguments: Sequence[str], seeds: Sequence[bytes], suffix: str) -> None:
    """Run the fuzzer.  arguments : the folder of the corpus, and options of libFuzzer."""
    for folder in (Path(word) for word in arguments[1:] if not word.startswith("-")):
        folder.mkdir(parents=True, exist_ok=True)
        for number, seed in enumerate(seeds):
            (folder / f"seed-{number}").write_bytes(seed)
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as name:
        path = Path(name) / f"fuzzed{suffix}"

        def one(content: bytes) -> None:
            path.write_bytes(content)
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # a warning of a library is a find, too
                _measured_or_refused(path)

        atheris.Setup(list(arguments), one)
        atheris.Fuzz()


def _measured_or_refused(path: Path) -> None:
    try:
        printed = measure_gcode(path)
    except InputError as error:
        assert path.name in error.message and len(error.message) < 1000
        return
    figures = [printed.mass_g, printed.tilt_deg, printed.contact_area_mm2]
    assert all(math.isfinite(value) for value in (*figures, *printed.centre_of_mass_mm))
    annotate(path, ["a = 1"])
    again = measure_gcode(path)
    assert (again.mass_g, again.tilt_deg) == (printed.mass_g, printed.tilt_deg)
