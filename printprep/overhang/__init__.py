"""What a layer may rest on: a slicer's own rule for where it would print support."""
