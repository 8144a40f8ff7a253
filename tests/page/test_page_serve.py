"""`view --serve` in a real browser: change a setting, wait, the figures follow, take the part."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

import pytest
from closed_form_parts import box
from judges import read_strictly
from test_page_browser import start  # noqa: F401  (a fixture)

from printprep.mesh.measure import from_arrays
from printprep.mesh.write import to_bytes

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.xdist_group("browser")]


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """The address that the command prints, of a server on a cube of 20 mm."""
    folder = tmp_path_factory.mktemp("served")
    (folder / "cube.stl").write_bytes(to_bytes(box(20.0), ".stl"))
    command = [sys.executable, "-m", "printprep", "view", "cube.stl", "-p", "resin-standard"]
    with subprocess.Popen(
        [*command, "--wall", "3", "--serve", "--no-browser"],
        cwd=folder,
        stdout=subprocess.PIPE,
        encoding="utf-8",
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    ) as server:
        yield server.stdout.readline().split()[-1]
        server.send_signal(signal.SIGINT)  # Ctrl-C
        assert server.wait(timeout=20) == 130  # as every run that is interrupted


def test_a_setting_is_tried_and_the_part_taken(start, address, tmp_path):  # noqa: F811
    window = start(offline=False)
    window.open(address)
    assert "As it is" in window.text("#kicker")
    assert not window.find("#download").is_displayed()
    for wall in ("-1", "2"):
        window.run("document.querySelector('[name=wall]').value = arguments[0]", wall)
        window.press("#settings button")
        done = "return /^(Done|Profile)/.test(document.getElementById('run-status').textContent)"
        window.wait(done, seconds=90)
        time.sleep(0.1)
        if wall == "-1":
            assert "wall_mm is -1.0" in window.text("#run-status")
            window.run("document.getElementById('run-status').textContent = ''")
    assert "Hollowed" in window.text("#kicker")
    assert "profile: 2 mm" in window.text(".cards")
    assert "--wall 2" in window.text("#figures")
    assert window.find("#download").is_displayed()
    assert [e for e in window.errors() if "400" not in e] == []
    part = tmp_path / "part.3mf"
    with urllib.request.urlopen(f"{address}part.3mf") as answer:
        part.write_bytes(answer.read())
    mesh, warnings = read_strictly(part)
    assert warnings == []
    # A wall of 2 mm around a cube of 20 mm: at least 16³ mm³ are gone, but for what drains need
    assert 20.0**3 - 16.0**3 < from_arrays(mesh.vertices, mesh.faces).volume() * 1.1 < 5000


@pytest.mark.parametrize("path", ["../", "../../etc/passwd", "x", "%2e%2e/"])
def test_the_command_gives_nothing_else(address, path):
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(address + path)
    with refused.value as answer:
        assert answer.code == 404 and answer.read() == b""
