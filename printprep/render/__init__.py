"""Pictures without a screen: rasterizer, shading, thumbnail, moving pictures of a simulation."""
