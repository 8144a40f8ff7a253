"""Ballast instead of cavities: the slicer's own sparse infill carries the ceilings.

The outside stays one solid mesh.  What must weigh is printed dense, by a modifier volume; all else
inside is the profile's infill.  The linear program is the one of cavities, its lightest filling now
sparse instead of empty.
"""
