"""The page of a batch: a row for every model, with a link to its own page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import quote

from printprep.page.document import asset, policy, templates
from printprep.page.words import mass, tilt


@dataclass(frozen=True)
class IndexRow:
    """One model.  report : its page, relative to the index;  message : of an error."""

    name: str
    report: str | None
    status: str
    solid_mass_g: float | None
    mass_g: float | None
    tilt_deg: float | None
    errors: int
    warnings: int
    message: str | None

    @property
    def link(self) -> str | None:
        """The page's address, with every character that a URL gives a meaning escaped."""
        return None if self.report is None else f"./{quote(self.report)}"

    @property
    def masses(self) -> str:
        """Mass before and after, "" for a row without a part."""
        if self.solid_mass_g is None or self.mass_g is None:
            return ""
        return f"{mass(self.solid_mass_g)} → {mass(self.mass_g)}"

    @property
    def tips(self) -> str:
        """The tilt angle, "" for a row without a part."""
        return "" if self.mass_g is None else tilt(self.tilt_deg)


def index_page(name: str, rows: Sequence[IndexRow]) -> bytes:
    """The page as HTML in UTF-8; the same rows give the same bytes."""
    style = asset("page.css")
    text = (
        templates()
        .get_template("index.html")
        .render(
            name=name,
            rows=rows,
            parts=sum(row.status == "part" for row in rows),
            before=mass(sum(row.solid_mass_g or 0.0 for row in rows if row.status == "part")),
            after=mass(sum(row.mass_g or 0.0 for row in rows if row.status == "part")),
            policy=policy("", style, served=False),
            style=style,
        )
    )
    return text.encode("utf-8")
