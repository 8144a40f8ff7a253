"""A profile from the settings that a user has in a slicer.

Files become settings (``prusa_file``, ``orca_file``), settings become profile keys (``keys``) by
the names and rules of their slicer (``dialects``), and the keys become a TOML text (``text``).
"""
