"""Disks that are full, streams that are closed, places that are not writable, too little memory."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fault_runs import PROGRAM, clear, done, names

from printprep.errors import OutputError
from printprep.files import refuse_impossible_target, replacing, write_atomically
from printprep.mesh.write import to_bytes

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="POSIX limits, /dev/full")


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    from manifold3d import Manifold

    path = tmp_path / "ball.stl"
    path.write_bytes(to_bytes(Manifold.sphere(12, 48), ".stl"))
    return path


@pytest.fixture
def block(tmp_path: Path) -> Path:
    """A block too small to hollow, which takes a second."""
    from manifold3d import Manifold

    path = tmp_path / "block.stl"
    path.write_bytes(to_bytes(Manifold.cube((5, 5, 5)), ".stl"))
    return path


@pytest.fixture
def work(tmp_path: Path) -> Path:
    folder = tmp_path / "work"
    folder.mkdir()
    return folder


def limited(kind: int, size: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(kind, (size, size))


@pytest.mark.parametrize("suffix", [".3mf", ".stl"])
def test_a_full_disk_leaves_the_old_file(block: Path, work: Path, suffix: str):
    out = work / f"out{suffix}"
    out.write_bytes(b"old")
    form = ["--json"] if suffix == ".stl" else []
    run = done(
        ["hollow", block, "-o", out, "--resolution", "16", *form], work,
        preexec_fn=limited(resource.RLIMIT_FSIZE, 512),
    )  # fmt: skip
    assert run.returncode == 5
    assert '"code": "output"' in run.stdout if form else clear(run.stderr)
    assert out.read_bytes() == b"old"
    assert names(work) == [out.name]


@pytest.mark.slow
def test_a_real_disk_that_is_full(ball: Path, work: Path):
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(work)],
        capture_output=True, check=False,
    )  # fmt: skip
    if mounted.returncode != 0:
        pytest.skip("no right to mount a file system")
    try:
        (work / "out.3mf").write_bytes(b"old")
        run = done(["hollow", ball, "-o", work / "out.3mf"], work.parent)
        assert run.returncode == 5 and clear(run.stderr)
        assert "No space left on device" in run.stderr
        assert (work / "out.3mf").read_bytes() == b"old"
        assert names(work) == ["out.3mf"]
    finally:
        subprocess.run(["umount", str(work)], check=True)


@pytest.mark.parametrize("arguments", [["profiles"], ["profiles", "--json"], ["--help"]])
def test_standard_output_that_takes_nothing_is_told(work: Path, arguments: list[str]):
    with Path("/dev/full").open("w") as full:
        run = done(arguments, work, stdout=full, stderr=subprocess.PIPE)
    assert run.returncode == 5
    assert clear(run.stderr) and "No space left on device" in run.stderr


def test_a_reader_that_goes_away_is_told(work: Path):
    reading, writing = os.pipe()
    os.close(reading)
    run = done(["profiles"], work, stdout=writing, stderr=subprocess.PIPE)
    os.close(writing)
    assert run.returncode == 5
    assert clear(run.stderr) and "closed by its reader" in run.stderr


@pytest.mark.parametrize("closed", ["0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"])
def test_closed_streams_change_nothing(block: Path, work: Path, closed: str):
    out = work / "out.stl"
    line = f'"$@" {closed}'
    arguments = [*PROGRAM, "hollow", str(block), "-o", str(out), "--resolution", "16"]
    run = subprocess.run(["sh", "-c", line, "sh", *arguments], capture_output=True, check=False)
    assert run.returncode == 0
    assert out.read_bytes()[80:84] != b"" and len(out.read_bytes()) % 50 == 34  # a whole STL
    assert names(work) == ["out.stl"]


def test_a_stderr_that_is_full_changes_no_code(work: Path):
    with Path("/dev/full").open("w") as full:
        run = done(["check", "none.stl"], work, stdout=subprocess.PIPE, stderr=full)
    assert run.returncode == 3


def test_a_home_that_is_not_writable_changes_nothing(block: Path, work: Path):
    home = {"HOME": "/proc/nowhere", "XDG_CACHE_HOME": "/proc/nowhere", "XDG_CONFIG_HOME": "/proc"}
    out = work / "out.3mf"
    run = done(["hollow", block, "-o", out, "--resolution", "16"], work, environment=home)
    assert (run.returncode, run.stderr) == (0, "")
    assert names(work) == ["out.3mf"]


def test_no_place_for_temporary_files_is_told(work: Path, block: Path):
    """Only what starts another program needs one."""
    fake = work.parent / "slicer.sh"
    fake.write_text("#!/bin/sh\necho PrusaSlicer-2.9.0\n")
    fake.chmod(0o755)
    run = done(
        ["hollow", block, "-o", work / "o.3mf", "--fill", "infill", "--slicer", fake], work,
        preexec_fn=limited(resource.RLIMIT_FSIZE, 0),
    )  # fmt: skip
    assert run.returncode == 5 and clear(run.stderr), run.stderr
    assert names(work) == []


@pytest.mark.slow
@pytest.mark.parametrize("kib", [200_000, 400_000, 700_000, 1_000_000])
def test_too_little_memory_is_no_defect(ball: Path, work: Path, kib: int):
    (work / "out.3mf").write_bytes(b"old")
    run = done(
        ["hollow", ball, "-o", work / "out.3mf"], work,
        preexec_fn=limited(resource.RLIMIT_AS, kib << 10),
    )  # fmt: skip
    assert run.returncode in (0, 3)
    assert "Traceback" not in run.stderr
    if run.returncode == 3:
        assert "printprep: error: The memory of this machine" in run.stderr
        assert (work / "out.3mf").read_bytes() == b"old"
    assert names(work) == ["out.3mf"]


def test_a_link_stays_a_link(tmp_path: Path):
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "real.stl", tmp_path / "link.stl"
    link.symlink_to(target)
    for content in (b"first", b"second"):  # the first time the link leads nowhere yet
        write_atomically(link, content)
        assert link.is_symlink() and target.read_bytes() == content
    assert names(tmp_path / "far") == ["real.stl"]


def test_what_is_no_plain_file_is_refused_and_stays(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "device.stl").symlink_to("/dev/null")
    (tmp_path / "loop.stl").symlink_to("loop.stl")
    for name in ("pipe.stl", "device.stl", "loop.stl"):
        with pytest.raises(OutputError):
            refuse_impossible_target(tmp_path / name)
        with pytest.raises(OutputError):
            write_atomically(tmp_path / name, b"x")
    assert names(tmp_path) == ["device.stl", "loop.stl", "pipe.stl"]
    assert (tmp_path / "pipe.stl").is_fifo()


def test_a_read_only_file_is_not_replaced(block: Path, work: Path):
    out = work / "out.stl"
    out.write_bytes(b"old")
    out.chmod(0o444)
    run = done(["hollow", block, "-o", out], work)
    assert run.returncode == 5 and clear(run.stderr) and "read-only" in run.stderr
    assert out.read_bytes() == b"old"


def test_a_folder_that_is_not_writable_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    with monkeypatch.context() as patch:  # root may write anywhere
        patch.setattr("printprep.files.os.access", lambda path, mode: Path(path) != tmp_path)
        with pytest.raises(OutputError, match="not writable"):
            refuse_impossible_target(tmp_path / "out.stl")


def test_names_as_long_as_the_system_takes(tmp_path: Path):
    write_atomically(tmp_path / ("n" * 251 + ".stl"), b"x")
    write_atomically(tmp_path / ("n" * 251 + ".stl"), b"y")
    with pytest.raises(OutputError, match="too long"):
        refuse_impossible_target(tmp_path / ("n" * 252 + ".stl"))
    assert len(names(tmp_path)) == 1


@pytest.mark.parametrize("nameless", [True, False])
def test_without_permission_bits_the_file_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nameless: bool
):
    def refused(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("printprep.files.os.fchmod", refused)
    if not nameless:
        monkeypatch.delattr("printprep.files.os.O_TMPFILE")
    for content in (b"first", b"second"):
        with replacing(tmp_path / "out.stl") as out:
            out.write(content)
        assert (tmp_path / "out.stl").read_bytes() == content
    assert names(tmp_path) == ["out.stl"]


@pytest.mark.slow
def test_twenty_runs_in_one_folder_do_not_disturb_each_other(ball: Path, work: Path):
    """Half of them write the same file."""
    runs = [
        subprocess.Popen(
            [*PROGRAM, "hollow", str(ball), "--resolution", "16", "-q", "-o",
             f"out{max(0, k - 10)}.3mf"],
            cwd=work, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )
        for k in range(20)
    ]  # fmt: skip
    for run in runs:
        out, err = run.communicate(timeout=300)
        assert (run.returncode, out, err) == (0, b"", b"")
    assert names(work) == sorted(f"out{k}.3mf" for k in range(10))
    assert len({(work / name).read_bytes() for name in names(work)}) == 1


@pytest.mark.slow
def test_the_bytes_depend_on_no_surrounding(ball: Path, work: Path):
    surroundings = [
        {},
        {"PYTHONHASHSEED": "1"},
        {"PYTHONHASHSEED": "4242"},
        {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        {"OMP_NUM_THREADS": "7"},
        {"LC_ALL": "C"},
        {"LC_ALL": "de_DE.UTF-8", "TZ": "Asia/Kathmandu"},
        {"LANG": "tr_TR.UTF-8"},
    ]
    made = set()
    for suffix in (".3mf", ".stl"):
        for environment in surroundings:
            out = work / f"out{suffix}"
            run = done(["hollow", ball, "-o", out, "-q"], work, environment=environment)
            assert run.returncode == 0, run.stderr
            made.add((suffix, out.read_bytes()))
    assert len(made) == 2
