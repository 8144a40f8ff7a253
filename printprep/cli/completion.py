"""``printprep completion``: scripts that complete commands, options and values in a shell."""

from __future__ import annotations

import click

_VARIABLE = "_PRINTPREP_COMPLETE"

_EPILOG = """\b
To install it, once:
  printprep completion bash > ~/.local/share/bash-completion/completions/printprep
  printprep completion zsh > "${fpath[1]}/_printprep"
  printprep completion fish > ~/.config/fish/completions/printprep.fish

\b
For this session of bash only:
  source <(printprep completion bash)
"""


@click.command(
    "completion", short_help="Print a script for completion in your shell.", epilog=_EPILOG
)
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """Print the script with which SHELL completes commands, options, profiles and files.

    A new shell reads it once it is installed. It asks printprep itself for what fits, so it never
    needs to be renewed.
    """
    from click.shell_completion import get_completion_class

    root = ctx.find_root()
    kind = get_completion_class(shell)
    assert kind is not None
    click.echo(kind(root.command, {}, "printprep", _VARIABLE).source())
