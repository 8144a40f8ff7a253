"""Where profiles are: those that come with printprep, and the user's own, found by name.

The user's own are TOML files in one folder: that of the variable PRINTPREP_PROFILES, or the folder
``printprep/profiles`` where the system keeps a user's configuration (``~/.config`` on Linux).
"""

from __future__ import annotations

import os
from pathlib import Path

from printprep.errors import UsageError
from printprep.wording import did_you_mean, shortened

DEFAULT_PROFILE = "fdm-pla-0.4"
FOLDER_VARIABLE = "PRINTPREP_PROFILES"

_SHIPPED = (
    Path(__file__).resolve().parent / "_profiles",  # inside an installed wheel
    Path(__file__).resolve().parent.parent / "profiles",  # in a checkout
)
_NAME_MAX = 64
# Names that Windows keeps for devices, whatever follows the dot.
_DEVICES = frozenset(
    {"aux", "con", "nul", "prn", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10))}
)


def profile_names() -> tuple[str, ...]:
    """Names of the profiles that come with printprep, sorted, the default first."""
    names = sorted(path.stem for path in shipped_folder().glob("*.toml"))
    return tuple(sorted(names, key=lambda name: name != DEFAULT_PROFILE))


def user_profile_names() -> tuple[str, ...]:
    """Names of the user's own profiles, sorted."""
    return tuple(sorted(path.stem for path in user_folder().glob("*.toml") if path.is_file()))


def shipped_folder() -> Path:
    """The folder of the profiles that come with printprep."""
    for folder in _SHIPPED:
        if folder.is_dir():
            return folder
    raise UsageError("The profiles that come with printprep are missing.", "Install it again.")


def user_folder() -> Path:
    """The folder of the user's own profiles; it need not exist."""
    from platformdirs import user_config_path

    named = os.environ.get(FOLDER_VARIABLE)
    return Path(named) if named else user_config_path("printprep", appauthor=False) / "profiles"


def user_profile_path(name: str) -> Path:
    """The file of the user's own profile with this name; it need not exist.

    Raises UsageError for a name that cannot be a file's on every system, that comes with printprep,
    or that differs from one that is there only in case.
    """
    hint = "Use letters, digits, dots, hyphens and underscores, for example my-printer."
    if not name or len(name) > _NAME_MAX:
        raise UsageError(f"A profile's name has 1 to {_NAME_MAX} characters.", hint)
    plain = all(letter.isalnum() or letter in "._-" for letter in name)
    if not plain or not name[0].isalnum() or name[-1] == ".":
        raise UsageError(f"{shortened(name)} cannot be the name of a profile.", hint)
    if name.lower().endswith(".toml"):
        raise UsageError(
            f"{name} is the name of a file, not of a profile.", f"Leave out .toml: {name[:-5]}."
        )
    if name.partition(".")[0].lower() in _DEVICES:
        raise UsageError(f"{name} is the name of a device on Windows.", "Choose another name.")
    if name.casefold() in (known.casefold() for known in profile_names()):
        raise UsageError(f"The profile {name} comes with printprep.", "Choose another name.")
    for known in user_profile_names():
        if known != name and known.casefold() == name.casefold():
            raise UsageError(
                f"{name} differs from your profile {known} only in case.", "Choose another name."
            )
    return user_folder() / f"{name}.toml"


def find_profile(name: str | Path) -> Path:
    """The file of a profile, by name or by path.

    Raises UsageError, with the nearest name, where there is none; and where a name is that of a
    profile that comes with printprep and of one of the user's own.
    """
    shipped, own = profile_names(), user_profile_names()
    if isinstance(name, str) and name in shipped:
        if name in own:
            raise UsageError(
                f"There are two profiles named {name}: one comes with printprep, one is "
                f"{user_folder() / name}.toml.",
                "Rename the file.",
            )
        return shipped_folder() / f"{name}.toml"
    if isinstance(name, str) and name in own:
        return user_folder() / f"{name}.toml"
    path = Path(name)
    if _is_there(path):
        return path
    if path.suffix == ".toml" or len(path.parts) > 1:
        raise UsageError(f"The profile file {name} does not exist.", "Check the name.")
    known = (*shipped, *own)
    hint = did_you_mean(str(name), known) or f"Use one of {', '.join(known)}."
    raise UsageError(f"There is no profile named {name}.", hint)


def _is_there(path: Path) -> bool:
    try:
        return path.exists() and not path.is_dir()
    except (OSError, ValueError):  # a name that no file can have
        return False
