"""Triangles in mm: read, placed, made a solid, measured, written."""
