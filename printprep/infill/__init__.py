"""Ballast instead of cavities: the slicer's sparse infill carries the ceilings.

The outside stays one solid mesh.  A modifier volume makes the ballast print dense; everything else
inside is the profile's infill.  The linear program is the one for cavities, but a voxel that is not
filled is sparse instead of empty.
"""
