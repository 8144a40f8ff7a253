"""Array types of function signatures (docstrings give shapes and units), and runs of indices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Int = NDArray[np.int64]
Bool = NDArray[np.bool_]


def runs(lengths: Int) -> tuple[Int, Int]:
    """(k,) which run, and (k,) which place in it, for runs (n,) of these lengths one after another.

    Lengths 2, 0, 3 give runs 0 0 2 2 2 and places 0 1 0 1 2.
    """
    run = np.repeat(np.arange(len(lengths)), lengths)
    return run, np.arange(len(run)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
