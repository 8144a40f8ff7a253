"""A model of the shared collection."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class CatalogueModel:
    """One row of the collection: ``path`` to the file, ``up`` as the command line takes it."""

    path: Path
    up: str
    may_ship: bool
