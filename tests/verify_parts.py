"""A small part with a cavity, hollowed once, for whoever slices it."""

from __future__ import annotations

import functools
from pathlib import Path

import trimesh

from printprep import hollow
from printprep.result import HollowResult

SIDE = 24.0


@functools.cache
def hollow_block() -> HollowResult:
    """A cube of 24 mm: mass and tilt angle are known in closed form, but for the cavity's rims."""
    block = trimesh.creation.box((SIDE, SIDE, SIDE))
    block.metadata["name"] = "block"
    return hollow(
        block,
        resolution=32,
        base="never",
        vaults="none",  # one plain room: quick to slice and to search
    )


def write_block(folder: Path) -> Path:
    part = folder / "block.3mf"
    hollow_block().write(part)
    return part


def write_model(folder: Path) -> Path:
    """The model the block was made of."""
    path = folder / "model.stl"
    trimesh.creation.box((SIDE, SIDE, SIDE)).export(path)
    return path
