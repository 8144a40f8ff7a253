"""Reads and writes 3MF files: a tolerant reader and a strict writer."""
