"""The post-processing script of a slicer: measure a G-code, judge it, write the figures into it."""
