"""Every recipe of docs/cookbook.md runs as it stands, and does what it says it does."""

from __future__ import annotations

import csv
import re
import runpy
import shlex
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from command_lines import missing_targets, unknown_options

from printprep.cli.run import run
from printprep.output.figures import Figures
from printprep.threemf.read import ATTACHMENT, read_3mf

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "cookbook.md"
_BLOCK = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```$", re.S | re.M)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, the file it is (empty for commands), its text."""

    language: str
    file: str
    text: str


@dataclass(frozen=True)
class Line:
    """A command: its words without comments, and the exit code that the page names, or 0."""

    words: tuple[str, ...]
    code: int


def recipes() -> dict[str, list[Block]]:
    """The blocks of each recipe, by its title."""
    sections = PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    return {
        section.split("\n", 1)[0]: [Block(*found) for found in _BLOCK.findall(section)]
        for section in sections
    }


def lines(block: Block) -> list[Line]:
    """The commands of a block of commands."""
    found = []
    for line in block.text.splitlines():
        named = re.search(r"# exit code (\d+)$", line)
        words = tuple(shlex.split(line, comments=True))
        found.append(Line(words, int(named[1]) if named else 0))
    return found


def all_lines() -> list[Line]:
    return [
        line
        for blocks in recipes().values()
        for block in blocks
        if block.language == "sh"
        for line in lines(block)
    ]


def figures(path: Path) -> Figures:
    return Figures.from_json(read_3mf(path).attachments[ATTACHMENT])


def rules(path: Path) -> set[str]:
    return {finding.rule for finding in figures(path).findings}


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as table:
        return list(csv.DictReader(table))


def figurine(folder: Path, said: str) -> None:
    """It fell over; now it stands, on a base, and the engine agrees."""
    part = figures(folder / "goathead.3mf")
    assert part.tilt_solid_deg is not None and part.tilt_solid_deg < 0
    assert part.tilt_deg is not None and part.tilt_deg >= 10
    assert part.base is not None
    assert part.mass_g < part.solid_mass_g
    assert "stands for 10 s" in said
    assert "<svg" in (folder / "curve.svg").read_text(encoding="utf-8")
    for page in ("goathead.html", "goathead-part.html"):
        assert "<!doctype html>" in (folder / page).read_text(encoding="utf-8").lower()


def bust(folder: Path, said: str) -> None:
    """The first try is not written, and names 4 mm; the second drains, stands, and has plugs."""
    assert "a footprint grown by 4 mm" in " ".join(said.split())
    part = figures(folder / "bust.3mf")
    assert part.tilt_deg is not None and part.tilt_deg >= 10
    assert part.drains is not None
    kinds = [drain.role for drain in part.drains.items]
    assert {"outlet", "vent"} <= set(kinds)
    assert len(read_3mf(folder / "plugs.3mf").spans) == len(kinds)


def powder(folder: Path, said: str) -> None:
    """No vaults, walls as named, and a way out."""
    part = figures(folder / "bottle.3mf")
    assert part.supports is None
    assert part.wall_min_mm is not None and part.wall_min_mm >= 1.15
    assert part.drains is not None and part.drains.items
    assert "sealed-cavity" not in rules(folder / "bottle.3mf")
    assert (folder / "bottle-plugs.3mf").is_file()


def hundred(folder: Path, said: str) -> None:
    """Ten, then a hundred, then none again; three by the table, each with its page."""
    assert [row["status"] for row in rows(folder / "trial" / "summary.csv")] == ["part"] * 10
    made = rows(folder / "parts" / "summary.csv")
    assert [row["status"] for row in made] == ["part"] * 100
    assert "100 models complete and unchanged: skipped" in said
    for name, profile in (("small", "fdm-pla-0.4"), ("large", "fdm-pla-0.6")):
        assert figures(folder / "orders" / f"{name}.3mf").profile == profile
    assert figures(folder / "orders" / "bottle.3mf").drains is not None
    summary = (folder / "orders" / "summary.html").read_text(encoding="utf-8")
    for name in ("small", "large", "bottle"):
        assert (folder / "orders" / f"{name}.html").is_file()
        assert f'href="./{name}.html"' in summary


def scan(folder: Path, said: str) -> None:
    """It was open, and is closed, at the size that was named."""
    assert "[open-surface]" in said
    part = figures(folder / "scan.3mf")
    assert part.repair.rung != "as-is"
    assert part.tilt_deg is not None and part.tilt_deg >= 10
    low, high = part.bounds_mm
    assert max(np.subtract(high, low)) == pytest.approx(60, abs=0.1)
    assert (folder / "scan.html").is_file()


def voxels(folder: Path, said: str) -> None:
    """Less material in the same form; and the printed part stands."""
    before, after = np.load(folder / "figure.npy"), np.load(folder / "material.npy")
    assert (after.shape, after.dtype) == (before.shape, before.dtype)
    assert 0 < after.sum() < before.sum()
    part = figures(folder / "figure.3mf")
    assert part.tilt_deg is not None and part.tilt_deg >= 10


CHECKS: Mapping[str, Callable[[Path, str], None]] = {
    "A figurine that tips": figurine,
    "A resin bust": bust,
    "A powder part": powder,
    "A hundred models": hundred,
    "A scan with holes": scan,
    "Generated voxels": voxels,
}


@pytest.mark.slow
@pytest.mark.parametrize("title", CHECKS)
def test_a_recipe_runs_and_keeps_its_word(title, tmp_path, monkeypatch, capsys):
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    said = ""
    for block in recipes()[title]:
        if block.file:
            Path(block.file).write_text(block.text, encoding="utf-8")
            continue
        for line in lines(block):
            if line.words[0] == "python3":
                runpy.run_path(line.words[1], run_name="__main__")
            else:
                there = set(tmp_path.rglob("*"))
                assert run(line.words[1:]) == line.code, line.words
                assert line.code == 0 or set(tmp_path.rglob("*")) == there
            printed = capsys.readouterr()
            said += printed.out + printed.err
    CHECKS[title](tmp_path, said)


def test_every_recipe_has_its_check_and_its_link():
    assert list(recipes()) == list(CHECKS)
    page = PAGE.read_text(encoding="utf-8")
    for title in CHECKS:
        assert f"- [{title}](#{title.lower().replace(' ', '-')})" in page


def test_every_block_is_a_file_or_commands():
    for blocks in recipes().values():
        for block in blocks:
            assert (block.language == "sh") == (not block.file), block


@pytest.mark.parametrize("line", all_lines(), ids=lambda line: " ".join(line.words[:3]))
def test_every_command_can_be_parsed(line):
    """So that an option that is renamed is found without running the recipe."""
    program, name, *rest = line.words
    scripts = {block.file for blocks in recipes().values() for block in blocks}
    if program == "python3":
        assert name in scripts and not rest
        return
    assert program == "printprep"
    assert unknown_options([name, *rest]) == set()


def test_every_model_is_a_sample_or_made_by_the_recipe():
    page = PAGE.read_text(encoding="utf-8")
    for name in re.findall(r"samples/[\w-]+\.\w+", page):
        assert (ROOT / name).is_file()


def test_pages_that_are_linked_exist():
    assert missing_targets(PAGE) == []
