"""The interfaces that a controller asks for, and those it is lent: evenly spaced or not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.controllers.controller import InterfaceConfiguration as Wish
from arm_control.controllers.loaned_interfaces import LoanedInterfaces
from arm_control.controllers.loaned_interfaces import loan as scattered


def loan(array: np.ndarray, positions: list[int]) -> LoanedInterfaces:
    return LoanedInterfaces([f"i{p}" for p in positions], array, positions)


@given(st.lists(st.integers(0, 11), unique=True, max_size=12))
def test_it_reads_and_writes_in_the_order_asked(positions):
    array = np.arange(12.0)
    window = loan(array, positions)
    assert window.read().tolist() == [float(p) for p in positions]
    window.write(np.arange(100.0, 100.0 + len(positions)))
    assert array[positions].tolist() == [100.0 + i for i in range(len(positions))]
    untouched = [p for p in range(12) if p not in positions]
    assert array[untouched].tolist() == [float(p) for p in untouched]


@pytest.mark.parametrize("positions", [[2, 3, 4], [1, 4, 7, 10], [5]])
def test_evenly_spaced_interfaces_are_read_without_a_copy(positions):
    array = np.zeros(12)
    assert np.shares_memory(loan(array, positions).read(), array)


def test_one_value_is_written_to_all():
    array = np.ones(4)
    loan(array, [3, 0]).write(0.0)
    assert array.tolist() == [0.0, 1.0, 1.0, 0.0]


def test_its_length_is_the_number_of_interfaces():
    assert (len(loan(np.zeros(4), [3, 0])), len(loan(np.zeros(4), []))) == (2, 0)


def test_interfaces_of_several_arrays_are_one_window():
    first, second = np.arange(3.0), np.array([10.0, 20.0])
    window = scattered(["a", "b", "c", "d"], [(first, 2), (second, 1), (first, 0), (second, 0)])
    assert window.read().tolist() == [2.0, 20.0, 0.0, 10.0]
    window.write([1.0, 2.0, 3.0, 4.0])
    assert (first.tolist(), second.tolist()) == ([3.0, 1.0, 1.0], [4.0, 2.0])
    window.write(0.0)
    assert (first.tolist(), second.tolist()) == ([0.0, 1.0, 0.0], [0.0, 0.0])


def test_interfaces_of_one_array_are_read_without_a_copy():
    array = np.arange(4.0)
    window = scattered(["a", "b"], [(array, 1), (array, 2)])
    assert np.shares_memory(window.read(), array)


def test_no_interfaces_are_an_empty_window():
    assert scattered([], []).read().tolist() == []


@given(st.permutations([(which, place) for which in range(3) for place in range(4)]), st.data())
def test_whatever_the_order_several_arrays_are_read_and_written(places, data):
    places = places[: data.draw(st.integers(0, len(places)))]
    arrays = [10.0 * which + np.arange(4.0) for which in range(3)]
    before = [array.copy() for array in arrays]
    window = scattered([f"{w}/{p}" for w, p in places], [(arrays[w], p) for w, p in places])
    assert window.read().tolist() == [10.0 * w + p for w, p in places]
    window.write(100.0 + np.arange(len(places)))
    for number, (which, place) in enumerate(places):
        assert arrays[which][place] == 100.0 + number
        before[which][place] = 100.0 + number
    assert [array.tolist() for array in arrays] == [array.tolist() for array in before]


EXISTING = ("j0/position", "j0/velocity", "j1/position", "tool/grip")


@pytest.mark.parametrize(
    ("wish", "names"),
    [
        (Wish.none(), ()),
        (Wish.all(), EXISTING),
        (Wish.individual(["j1/position", "x/y"]), ("j1/position", "x/y")),
        (Wish.individual_best_effort(["tool/grip", "x/y"]), ("tool/grip",)),
        (Wish.regex([r"j\d/position"]), ("j0/position", "j1/position")),
        (Wish.regex(["position"]), ()),
    ],
)
def test_names(wish, names):
    assert wish.resolve(EXISTING) == names
