"""Drain holes for cavities, and the checks that nothing stays inside a part or sucks at the vat."""
