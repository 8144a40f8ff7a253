"""Write docs/troubleshooting.md from the catalogue of findings and what stands beside it.

Run it from anywhere after a change to either:  python3 dev.py docs
With --check it writes nothing, and ends with 1 where the page is not what it would write.
"""

from __future__ import annotations

import sys
from pathlib import Path

from printprep.check.catalogue import CATALOGUE, Kind
from printprep.check.troubleshooting import TOPICS, Remedy

TARGET = Path(__file__).with_name("troubleshooting.md")
_HEAD = """# Troubleshooting

Made from the catalogue of findings by `docs/make_troubleshooting.py`.

Every finding ends with its id in brackets, as `[tilt]`; in JSON it is the `rule`. Look the id up
here. The finding itself says how much and where; this page says why it appears, and what helps.

- **error**: the part does not do what it is for.
- **warning**: look at it before you print.
- **info**: good to know; nothing has to be done, unless you want it otherwise.
"""


def index() -> str:
    """All ids in alphabetical order, each with a link to its entry."""
    rows = [
        f"| [`{name}`](#{name}) | {', '.join(CATALOGUE[name].severities)} | "
        f"{CATALOGUE[name].prevents} |"
        for name in sorted(CATALOGUE)
    ]
    return "\n".join(["| finding | severity | prevents |", "|---|---|---|", *rows, ""])


def entry(kind: Kind, remedy: Remedy) -> str:
    """A finding as Markdown."""
    severity = " or ".join(kind.severities)
    return "\n".join(
        [
            f"### {kind.id}",
            "",
            f"*{severity}.* It prevents {kind.prevents}.",
            "",
            f"- **Cause.** {remedy.cause}",
            f"- **Cure.** {remedy.cure}",
            "",
        ]
    )


def reference() -> str:
    """The page as Markdown."""
    pages = [_HEAD, index()]
    for topic in TOPICS:
        pages.append(f"## {topic.title}\n")
        pages += [entry(CATALOGUE[remedy.id], remedy) for remedy in topic.remedies]
    return "\n".join(pages).rstrip() + "\n"


if __name__ == "__main__":
    if sys.argv[1:] != ["--check"]:
        TARGET.write_text(reference(), encoding="utf-8", newline="\n")
    elif not TARGET.is_file() or TARGET.read_text(encoding="utf-8") != reference():
        sys.exit(f"{TARGET.name} does not match the catalogue: run python3 dev.py docs")
