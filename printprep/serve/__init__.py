"""A small server for this machine alone, where settings are tried and the page follows."""
