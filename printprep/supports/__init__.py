"""Vaults that carry a cavity's ceilings: funnels under them, on trees of leaning columns.

The ideas are those of Hornus and Lefebvre, "Iterative carving for self-supporting 3D printed
cavities" (2018), and of tree supports (Vanek et al., "Clever Support", 2014): here as solids that
stay in the part.
"""

from printprep.supports.build import Vaults, vaulted

__all__ = ["Vaults", "vaulted"]
