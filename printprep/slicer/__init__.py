"""The slicer on this machine, driven and read."""
