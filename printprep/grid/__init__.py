"""Voxels of a solid: grids, signed distance to the surface, and the domain of the optimization."""
