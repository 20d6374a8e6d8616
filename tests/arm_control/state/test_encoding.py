"""Plain values keep every bit, equal values have equal bytes, and nothing else is taken."""

import math
import os
import struct
import threading
from array import array
from collections import deque
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from arm_control.errors import StateError
from arm_control.lifecycle import LifecycleState
from arm_control.state.attributes import load_attributes, save_attributes
from arm_control.state.encoding import NotPlainError, StateValue, decode, encode


class Colour(Enum):
    RED = "red"


class Pair(NamedTuple):
    left: int
    right: float


@dataclass(frozen=True, slots=True)
class Frozen:
    name: str
    inner: "Frozen | None" = None

    def __post_init__(self) -> None:
        assert self.name != "forbidden", "decoding must not run the constructor"


class Curve(StateValue):
    __slots__ = ("_points", "end")

    def __init__(self, points: np.ndarray) -> None:
        self._points = points
        self.end = float(points[-1])


SIMPLE = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(),
    st.binary(),
    st.sampled_from([Colour.RED, *LifecycleState]),
    arrays.arrays(
        st.sampled_from([np.float64, np.int32, np.bool_, np.dtype(">f4"), np.dtype("<U3")]),
        arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=3),
    ),
)
KEYS = st.one_of(st.text(), st.integers(), st.tuples(st.text(), st.integers()))
VALUES = st.recursive(
    SIMPLE,
    lambda inside: st.one_of(
        st.lists(inside),
        st.lists(inside).map(tuple),
        st.lists(inside).map(lambda items: deque(items, 5)),
        st.dictionaries(KEYS, inside),
        st.frozensets(KEYS),
        st.sets(KEYS),
        st.builds(Frozen, st.text().filter(lambda name: name != "forbidden"), st.none()),
        st.builds(Pair, st.integers(), st.floats(allow_nan=False)),
    ),
    max_leaves=20,
)


@given(VALUES)
def test_a_value_comes_back_with_its_bits(value):
    encoded = encode(value)
    again = decode(encoded)
    assert encode(again) == encoded
    assert type(again) is type(value)


@given(VALUES, st.data())
def test_damaged_bytes_are_refused_or_read_but_never_raise_anything_else(value, data):
    encoded = bytearray(encode(value))
    place = data.draw(st.integers(0, len(encoded) - 1))
    encoded[place] ^= data.draw(st.integers(1, 255))
    try:
        read = encode(decode(bytes(encoded)))
    except StateError as error:
        read = str(error).encode()
    assert read, "an array may have another number by now, and a text another letter"


@given(VALUES)
def test_bytes_that_end_too_early_are_refused(value):
    encoded = encode(value)
    with pytest.raises(StateError):
        decode(encoded[:-1])


def test_numbers_keep_signs_and_payloads():
    odd = struct.unpack("<d", b"\x01\x00\x00\x00\x00\x00\xf8\x7f")[0]
    values = [0.0, -0.0, math.inf, -math.inf, odd, 5e-324, -(10**40)]
    assert encode(decode(encode(values))) == encode(values)
    assert encode(-0.0) != encode(0.0)


def test_a_big_endian_array_has_the_bytes_of_its_numbers():
    numbers = np.array([1.0, 2.0])
    assert encode(numbers.astype(">f8")) == encode(numbers)


def test_a_decoded_array_may_be_changed():
    array = decode(encode(np.zeros(3)))
    array[:] = 1.0
    assert array.tolist() == [1.0, 1.0, 1.0]


@pytest.mark.parametrize("kind", "bBhHiIlLqQfd")
def test_a_sequence_of_a_message_comes_back_as_one(kind):
    numbers = array(kind, [1, 2, 3])
    again = decode(encode(numbers))
    assert (type(again), again) == (array, numbers)
    assert again.itemsize == numbers.itemsize


def test_sets_have_one_encoding():
    assert encode({"a", "b", "c"}) == encode({"c", "b", "a"})


def test_values_of_classes_come_back_without_their_constructors():
    assert decode(encode(Frozen("a", Frozen("b")))) == Frozen("a", Frozen("b"))
    forbidden = encode(Frozen("forbidde_")).replace(b"forbidde_", b"forbidden")
    assert decode(forbidden).name == "forbidden"
    curve = decode(encode(Curve(np.arange(3.0))))
    assert isinstance(curve, Curve)
    assert curve.end == 2.0
    pair = decode(encode(Pair(1, 2.0)))
    assert isinstance(pair, Pair)
    assert pair == (1, 2.0)


def test_other_values_are_refused_with_their_place():
    with pytest.raises(NotPlainError, match=r"\.queue\[1\]\.lock is a _thread\.lock"):
        encode({"queue": [1, {"lock": threading.Lock()}]})
    with pytest.raises(NotPlainError, match="array of object"):
        encode(np.array([None]))


def test_a_value_that_contains_itself_is_refused():
    loop: list[Any] = []
    loop.append(loop)
    with pytest.raises(NotPlainError, match="contains itself"):
        encode(loop)


def test_a_class_inside_a_function_is_refused():
    @dataclass
    class Local:
        number: int = 0

    with pytest.raises(NotPlainError, match="no other run can find"):
        encode(Local())


@pytest.mark.parametrize("name", ["os:system", "subprocess:Popen", "builtins:eval", "no.such:X"])
def test_only_plain_classes_are_looked_up(name):
    encoded = encode(Frozen("a"))
    ours = f"{Frozen.__module__}:Frozen".encode()
    theirs = name.encode()
    foreign = encoded.replace(
        struct.pack("<I", len(ours)) + ours, struct.pack("<I", len(theirs)) + theirs
    )
    assert foreign != encoded
    with pytest.raises(StateError, match="which is not loaded"):
        decode(foreign)
    assert os.system is not None


def test_a_class_that_has_changed_since_is_refused():
    with pytest.raises(StateError, match="its code has changed"):
        decode(encode(Frozen("a")).replace(b"inner", b"outer"))


def test_bytes_that_go_on_are_refused():
    with pytest.raises(StateError, match="ends at byte 1 of 2"):
        decode(encode(None) + b"N")


class Counter:
    """Has a part with a state of its own, and an array that others look at."""

    def __init__(self) -> None:
        self.count = 0
        self.array = np.zeros(2)
        self.part: Any = Part()
        self.handle = open


class Part:
    def __init__(self) -> None:
        self.number = 0

    def save_state(self) -> int:
        return self.number

    def load_state(self, state: int) -> None:
        self.number = state


def test_attributes_are_restored_in_place():
    counter = Counter()
    counter.count, counter.part.number = 3, 4
    counter.array[:] = 5.0
    saved = encode(save_attributes(counter, ("handle",)))
    view, part = counter.array, counter.part
    counter.count, counter.part.number = 0, 0
    counter.array[:] = 0.0
    load_attributes(counter, decode(saved))
    assert (counter.count, part.number, view.tolist()) == (3, 4, [5.0, 5.0])
    assert counter.part is part
    assert counter.array is view


def test_an_array_of_another_shape_is_replaced():
    counter = Counter()
    load_attributes(counter, {"array": np.ones(3)})
    assert counter.array.tolist() == [1.0, 1.0, 1.0]
