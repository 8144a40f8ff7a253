"""Orders of whole numbers: the same as numpy's, of any size."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from printprep.arrays import stable_order, unique_keys

few_values = st.integers(0, 5)
any_values = st.integers(0, 2**63 - 1)


@given(arrays(np.int64, array_shapes(max_dims=1, min_side=0, max_side=50), elements=few_values))
def test_the_order_of_few_values_is_stable(keys: np.ndarray) -> None:
    assert stable_order(keys).tolist() == np.argsort(keys, kind="stable").tolist()


@given(arrays(np.int64, array_shapes(max_dims=1, min_side=0, max_side=50), elements=any_values))
def test_so_is_that_of_values_of_any_size(keys: np.ndarray) -> None:
    assert stable_order(keys).tolist() == np.argsort(keys, kind="stable").tolist()


def test_small_types_do_not_overflow() -> None:
    for kind in (np.int32, np.uint32, np.uint64):
        keys = np.array([5, 3, 70000, 5, 2**30], dtype=kind)
        assert stable_order(keys).tolist() == [1, 0, 3, 2, 4]
        assert unique_keys(keys)[0].tolist() == [1, 0, 2, 4]


@given(
    arrays(
        np.int64,
        array_shapes(max_dims=1, min_side=0, max_side=50),
        elements=few_values | any_values,
    )
)
def test_unique_keys_are_those_of_numpy(keys: np.ndarray) -> None:
    first, group = unique_keys(keys)
    values, expected_first, expected_group = np.unique(keys, return_index=True, return_inverse=True)
    assert keys[first].tolist() == values.tolist()
    assert first.tolist() == expected_first.tolist()
    assert group.tolist() == expected_group.tolist()
