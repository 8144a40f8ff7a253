"""Write docs/cli.md from the program's own --help.

Run it from anywhere after a change to an option:  python3 dev.py docs
With --check it writes nothing, and ends with 1 where the page is not what it would write.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import click

from printprep.cli.app import CONTEXT, printprep

TARGET = Path(__file__).with_name("cli.md")
_HEAD = """# The command line

Made from `--help` by `docs/make_cli_reference.py`.
"""


def commands(command: click.Command, context: click.Context) -> Iterator[click.Context]:
    """The command's context and those of all below it, in the order of --help."""
    yield context
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            child = command.get_command(context, name)
            assert child is not None
            yield from commands(child, click.Context(child, context, name, **CONTEXT))


def reference() -> str:
    """The page as Markdown, the same at any width of terminal."""
    root = click.Context(printprep, info_name="printprep", **CONTEXT)
    pages = [_HEAD]
    for context in commands(printprep, root):
        context.terminal_width = 80
        pages.append(f"## {context.command_path}\n\n```\n{context.get_help()}\n```\n")
    return "\n".join(pages)


if __name__ == "__main__":
    if sys.argv[1:] != ["--check"]:
        TARGET.write_text(reference(), encoding="utf-8", newline="\n")
    elif TARGET.read_text(encoding="utf-8") != reference():
        sys.exit(f"{TARGET.name} does not match --help; to write it anew: python3 dev.py docs")
