"""Voxel files, and files that would rather run something."""

import pickle
import zipfile

import numpy as np
import pytest
import torch

from printprep.errors import InputError
from printprep.generators import read_voxels

COORDS = np.argwhere(np.ones((3, 3, 3), dtype=bool)).astype(np.int32)


def _write(path, kind):
    if kind == "npy":
        np.save(path, COORDS)
    elif kind == "npz":
        np.savez(path, COORDS)
    elif kind == "named":
        np.savez_compressed(path, colours=np.ones(3), coords=COORDS)
    elif kind == "tensor":
        torch.save(torch.from_numpy(COORDS), path)
    elif kind == "dict":
        torch.save({"step": 3, "coords": torch.from_numpy(COORDS)}, path)


@pytest.mark.parametrize(
    ("name", "kind"),
    [("a.npy", "npy"), ("a.npz", "npz"), ("b.NPZ", "named"), ("a.pt", "tensor"), ("b.pt", "dict")],
)
def test_reads(tmp_path, name, kind):
    path = tmp_path / name
    with path.open("wb") as handle:
        _write(handle, kind)
    assert np.array_equal(read_voxels(path), COORDS)
    assert np.array_equal(read_voxels(str(path)), COORDS)


class Payload:
    """Unpickled, it would create the file it was made with."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return open, (str(self.mark), "w")


@pytest.mark.parametrize("kind", ["pt", "legacy.pt", "pickle.pt", "npy", "npz"])
def test_nothing_in_a_file_is_run(tmp_path, kind):
    mark = tmp_path / "ran"
    path = tmp_path / f"evil.{kind}"
    evil = Payload(mark)
    if kind == "pt":
        torch.save({"coords": evil}, path)
    elif kind == "legacy.pt":
        torch.save(evil, path, _use_new_zipfile_serialization=False)
    elif kind == "pickle.pt":
        path.write_bytes(pickle.dumps(evil))
    elif kind == "npy":
        np.save(path, np.array([evil], dtype=object), allow_pickle=True)
    else:
        np.savez(path, coords=np.array([evil], dtype=object))
    with pytest.raises(InputError, match="evil"):
        read_voxels(path)
    assert not mark.exists()


@pytest.mark.parametrize("suffix", ["npy", "npz", "pt"])
@pytest.mark.parametrize("content", [b"", b"\x00" * 100, b"PK\x03\x04 not a zip", b"solid cube\n"])
def test_garbage(tmp_path, suffix, content):
    path = tmp_path / f"bad.{suffix}"
    path.write_bytes(content)
    with pytest.raises(InputError, match="bad"):
        read_voxels(path)


@pytest.mark.parametrize(("suffix", "kind"), [("npy", "npy"), ("npz", "npz"), ("pt", "tensor")])
def test_every_truncation_is_an_input_error(tmp_path, suffix, kind):
    whole = tmp_path / f"whole.{suffix}"
    with whole.open("wb") as handle:
        _write(handle, kind)
    data = whole.read_bytes()
    cut = tmp_path / f"cut.{suffix}"
    for length in range(0, len(data) - 1, max(1, len(data) // 40)):
        cut.write_bytes(data[:length])
        with pytest.raises(InputError):
            read_voxels(cut)


def test_which_array_is_asked(tmp_path):
    path = tmp_path / "many.npz"
    np.savez(path, left=COORDS, right=COORDS)
    with pytest.raises(InputError, match="left, right") as caught:
        read_voxels(path)
    assert "coords" in caught.value.hint


def test_a_bomb_is_not_unpacked(tmp_path):
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("coords.npy", b"\0" * (65 * 2**20))
    assert path.stat().st_size < 2**20
    with pytest.raises(InputError, match="65 MiB"):
        read_voxels(path)


def test_a_header_that_claims_too_much(tmp_path):
    path = tmp_path / "claim.npy"
    np.save(path, COORDS)
    data = path.read_bytes()
    path.write_bytes(data.replace(b"(27, 3), }        ", b"(9999999999, 3), }"))
    assert path.read_bytes() != data
    with pytest.raises(InputError, match="claim"):
        read_voxels(path)


def test_missing_and_foreign_files(tmp_path):
    with pytest.raises(InputError, match=r"gone\.npz"):
        read_voxels(tmp_path / "gone.npz")
    with pytest.raises(InputError, match=r"not a voxel file"):
        read_voxels(tmp_path / "model.stl")
    with pytest.raises(InputError, match="folder"):
        (tmp_path / "folder.pt").mkdir()
        read_voxels(tmp_path / "folder.pt")


def test_a_module_in_place_of_a_tensor(tmp_path):
    path = tmp_path / "list.pt"
    torch.save([1, 2, 3], path)
    with pytest.raises(InputError, match="list, not a tensor"):
        read_voxels(path)
