"""The profiles that rules are judged by."""

from __future__ import annotations

import pytest

from printprep.profiles import Profile, load_profile


@pytest.fixture(scope="session")
def fdm() -> Profile:
    return load_profile("fdm-pla-0.4")


@pytest.fixture(scope="session")
def resin() -> Profile:
    return load_profile("resin-standard")


@pytest.fixture(scope="session")
def powder() -> Profile:
    return load_profile("sls-pa12")
