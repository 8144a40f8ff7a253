"""Array types of function signatures (docstrings give shapes and units), runs and orders."""

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


def stable_order(keys: Int) -> Int:
    """(n,) ``argsort(keys, kind="stable")`` of whole numbers (n,) from 0, several times as fast.

    Key and place are sorted as one number, where both fit into one.
    """
    keys = keys.astype(np.int64, copy=False)
    place_bits = len(keys).bit_length()
    if not len(keys) or int(keys.max()).bit_length() + place_bits > 63:
        return np.argsort(keys, kind="stable")
    both = keys << place_bits
    both |= np.arange(len(keys))
    both.sort()
    both &= (1 << place_bits) - 1
    return both


def unique_keys(keys: Int) -> tuple[Int, Int]:
    """(k,) where each different key comes first, ascending by key, and (n,) which one each is.

    keys : (n,) whole numbers from 0.  ``numpy.unique`` gives the same with ``return_index`` and
    ``return_inverse``, several times as slowly.
    """
    order = stable_order(keys)
    ordered = keys[order]
    fresh = np.ones(len(order), dtype=bool)
    fresh[1:] = ordered[1:] != ordered[:-1]
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(fresh) - 1
    return order[fresh], group
