"""Stability of a part: contact, support polygon, tilt angle, and a physics simulation."""
