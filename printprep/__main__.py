"""``python -m printprep`` is ``printprep``."""

from printprep.cli import main

main()
