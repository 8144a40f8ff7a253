"""Overhangs, judged by the rule by which a slicer places support."""
