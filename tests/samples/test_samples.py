"""The samples: what samples/README.md says of each is so, and none ships without its author."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

NAMES = ("bottle", "goathead", "koala", "spot")


def test_every_sample_is_listed_with_author_licence_and_source(samples_dir: Path) -> None:
    assert tuple(sorted(path.stem for path in samples_dir.glob("*.stl"))) == NAMES
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in (samples_dir / "README.md").read_text(encoding="utf-8").splitlines()
        if line.startswith("| `")
    ]
    assert sorted(row[0] for row in rows) == [f"`{name}.stl`" for name in NAMES]
    for row in rows:
        assert len(row) == 5
        assert all(row)
        assert "http" in row[4]
        assert row[3] == "public domain" or "creativecommons.org" in row[3]


@pytest.mark.parametrize("name", NAMES)
def test_a_sample_is_one_closed_mesh_in_mm_on_the_bed(samples_dir: Path, name: str) -> None:
    path = samples_dir / f"{name}.stl"
    assert path.stat().st_size < 1_000_000
    mesh = trimesh.load(path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.body_count == 1
    assert mesh.volume > 10_000.0
    low, high = mesh.bounds
    assert low[2] == 0.0
    assert (low + high)[:2] == pytest.approx([0.0, 0.0], abs=1e-4)
    assert np.max(high - low) == pytest.approx(100.0, abs=1e-4)


@pytest.mark.corpus
@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("spot", "spot_low_resolution"),
        ("koala", "koala_low_resolution"),
        ("goathead", "goathead"),
        ("bottle", "bottle_A_brown"),
    ],
)
def test_a_sample_is_its_source_turned_scaled_and_moved(
    samples_dir: Path, models_dir: Path, name: str, source: str
) -> None:
    original = trimesh.load(
        models_dir / "dev" / f"{source}.obj", force="mesh", process=False
    ).triangles
    sample = trimesh.load(samples_dir / f"{name}.stl", process=False).triangles
    turned = np.stack([original[..., 0], -original[..., 2], original[..., 1]], axis=-1)
    low, high = turned.min(axis=(0, 1)), turned.max(axis=(0, 1))
    placed = (turned - [*(low + high)[:2] / 2, low[2]]) * 100.0 / (high - low).max()
    assert sample == pytest.approx(placed, abs=1e-4)
