"""What a written file carries: the part, its figures, a slicer's keys, plugs."""
