"""Compares a part with its print: slices it, measures the G-code, reports differences."""
