"""dev.py: what each task runs, when it installs, what it says where it cannot. Installs nothing."""

from __future__ import annotations

import ast
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from printprep.cli.app import printprep

ROOT = Path(__file__).resolve().parents[2]
DEV = ROOT / "dev.py"
TASKS = ("test", "lint", "types", "docs", "page", "bench")


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location("dev", DEV)
    module = importlib.util.module_from_spec(spec)
    sys.modules["dev"] = module
    spec.loader.exec_module(module)
    return module


dev = load()


@pytest.fixture
def checkout(tmp_path: Path) -> dev.Checkout:
    """A folder that looks like a checkout with an empty environment."""
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    found = dev.Checkout(tmp_path)
    found.python.parent.mkdir(parents=True)
    found.python.touch()
    return found


class Commands:
    """Stands for the commands that dev.py runs quietly, and answers for them."""

    def __init__(self) -> None:
        self.ran: list[list[str]] = []
        self.fails: list[str] = []  # a command that has one of these words fails

    def __call__(self, command: list[str]) -> tuple[int, str]:
        self.ran.append(command)
        fails = any(word in command for word in self.fails)
        return (1, "one\ntwo\nNo space left on device\n") if fails else (0, "")

    def installed(self) -> list[list[str]]:
        """The arguments of each pip install, less its options for quiet."""
        return [command[6:] for command in self.ran if command[2:4] == ["pip", "install"]]


@pytest.fixture
def quietly(monkeypatch: pytest.MonkeyPatch) -> Commands:
    commands = Commands()
    monkeypatch.setattr(dev, "quietly", commands)
    return commands


class TestPlan:
    def test_a_command_of_printprep_runs_where_the_user_is_without_the_development_tools(self):
        found = dev.planned(["hollow", "a.stl", "-o", "b.3mf"], ROOT)
        run = ("-m", "printprep", "hollow", "a.stl", "-o", "b.3mf")
        assert found == dev.Plan(False, (run,), None)

    def test_options_pass_through_to_pytest_after_its_own(self):
        found = dev.planned(["test", "--all", "tests/check", "-x", "-n", "0"], ROOT)
        (command,) = found.commands
        assert command[:2] == ("-m", "pytest")
        assert command[-5:] == ("--all", "tests/check", "-x", "-n", "0")
        assert found.dev and found.folder == ROOT

    def test_lint_looks_at_errors_and_format(self):
        found = dev.planned(["lint"], ROOT)
        assert [command[1:3] for command in found.commands] == [
            ("ruff", "check"),
            ("ruff", "format"),
        ]

    def test_docs_makes_every_page_that_is_made_from_the_code(self):
        makers = [Path(command[0]).name for command in dev.planned(["docs"], ROOT).commands]
        with_check = [
            path.name
            for path in (ROOT / "docs").glob("make_*.py")
            if "--check" in path.read_text(encoding="utf-8")
        ]
        assert makers == sorted(with_check)
        assert "make_cli_reference.py" in makers
        checks = dev.planned(["docs", "--check"], ROOT).commands
        assert {command[1:] for command in checks} == {("--check",)}

    def test_bench_runs_the_benchmarks(self):
        (command,) = dev.planned(["bench", "-k", "help"], ROOT).commands
        assert command == ("-m", "pytest", "benchmarks", "-k", "help")

    @pytest.mark.parametrize("line", ["lint --fix", "types x", "docs page"])
    def test_a_task_without_options_refuses_them(self, line: str, capsys):
        assert dev.main(line.split(), ROOT) == dev.USAGE
        assert "takes no argument" in capsys.readouterr().err

    def test_no_task_hides_a_command(self):
        assert not set(TASKS) & set(printprep.commands)


class TestStamp:
    def test_nothing_is_done_or_said_while_pyproject_stays_the_same(
        self, checkout, quietly, capsys
    ):
        dev.ensure(checkout, dev=True)
        quietly.ran.clear()
        capsys.readouterr()
        dev.ensure(checkout, dev=True)
        dev.ensure(checkout, dev=False)
        assert quietly.ran == []
        assert capsys.readouterr() == ("", "")

    def test_a_change_of_pyproject_installs_again_and_keeps_the_development_tools(
        self, checkout, quietly
    ):
        dev.ensure(checkout, dev=True)
        with (checkout.root / "pyproject.toml").open("a") as file:
            file.write("# more\n")
        quietly.ran.clear()
        dev.ensure(checkout, dev=False)
        assert quietly.installed() == [["-e", f"{checkout.root}[dev]"]]

    def test_the_development_tools_are_installed_when_first_asked_for(self, checkout, quietly):
        dev.ensure(checkout, dev=False)
        assert quietly.installed()[-1] == ["-e", str(checkout.root)]
        dev.ensure(checkout, dev=True)
        assert quietly.installed()[-1] == ["-e", f"{checkout.root}[dev]"]

    def test_a_checkout_that_moved_is_installed_again(self, checkout, quietly, tmp_path_factory):
        dev.ensure(checkout, dev=False)
        moved = tmp_path_factory.mktemp("moved") / "here"
        checkout.root.rename(moved)
        quietly.ran.clear()
        dev.ensure(dev.Checkout(moved), dev=False)
        assert quietly.installed() == [["-e", str(moved)]]

    def test_an_environment_whose_python_is_gone_is_made_anew(self, checkout, quietly):
        dev.ensure(checkout, dev=False)
        checkout.python.unlink()
        quietly.ran.clear()
        dev.ensure(checkout, dev=False)
        assert quietly.ran[0][1:4] == ["-m", "venv", "--clear"]

    def test_a_failed_installation_leaves_no_stamp(self, checkout, quietly):
        quietly.fails = [f"{checkout.root}"]
        with pytest.raises(dev.SetupError):
            dev.ensure(checkout, dev=False)
        assert checkout.installed() is None


class TestTorch:
    """On Linux the usual build of PyTorch is gigabytes larger than a CPU needs."""

    @pytest.fixture(autouse=True)
    def linux(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys, "platform", "linux")

    def without_torch(self, quietly: Commands) -> None:
        find = "import importlib.util as u, sys; sys.exit(u.find_spec('torch') is None)"
        quietly.fails.append(find)

    def test_the_tested_build_is_taken_where_the_users_index_has_it(self, checkout, quietly):
        self.without_torch(quietly)
        dev.ensure(checkout, dev=False)
        first, second = quietly.installed()
        assert first == ["--no-deps", f"torch=={dev.CPU_TORCH}"]
        assert second == ["-e", str(checkout.root)]

    def test_else_any_in_range_from_its_own_index_and_else_the_usual_one(
        self, checkout, quietly, capsys
    ):
        self.without_torch(quietly)
        quietly.fails.append("--no-deps")
        dev.ensure(checkout, dev=False)
        _, theirs, project = quietly.installed()
        assert dev.CPU_INDEX in theirs and theirs[-1] == dev.torch_range(ROOT)
        assert project == ["-e", str(checkout.root)]
        assert "the usual one is larger" in capsys.readouterr().err

    def test_what_is_there_stays(self, checkout, quietly):
        dev.ensure(checkout, dev=False)
        assert quietly.installed() == [["-e", str(checkout.root)]]

    @pytest.mark.parametrize("platform", ["darwin", "win32"])
    def test_elsewhere_the_usual_build_is_small(self, checkout, quietly, monkeypatch, platform):
        monkeypatch.setattr(sys, "platform", platform)
        self.without_torch(quietly)
        dev.ensure(checkout, dev=False)
        assert quietly.installed() == [["-e", str(checkout.root)]]

    def test_the_tested_build_is_in_the_declared_range(self):
        from packaging.requirements import Requirement

        assert Requirement(dev.torch_range(ROOT)).specifier.contains(dev.CPU_TORCH)


class TestFailures:
    def test_pips_last_words_are_shown_and_what_to_do(self, checkout, quietly, capsys):
        quietly.fails = [str(checkout.root)]
        assert dev.main(["hollow", "a.stl"], checkout.root) == dev.UNAVAILABLE
        said = capsys.readouterr().err
        assert "pip could not install printprep" in said
        assert "No space left on device" in said
        assert "run the same command again" in said

    def test_debian_is_told_the_package(self, checkout, quietly, capsys, monkeypatch):
        checkout.python.unlink()
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
        assert dev.main(["test"], checkout.root) == dev.UNAVAILABLE
        version = f"{sys.version_info[0]}.{sys.version_info[1]}"
        assert f"apt install python{version}-venv" in capsys.readouterr().err
        assert quietly.ran == []

    def test_an_old_python_is_named(self, monkeypatch, capsys):
        monkeypatch.setattr(sys, "version_info", (3, 9, 2))
        assert dev.main(["test"], ROOT) == dev.UNAVAILABLE
        assert "Python 3.11 or newer is needed" in capsys.readouterr().err

    def test_an_old_python_can_read_that_far(self):
        ast.parse(DEV.read_text(encoding="utf-8"), feature_version=(3, 8))

    def test_an_interrupted_installation_ends_quietly(self, checkout, capsys, monkeypatch):
        def interrupted(command):
            raise KeyboardInterrupt

        monkeypatch.setattr(dev, "quietly", interrupted)
        assert dev.main(["test"], checkout.root) == dev.INTERRUPTED
        assert "error" not in capsys.readouterr().err

    @pytest.mark.parametrize(("arguments", "code"), [([], dev.USAGE), (["--help"], 0)])
    def test_usage_installs_nothing(self, checkout, quietly, capsys, arguments, code):
        assert dev.main(arguments, checkout.root) == code
        said = capsys.readouterr().out
        assert all(f"dev.py {task}" in said for task in TASKS)
        assert quietly.ran == []


@pytest.mark.skipif(os.name == "nt", reason="the stand-in environment is a symbolic link")
class TestTheScriptItself:
    """As a user runs it, in an environment that is this one's interpreter and a stand-in."""

    @pytest.fixture
    def script(self, checkout) -> Path:
        checkout.python.unlink()
        checkout.python.symlink_to(Path(sys.executable).resolve())
        checkout.note(dev.Stamp(checkout.fingerprint(), dev=False))
        return Path(shutil.copy(DEV, checkout.root))

    def printprep(self, folder: Path, code: str) -> None:
        (folder / "printprep.py").write_text(f"import os, signal, sys, time\n{code}\n")

    def test_arguments_and_exit_codes_pass_through(self, script: Path, tmp_path: Path):
        self.printprep(tmp_path, "print(sys.argv[1:]); sys.exit(4)")
        done = subprocess.run(
            [sys.executable, script, "hollow", "a b.stl"],
            capture_output=True, encoding="utf-8", check=False, cwd=tmp_path,
        )  # fmt: skip
        assert (done.returncode, done.stdout, done.stderr) == (4, "['hollow', 'a b.stl']\n", "")

    def test_a_signal_is_told_as_a_shell_tells_it(self, script: Path, tmp_path: Path):
        self.printprep(tmp_path, "os.kill(os.getpid(), signal.SIGTERM)")
        done = subprocess.run([sys.executable, script, "hollow"], check=False, cwd=tmp_path)
        assert done.returncode == 128 + signal.SIGTERM

    def test_ctrl_c_is_left_to_the_command(self, script: Path, tmp_path: Path):
        self.printprep(
            tmp_path,
            "try:\n    print('ready', flush=True); time.sleep(30)\n"
            "except KeyboardInterrupt:\n    sys.exit(130)",
        )
        process = subprocess.Popen(
            [sys.executable, script, "hollow"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            encoding="utf-8", cwd=tmp_path, start_new_session=True,
        )  # fmt: skip
        with process:
            assert process.stdout.readline() == "ready\n"
            os.killpg(process.pid, signal.SIGINT)
            out, err = process.communicate(timeout=30)
        assert (process.returncode, out, err) == (130, "", "")
