"""A slicer's post-processing script: measures a G-code, judges it, writes the figures into it."""
