"""Groups of commands: imported when needed, and with a suggestion where a name is mistyped."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import click

from printprep.errors import UsageError
from printprep.wording import did_you_mean, shortened


class LazyGroup(click.Group):
    """A group whose commands are in modules that are imported only when needed.

    lazy : command name → module that holds the command as ``command``; in the order of --help.
    """

    def __init__(self, *args: Any, lazy: Mapping[str, str] = {}, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._lazy = dict(lazy)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*self._lazy, *super().list_commands(ctx)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        module = self._lazy.get(cmd_name)
        if module is None:
            return super().get_command(ctx, cmd_name)
        command: click.Command = import_module(module).command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        unknown = not ctx.resilient_parsing and self.get_command(ctx, name) is None
        if unknown and not name.startswith("-"):
            close = did_you_mean(name, self.list_commands(ctx))
            if close is None and "." in name:  # a model, it seems
                close = f"`{ctx.command_path} hollow {shortened(name)}` hollows a model."
            usage = f"`{ctx.command_path} --help` shows the usage."
            raise UsageError(
                f"There is no command {shortened(name)}.", f"{close} {usage}" if close else usage
            )
        return super().resolve_command(ctx, args)
