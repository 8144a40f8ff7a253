"""A page is one file that allows nothing else, escapes what it is told, and repeats to the byte."""

from __future__ import annotations

import base64
import hashlib
import re
from dataclasses import replace
from pathlib import Path

import pytest
from closed_form_parts import hollow_result
from page_reader import read, view_of

from printprep.check.catalogue import finding
from printprep.page.build import page_of_result
from printprep.page.content import Form, Source
from printprep.page.document import asset, document, json_text, ticked
from printprep.page.index import IndexRow, index_page
from printprep.profiles import load_profile

EVIL = "</script><script>alert(1)</script>\"'><img src=x onerror=alert(2)>"
SOURCE = Source("block.stl", "0" * 64, "printprep hollow block.stl")


def page_of(name="block", source=SOURCE, findings=(), profile=None, **more):
    result = hollow_result(name=name, profile=profile or "fdm-pla-0.4")
    return page_of_result(result, findings or result.findings, source, **more)


@pytest.fixture(scope="module")
def plain() -> bytes:
    return document(page_of())


def policy_of(page: bytes) -> dict[str, str]:
    (meta,) = (
        e for e in read(page).named("meta")
        if e.attributes.get("http-equiv") == "Content-Security-Policy"
    )  # fmt: skip
    rules = (rule.strip().partition(" ") for rule in meta.attributes["content"].split(";"))
    return {name: value for name, _, value in rules}


def hashed(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_the_policy_allows_the_page_itself_and_nothing_else(plain):
    found = read(plain)
    (script,) = (e for e in found.named("script") if "type" not in e.attributes)
    (style,) = found.named("style")
    assert policy_of(plain) == {
        "default-src": "'none'",
        "script-src": hashed(script.text),
        "style-src": hashed(style.text),
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }


def test_a_served_page_may_ask_its_own_server():
    form = Form("2", "10", "cavity", (("cavity", "cavity"),), "0", "", (), False, "a.3mf")
    assert policy_of(document(page_of(form=form)))["connect-src"] == "'self'"


def test_nothing_is_fetched(plain):
    """No element names another file, and the style neither."""
    for element in read(plain).elements:
        for name in ("src", "href", "action", "srcset", "poster", "data"):
            value = element.attributes.get(name)
            assert value is None or value.startswith(("data:", "#")), (element.tag, value)
        assert not any(name.startswith("on") or name == "style" for name in element.attributes)
    assert "@import" not in asset("page.css") and "url(" not in asset("page.css")


def test_what_the_user_names_is_text_and_nothing_else(plain):
    """In a model's name, a finding, a file's name, a command, a currency, a material."""
    profile = load_profile(
        "fdm-pla-0.4",
        {"material.price_per_kg": 20.0, "material.currency": "<b>€", "material.name": EVIL},
    )
    evil = page_of(
        EVIL,
        Source(EVIL, "0" * 64, f"printprep hollow {EVIL}"),
        (finding("gap", EVIL, EVIL, at_mm=(0.0, 0.0, 0.0)),),
        profile,
    )
    found, known = read(document(evil)), read(plain)
    for tag in ("script", "img", "b", "style", "meta"):
        assert len(found.named(tag)) == len(known.named(tag))
    assert not any(name.startswith("on") for e in found.elements for name in e.attributes)
    (title,) = (e for e in found.named("h1"))
    assert title.text == EVIL
    assert found.text.count(EVIL) >= 5
    assert "<b>€" in found.text
    assert view_of(document(evil))["findings"][0]["rule"] == "gap"


@pytest.mark.parametrize("text", ["</script>", "<!--<script>", "a & b", "\u2028", "€"])
def test_data_cannot_end_its_element(text):
    written = json_text({"a": text})
    assert not set(written) & set("<>&\u2028€")


def test_the_script_holds_nothing_that_would_end_it():
    assert "</script" not in asset("viewer.js").lower()
    assert "<!--" not in asset("viewer.js")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("Use `--size`.", "Use <code>--size</code>."),
        ("a ` b", "a ` b"),
        ("`<b>` & c", "<code>&lt;b&gt;</code> &amp; c"),
    ],
)
def test_backticks_are_code(text, shown):
    assert str(ticked(text)) == shown


def test_the_same_part_is_the_same_page(plain):
    assert document(page_of()) == plain


def test_it_holds_no_path_and_no_time(plain):
    text = plain.decode()
    assert str(Path.cwd()) not in text and str(Path.home()) + "/" not in text
    assert not re.search(r"20\d\d-\d\d-\d\dT", text)


def test_the_licence_of_three_is_there():
    version = re.search(r"with three\.js (\S+) \(MIT", asset("viewer.js")).group(1)
    assert asset("THREE-LICENSE.txt").startswith(f"three.js {version}")
    assert "Permission is hereby granted" in asset("THREE-LICENSE.txt")


def test_figures_of_the_block(plain):
    """9.92 g solid, 4.84 g hollow, tilt 45°: what closed_form_parts computes by hand."""
    text = read(plain).text
    for figure in ("9.92 g → 4.84 g", "45.0° → ", "2.00 mm", "block.stl", "0" * 64):
        assert figure in text


def test_a_rows_name_and_link_in_an_index_are_escaped():
    row = IndexRow(EVIL, "a b/#?.html", "error", None, None, None, 0, 0, EVIL)
    found = read(index_page(EVIL, [row, replace(row, report=None)]))
    assert not found.named("img") and not found.named("script")
    (link,) = found.named("a")
    assert link.attributes["href"] == "./a%20b/%23%3F.html"
    assert link.text == EVIL
