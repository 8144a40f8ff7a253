"""Hollow the voxels of a generator: voxels in, voxels out, and the cavity as a mesh.

In TRELLIS (microsoft/TRELLIS, `trellis/pipelines/trellis_image_to_3d.py`) it goes between the two
stages.  The first returns an int tensor (n, 4) of batch, x, y, z in a 64³ grid, and the second
takes a tensor of the same form::

    coords = pipeline.sample_sparse_structure(cond, num_samples=1)
    hollowed = printprep.generators.hollow(coords)
    slat = pipeline.sample_slat(cond, hollowed.material)
    mesh = pipeline.decode_slat(slat, ["mesh"])["mesh"][0]

or, with a binary array, through its public entry::

    hollowed = printprep.generators.hollow(binary_voxel)
    out = pipeline.run_detail_variation(hollowed.material, images)

The cavity is a mesh of its own, because the generator draws a surface over the material and does
not know which side is inside: subtract ``hollowed.cavity`` from its mesh.  The centre of
voxel (i, j, k) is at (index + 0.5) / 64 − 0.5 in the generator's z-up frame [-0.5, 0.5]³, in which
``decode_slat`` gives its mesh too; TRELLIS's exporter (`to_glb`) then turns it y-up, to
(x, z, −y), and ``hollowed.cavity.turned_y_up()`` follows it there.
"""

from printprep.generators.hollow import VoxelHollow, hollow
from printprep.generators.read import read_voxels
from printprep.generators.surface import VoxelSurface, surface_of
from printprep.generators.voxel_arrays import GRID

__all__ = ["GRID", "VoxelHollow", "VoxelSurface", "hollow", "read_voxels", "surface_of"]
