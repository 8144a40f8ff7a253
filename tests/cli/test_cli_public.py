"""The names that ``import printprep`` offers."""

from __future__ import annotations

import pytest

import printprep


def test_every_public_name_is_there():
    for name in printprep.__all__:
        assert getattr(printprep, name) is not None
        assert name in dir(printprep)


def test_unknown_names_are_attribute_errors():
    with pytest.raises(AttributeError, match="no attribute 'hollwo'"):
        _ = printprep.hollwo


def test_the_error_families_share_one_base():
    for name in ("UsageError", "InputError", "GeometryError", "OutputError", "ToolError"):
        assert issubclass(getattr(printprep, name), printprep.PrintprepError)
