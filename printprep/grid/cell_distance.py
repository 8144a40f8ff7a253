"""Exact distances between the cells of a grid.

Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012, in the library edt:
seven times as fast as SciPy's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Bool


def cell_distance(cells: Bool) -> NDArray[np.float32]:
    """Distance of every True cell to the nearest False one, centre to centre, in cells.

    cells : (nx, ny) or (nx, ny, nz) bool.  It is 0 at False cells, and inf where all are True.
    """
    import edt

    result: NDArray[np.float32] = edt.edt(
        np.ascontiguousarray(cells), black_border=False, parallel=1
    )
    return result
