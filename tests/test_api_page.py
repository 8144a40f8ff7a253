"""docs/api.md is what the signatures and docstrings say."""

from __future__ import annotations

import runpy
from pathlib import Path

import printprep

DOCS = Path(__file__).resolve().parent.parent / "docs"


def test_the_page_is_up_to_date():
    made = runpy.run_path(str(DOCS / "make_api_reference.py"))["reference"]()
    assert (DOCS / "api.md").read_text(encoding="utf-8") == made, "run: python3 dev.py docs"


def test_it_has_every_public_name():
    page = (DOCS / "api.md").read_text(encoding="utf-8")
    for name in set(printprep.__all__) - {"__version__"}:
        assert f"### `printprep.{name}`" in page
