"""Runs the slicer that is installed on this machine, and reads its output."""
