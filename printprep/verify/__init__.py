"""A part against the print of it: sliced, measured in its G-code, compared."""
