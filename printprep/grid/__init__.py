"""The voxel picture of a solid: grids, signed distance, and the domain that may change."""
