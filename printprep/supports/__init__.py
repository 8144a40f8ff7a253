"""Vaults that carry a cavity's ceilings: funnels on trees of leaning columns.

They stay in the part, as solids.  The ideas come from Hornus and Lefebvre, "Iterative carving for
self-supporting 3D printed cavities" (2018), and from tree supports (Vanek et al., "Clever Support",
2014).
"""

from printprep.supports.build import Vaults, vaulted

__all__ = ["Vaults", "vaulted"]
