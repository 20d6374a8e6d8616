"""Evenly spaced indices become a slice."""

import numpy as np
import pytest

from arm_node.index_slice import as_slice


@pytest.mark.parametrize(
    ("indices", "expected"),
    [
        ([], slice(0, 0)),
        ([4], slice(4, 5, 1)),
        ([2, 3, 4], slice(2, 5, 1)),
        ([1, 4, 7], slice(1, 8, 3)),
    ],
)
def test_rising_indices_of_one_step_are_a_slice(indices, expected):
    assert as_slice(indices) == expected
    assert np.arange(9)[expected].tolist() == indices


@pytest.mark.parametrize("indices", [[3, 2, 1], [1, 1], [0, 1, 3]])
def test_others_are_an_index_array(indices):
    found = as_slice(indices)
    assert isinstance(found, np.ndarray)
    assert found.tolist() == indices


def test_far_apart_indices_take_no_memory_between_them():
    found = as_slice([0, 1, 10**15])
    assert isinstance(found, np.ndarray)
    assert found.tolist() == [0, 1, 10**15]
