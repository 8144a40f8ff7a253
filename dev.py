#!/usr/bin/env python3
"""Run printprep, its tests and its checks from a checkout; the first run makes the environment.

    python3 dev.py hollow samples/spot.stl -o out.3mf     any command of printprep
    python3 dev.py test [--all] [PYTEST OPTIONS]          the fast tests, or all, in parallel
    python3 dev.py lint                                   ruff: errors and format
    python3 dev.py types                                  mypy
    python3 dev.py docs [--check]                         write the pages made from the code
    python3 dev.py page [--check]                         check and bundle the viewer of pages (npm)
    python3 dev.py bench [PYTEST OPTIONS]                 benchmarks

The environment is .venv beside this file. It is installed again when pyproject.toml has changed.
Where nothing is to be installed, nothing is printed. The exit code is the command's own; 69 means
that the environment could not be made.
"""

# Old Pythons must be able to read this file, so that it can say which one is needed.
from __future__ import annotations

import hashlib
import importlib.util
import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

NEEDED = (3, 11)
USAGE, UNAVAILABLE, INTERRUPTED = 2, 69, 130
# On Linux the usual build of PyTorch brings gigabytes for graphics cards. The CPU build is the one
# CI tests; it comes from the user's own package index where that has it, else from PyTorch's.
CPU_TORCH = "2.13.0+cpu"
CPU_INDEX = "https://download.pytorch.org/whl/cpu"
# More workers than eight gain nothing: each takes seconds to start and half a gigabyte. Tests begin
# in the order that tests/tiers.py gives them, and a worker that crashes ends the run.
PARALLEL = (
    *("-n", "auto", "--maxprocesses=8", "--max-worker-restart=0"),
    *("--dist", "loadgroup", "--no-loadscope-reorder"),
)
LINES_SHOWN = 15
# The scripts in docs/ that write a page from the code, and take --check.
PAGES = ("make_api_reference.py", "make_cli_reference.py", "make_troubleshooting.py")


class SetupError(Exception):
    """The environment could not be made: what failed, and what to do."""


class UsageError(Exception):
    """The arguments name no task."""


@dataclass(frozen=True)
class Plan:
    """What to run in the environment.

    dev : whether it takes the development tools;  commands : each the interpreter's arguments;
    folder : where to run them, None for where the user is.
    """

    dev: bool
    commands: tuple[tuple[str, ...], ...]
    folder: Path | None


@dataclass(frozen=True)
class Stamp:
    """What was installed: a fingerprint of what it depends on, and whether with the dev tools."""

    fingerprint: str
    dev: bool

    def covers(self, wanted: Stamp) -> bool:
        """Whether nothing has to be installed to get what is wanted."""
        return self.fingerprint == wanted.fingerprint and (self.dev or not wanted.dev)


@dataclass(frozen=True)
class Checkout:
    """A folder with the project, and the environment in it."""

    root: Path

    @property
    def venv(self) -> Path:
        return self.root / ".venv"

    @property
    def python(self) -> Path:
        return self.venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")

    @property
    def _stamp(self) -> Path:
        return self.venv / "dev-stamp.json"

    def fingerprint(self) -> str:
        """Changes with pyproject.toml, and with the folder, whose path the installation holds."""
        content = (self.root / "pyproject.toml").read_bytes()
        return hashlib.sha256(content + str(self.root).encode()).hexdigest()

    def installed(self) -> Stamp | None:
        """The stamp of the last installation that succeeded, None where there is none."""
        if not (self.python.exists() and self._stamp.is_file()):
            return None
        return Stamp(**json.loads(self._stamp.read_text(encoding="utf-8")))

    def note(self, stamp: Stamp) -> None:
        """Write the stamp of an installation that succeeded."""
        self._stamp.write_text(json.dumps(asdict(stamp)) + "\n", encoding="utf-8")


def planned(arguments: list[str], root: Path) -> Plan:
    """The plan for the command line's arguments.

    Raises UsageError for options of a task that takes none.
    """
    task, rest = arguments[0], tuple(arguments[1:])
    if task == "test":
        return Plan(True, (("-m", "pytest", *PARALLEL, *rest),), root)
    if task == "bench":
        return Plan(True, (("-m", "pytest", "benchmarks", *rest),), root)
    if task == "docs":
        if rest not in ((), ("--check",)):
            raise UsageError("docs takes no argument but --check")
        return Plan(True, tuple((str(root / "docs" / page), *rest) for page in PAGES), root)
    if task == "page":
        if rest not in ((), ("--check",)):
            raise UsageError("page takes no argument but --check")
        return Plan(True, ((str(root / "web" / "make.py"), *rest),), root)
    if task in ("lint", "types"):
        if rest:
            raise UsageError(f"{task} takes no arguments")
        ruff = (("-m", "ruff", "check", "."), ("-m", "ruff", "format", "--check", "."))
        return Plan(True, ruff if task == "lint" else (("-m", "mypy"),), root)
    return Plan(False, (("-m", "printprep", *arguments),), None)


def ensure(checkout: Checkout, dev: bool) -> None:
    """Make or renew the environment where it lacks something.

    Raises SetupError when it cannot be made.
    """
    before = checkout.installed()
    # What once had the development tools keeps them
    wanted = Stamp(checkout.fingerprint(), dev or (before is not None and before.dev))
    if before is not None and before.covers(wanted):
        return
    if not checkout.python.exists():
        make_venv(checkout)
    if sys.platform == "linux" and not has_torch(checkout):
        install_cpu_torch(checkout)
    tell("installing printprep and what it needs into .venv")
    project = f"{checkout.root}[dev]" if wanted.dev else str(checkout.root)
    pip_install(checkout, "-e", project)
    checkout.note(wanted)


def make_venv(checkout: Checkout) -> None:
    """Make an empty environment with pip.  Raises SetupError when this Python cannot."""
    package = f"python{sys.version_info[0]}.{sys.version_info[1]}-venv"
    without = (
        "This Python cannot make environments: its module ensurepip or venv is missing.\n"
        f"  On Debian or Ubuntu: sudo apt install {package} (or python3-venv)"
    )
    if not all(importlib.util.find_spec(name) for name in ("ensurepip", "venv")):
        raise SetupError(without)
    tell("making the environment in .venv; this is done once and takes some minutes")
    code, said = quietly([sys.executable, "-m", "venv", "--clear", str(checkout.venv)])
    if code:
        raise SetupError(f"The environment {checkout.venv} could not be made.\n{tail(said)}")


def has_torch(checkout: Checkout) -> bool:
    """Whether the environment has PyTorch, of any build."""
    find = "import importlib.util as u, sys; sys.exit(u.find_spec('torch') is None)"
    return quietly([str(checkout.python), "-c", find])[0] == 0


def install_cpu_torch(checkout: Checkout) -> None:
    """Install PyTorch's CPU build; where none is to be had, say so and leave it to the next step.

    Its own dependencies come with the project.
    """
    tell("installing PyTorch's build for the processor")
    own = (f"torch=={CPU_TORCH}",)
    theirs = ("--index-url", CPU_INDEX, "--retries", "1", torch_range(checkout.root))
    for source in (own, theirs):
        if pip(checkout, "--no-deps", *source)[0] == 0:
            return
    tell("there is no such build for this machine; the usual one is larger and takes longer")


def torch_range(root: Path) -> str:
    """The requirement on torch that pyproject.toml declares."""
    import tomllib

    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return next(line for line in project["dependencies"] if line.startswith("torch"))


def pip_install(checkout: Checkout, *arguments: str) -> None:
    """Install with pip.  Raises SetupError with pip's last lines when it fails."""
    code, said = pip(checkout, *arguments)
    if code:
        version = ".".join(str(part) for part in sys.version_info[:2])
        raise SetupError(
            f"pip could not install printprep into .venv. It said:\n{tail(said)}\n"
            "  Check the network and the free disk space, then run the same command again.\n"
            f"  If a package has no build for Python {version}: delete .venv and run dev.py with\n"
            "  another Python, for example python3.12 dev.py"
        )


def pip(checkout: Checkout, *arguments: str) -> tuple[int, str]:
    """Exit code of pip install, and what it said."""
    options = ["--no-input", "--disable-pip-version-check"]
    return quietly([str(checkout.python), "-m", "pip", "install", *options, *arguments])


def quietly(command: list[str]) -> tuple[int, str]:
    """Exit code of a command, and what it said, which is not shown."""
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    return done.returncode, done.stdout.decode(errors="replace")


def tail(said: str) -> str:
    """The last lines, indented."""
    return "\n".join(f"    {line}" for line in said.rstrip().splitlines()[-LINES_SHOWN:])


def tell(message: str) -> None:
    """A line on standard error, so that standard output is the command's alone."""
    sys.stderr.write(f"dev.py: {message}\n")
    sys.stderr.flush()


def run(command: list[str], folder: Path | None) -> int:
    """Exit code of a command that has the terminal; 128 + n where the signal n ended it.

    Ctrl-C reaches the command as well, and how to end is its own affair.
    """
    process = subprocess.Popen(command, cwd=folder)
    while True:
        try:
            code = process.wait()
        except KeyboardInterrupt:
            continue
        return code if code >= 0 else 128 - code


def run_all(checkout: Checkout, plan: Plan) -> int:
    """The first exit code that is not 0. A failure does not keep the next command from running."""
    codes = []
    for command in plan.commands:
        codes.append(run([str(checkout.python), *command], plan.folder))
        if codes[-1] == INTERRUPTED:
            break
    return next((code for code in codes if code), 0)


def main(arguments: list[str], root: Path) -> int:
    """Exit code of what the arguments ask for."""
    if sys.version_info < NEEDED:
        tell(f"error: Python {NEEDED[0]}.{NEEDED[1]} or newer is needed; this is {sys.version}")
        return UNAVAILABLE
    if not arguments or arguments[0] in ("-h", "--help"):
        sys.stdout.write(str(__doc__))
        return 0 if arguments else USAGE
    checkout = Checkout(root)
    try:
        plan = planned(arguments, root)
        ensure(checkout, plan.dev)
        return run_all(checkout, plan)
    except UsageError as error:
        tell(f"error: {error}")
        return USAGE
    except SetupError as error:
        tell(f"error: {error}")
        return UNAVAILABLE
    except KeyboardInterrupt:
        return INTERRUPTED


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:], Path(__file__).resolve().parent))
