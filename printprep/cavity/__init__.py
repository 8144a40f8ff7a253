"""The cavity and the part: the cavity's surface, the cut, the base, the subtraction."""
