"""A page as one HTML file that needs nothing else: no network, no other file.

The content-security-policy allows the page's own script and style by their hashes, pictures in
data: URLs, and nothing else; a served page may also ask its own server.  Every text of the page
goes through the template's escaping, and the viewer's data is JSON without ``<``, ``>`` and ``&``.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from printprep.page.chart import drawn
from printprep.wording import counted

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

    from printprep.page.content import Page

_HERE = Path(__file__).resolve().parent
# The JSON writer escapes all that is not ASCII already.
_ESCAPED = {"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"}


def document(page: Page) -> bytes:
    """The page as HTML in UTF-8; the same page and version give the same bytes."""
    script, style = asset("viewer.js"), asset("page.css")
    text = (
        templates()
        .get_template("page.html")
        .render(
            page=page,
            policy=policy(script, style, served=page.form is not None),
            script=script,
            style=style,
            data=json_text(page.view),
            chart=None if page.curve is None else drawn(page.curve),
        )
    )
    return text.encode("utf-8")


def write_page(page: Page, path: Path) -> None:
    """Write a page in one step.  Raises OutputError if the file cannot be written."""
    from printprep.files import write_atomically

    write_atomically(path, document(page))


def policy(script: str, style: str, *, served: bool) -> str:
    """The content-security-policy of a page."""
    rules = [
        "default-src 'none'",
        f"script-src '{_hash(script)}'",
        f"style-src '{_hash(style)}'",
        "img-src data:",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    if served:
        rules.append("connect-src 'self'")
    return "; ".join(rules)


def json_text(data: Mapping[str, Any]) -> str:
    """JSON that can stand in a script element: it cannot end the element, nor begin another."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    for character, escape in _ESCAPED.items():
        text = text.replace(character, escape)
    return text


@cache
def asset(name: str) -> str:
    """A file that comes with printprep."""
    return (_HERE / "assets" / name).read_text(encoding="utf-8")


@cache
def templates() -> Environment:
    """The templates that come with printprep; every value is escaped."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    found = Environment(
        loader=FileSystemLoader(_HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    found.filters["ticked"] = ticked
    found.filters["counted"] = counted
    return found


def ticked(text: str) -> Markup:
    """A text with what stands between backticks as code; everything is escaped."""
    from markupsafe import Markup, escape

    pieces = text.split("`")
    if len(pieces) % 2 == 0:
        return escape(text)
    shown = [
        Markup("<code>{}</code>").format(piece) if number % 2 else escape(piece)
        for number, piece in enumerate(pieces)
    ]
    return Markup("").join(shown)


def _hash(text: str) -> str:
    """The hash of an inline element's text, as a policy names it."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode()
