"""The screens that the golden files hold: the same figures, told at several widths.

To write them anew after a change that is meant:  python3 tests/report/screens.py
Look at what changed (git diff) before you commit it.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from unittest import mock

FOLDER = Path(__file__).with_name("screens")
WIDTHS = (60, 80, 120)


class Terminal(io.StringIO):
    """A stream that a person watches."""

    def isatty(self) -> bool:
        return True


def screen(draw: Callable[[], None], width: int, stream: io.StringIO, **variables: str) -> str:
    """What ``draw`` prints to a stream of a width, with these variables besides COLUMNS."""
    environment = {"TERM": "xterm-256color", "COLUMNS": str(width), "LINES": "40", **variables}
    with (
        mock.patch.object(sys, "stdout", stream),
        mock.patch.dict(os.environ, environment, clear=True),
    ):
        draw()
    return stream.getvalue()


def screens() -> Mapping[str, Callable[[], None]]:
    """What is shown, by name."""
    return {
        "hollow": _hollow,
        "hollow-not-written": _not_written,
        "dry-run": _dry_run,
        "profiles": _profiles,
        "import": _import,
    }


def golden() -> Iterator[tuple[Path, str]]:
    """Every golden file and what it should hold."""
    for name, draw in screens().items():
        for width in WIDTHS:
            yield FOLDER / f"{name}-{width}.txt", screen(draw, width, io.StringIO())
    yield FOLDER / "hollow-80.ansi", screen(_hollow, 80, Terminal())
    yield FOLDER / "hollow-80-no-color.ansi", screen(_hollow, 80, Terminal(), NO_COLOR="1")


def _result():
    from closed_form_parts import hollow_result

    from printprep.types import Finding

    findings = (
        Finding(
            "tilt", "warning",
            "The part tips at 8.2°, and it should stand at 10°: its centre of mass is high over "
            "its narrow feet.",
            "Let the base grow further with --set stability.base_growth_max_mm=6, or ask for less.",
        ),
        Finding("void-filled", "info", "A sealed void of the model was filled: 1.2 cm³."),
    )  # fmt: skip
    return hollow_result(with_base=True, name="figure", findings=findings)


def _hollow() -> None:
    from printprep.cli.console import stdout_console
    from printprep.report.terminal import show_result

    show_result(stdout_console(), _result(), output="figure-hollow.3mf", verbose=False)


def _not_written() -> None:
    from printprep.cli.console import stdout_console
    from printprep.report.terminal import show_result

    show_result(stdout_console(), _result(), output=None, verbose=True)


def _dry_run() -> None:
    from printprep.cli.console import stdout_console
    from printprep.pipeline.dry_run import DryRun
    from printprep.pipeline.job import Job
    from printprep.profiles import load_profile
    from printprep.report.dry_run import show_dry_run
    from printprep.types import Lean

    job = Job(
        Path("orders/2025/a-figure-with-a-rather-long-name-that-a-shop-gave-it.stl"),
        Path("parts/a-figure-with-a-rather-long-name-that-a-shop-gave-it-hollow.3mf"),
        plugs=Path("plugs.3mf"),
        simulate=True,
    )
    profile = load_profile("resin-standard")
    planned = DryRun(job, profile, (58.25, 61.5, 120.0), 182_344, Lean(12.0, 90.0), "none")
    show_dry_run(stdout_console(), planned)


def _profiles() -> None:
    from printprep.cli.console import stdout_console
    from printprep.profile_folders import profile_names
    from printprep.profiles import load_profile
    from printprep.report.profiles import show_profiles

    shipped = [load_profile(name) for name in profile_names()]
    own = [load_profile("sls-pa12").model_copy(update={"name": "workshop"})]
    refused = {"broken": "Profile broken: wall_mm is 0, must be a number between 0.2 and 50."}
    show_profiles(stdout_console(), shipped, own, refused, Path("profiles"))


def _import() -> None:
    from printprep.cli.console import stdout_console
    from printprep.profile_import.keys import Missing, Taken
    from printprep.profile_import.run import Imported
    from printprep.profiles import load_profile
    from printprep.report.profiles import show_import

    done = Imported(
        load_profile("fdm-petg-0.4").model_copy(update={"name": "mine"}),
        "fdm-petg-0.4",
        "OrcaSlicer or Bambu Studio",
        (
            Taken("printer.layer_height_mm", 0.16, "layer_height in process.json"),
            Taken("printer.bed_mm", (256.0, 256.0, 250.0),
                  "printable_area in machine.json, printable_height in machine.json"),
        ),
        (Missing("material.density_g_cm3", "filament_density is in none of the files"),),
        ("0.16mm Optimal @BBL X1C",),
        "",
    )  # fmt: skip
    show_import(stdout_console(), done, Path("profiles/mine.toml"))


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    FOLDER.mkdir(exist_ok=True)
    for file in FOLDER.iterdir():
        file.unlink()
    for path, text in golden():
        path.write_text(text, encoding="utf-8", newline="\n")
