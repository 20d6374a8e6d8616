import json
import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_node.plain_data import PlainDataError, from_plain, to_plain


class Colour(Enum):
    RED = 1


@dataclass(frozen=True)
class Part:
    name: str
    sizes: tuple[float, ...]
    colour: Colour


def through_json(value):
    return from_plain(json.loads(json.dumps(to_plain(value))))


plain_values = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.text(),
        st.binary(),
        st.floats(allow_nan=False),
    ),
    lambda items: (
        st.lists(items)
        | st.lists(items).map(tuple)
        | st.dictionaries(st.text(), items)
        | st.dictionaries(st.integers(), items)
    ),
    max_leaves=20,
)


@given(plain_values)
def test_what_is_written_is_read_back_equal(value):
    assert through_json(value) == value


def test_types_of_collections_are_kept():
    value = ((1, 2), [1, 2], {1, 2}, {"a": (1,)}, {"!data": "no class"})
    read = through_json(value)
    assert read == value
    assert [type(item) for item in read] == [tuple, list, set, dict, dict]


def test_arrays_keep_their_bits_type_and_shape():
    array = np.array([[0.1, math.nan, -0.0], [math.inf, 1e-310, 3.0]])
    read = through_json(array)
    assert read.tobytes() == array.tobytes()
    assert read.shape == (2, 3)
    read[0, 0] = 1.0
    assert through_json(np.array([1, 2], dtype=np.int32)).dtype == np.int32


def test_floats_keep_their_bits():
    assert math.isnan(through_json(math.nan))
    assert through_json(np.float64(0.1)) == 0.1
    assert math.copysign(1.0, through_json(-0.0)) == -1.0


def test_dataclasses_and_enums_are_read_as_what_they_were():
    part = Part("a", (1.0, 2.0), Colour.RED)
    assert through_json(part) == part


def test_what_is_not_plain_data_is_named_by_its_place():
    with pytest.raises(PlainDataError, match=r"command\['a'\]\[1\] is a builtins.object"):
        to_plain({"a": (1, object())}, "command")
    with pytest.raises(PlainDataError, match=r"numpy\.ndarray"):
        to_plain(np.array(["a"]))


@pytest.mark.parametrize(
    "data",
    [
        {"!data": "os:system"},
        {"!data": "antigravity:x"},
        {"!data": "arm_node.plain_data:to_plain"},
        {"!enum": "arm_node.plain_data:PlainDataError", "name": "a"},
        {"!data": "arm_node.plain_data:"},
    ],
)
def test_only_data_classes_that_are_there_are_made(data):
    with pytest.raises(PlainDataError, match="there is no class"):
        from_plain(data)


@pytest.mark.parametrize(
    "data",
    [
        {"!array": "AAAA", "dtype": "<f8", "shape": [1]},
        {"!array": "AAAAAAAAAAA=", "dtype": "O", "shape": [1]},
        {"!bytes": 5},
        {"!dict": [1]},
    ],
)
def test_damaged_data_are_a_sentence(data):
    with pytest.raises(PlainDataError, match="state cannot be read"):
        from_plain(data, "state")


def test_a_missing_module_of_the_suite_is_a_sentence():
    with pytest.raises(PlainDataError):
        from_plain({"!data": "arm_node.nothing:Here"})
