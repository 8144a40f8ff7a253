"""Drain holes, what is filled for them, and what stays inside all the same."""
