"""A file for OrcaSlicer is verified as the same part in PrusaSlicer's layout."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from closed_form_parts import box, hollow_result

from printprep.mesh.quantize import quantized
from printprep.output.item import infill_item
from printprep.output.orca_keys import orca_item
from printprep.output.part_file import JSON_PART
from printprep.result import HollowResult
from printprep.threemf.write import write_3mf
from printprep.verify.for_prusa import file_for_prusa
from printprep.verify.part_3mf import computed_part
from printprep.verify.run import verify

_LAYOUT = ("3D/3dmodel.model", "Metadata/Slic3r_PE_model.config")


def layout(content: bytes) -> list[list[str]]:
    """The parts that say what is printed, without the lines of metadata."""
    archive = zipfile.ZipFile(io.BytesIO(content))
    texts = [archive.read(name).decode().splitlines() for name in _LAYOUT]
    return [[line for line in text if "<metadata name=" not in line] for text in texts]


def blocked() -> HollowResult:
    return replace(hollow_result(), blocker=box(16, 17.2, z=2))


def test_the_copy_is_the_file_for_prusaslicer(tmp_path: Path) -> None:
    ours, prusas = tmp_path / "orca.3mf", tmp_path / "prusa.3mf"
    blocked().write(ours, "orca")
    blocked().write(prusas)
    copy = file_for_prusa(computed_part(ours), tmp_path)
    assert copy != ours
    assert layout(copy.read_bytes()) == layout(prusas.read_bytes())
    assert file_for_prusa(computed_part(prusas), tmp_path) == prusas


def test_the_copy_of_an_infill_print_keeps_its_ballast_dense(tmp_path: Path) -> None:
    result = hollow_result()
    part, ballast = quantized(box(20)), [box(8, 5, z=1), box(6, 4, z=9)]
    item = infill_item(part, ballast, "block", result.profile)
    attachments = {JSON_PART: zipfile.ZipFile(_written(result)).read(JSON_PART)}
    path = tmp_path / "orca.3mf"
    path.write_bytes(write_3mf([orca_item(item)], attachments=attachments, dialect="orca"))
    copy = file_for_prusa(computed_part(path), tmp_path)
    assert layout(copy.read_bytes()) == layout(write_3mf([item]))


def _written(result: HollowResult) -> io.BytesIO:
    from printprep.output.part_file import part_bytes

    return io.BytesIO(part_bytes(result.contents(), ".3mf"))


@pytest.mark.slicer
def test_prusaslicer_opens_the_mesh_and_prints_the_part_alone(
    prusa_slicer: Path, tmp_path: Path
) -> None:
    path = tmp_path / "orca.3mf"
    blocked().write(path, "orca")
    done = verify(path, slicer=prusa_slicer)
    assert done.printed.mass_g == pytest.approx(4.84, rel=0.05)
    assert done.supported is not None
    assert done.supported.mass_g == pytest.approx(done.printed.mass_g, rel=0.02)
