"""Frozen data classes: they behave as those of `dataclasses`."""

import copy
import dataclasses
import inspect
import pickle
from dataclasses import FrozenInstanceError, dataclass, field

import pytest

from arm_node.frozen import frozen


def _count() -> int:
    return 3


def _body(decorate: object) -> type:
    class Sample:
        """A sample."""

        one: int
        """A sample's first value."""
        missing: str = "none"
        made: list[int] = field(default_factory=list)
        apart: object = field(default=None, compare=False)
        hidden: int = field(default=4, repr=False)
        counted: int = field(init=False, default_factory=_count)
        fixed: int = field(init=False, default=5)
        later: int = field(init=False)
        named: int = field(default=6, kw_only=True)

        def __post_init__(self) -> None:
            object.__setattr__(self, "later", self.one + 1)

        def doubled(self) -> int:
            return 2 * self.one

    return decorate(Sample)


OURS = _body(frozen)
THEIRS = _body(dataclass(frozen=True, slots=True))


@frozen
class Point:
    """A point."""

    x: float
    y: float = 0.0


@frozen
class Nothing:
    """A class without fields."""


@frozen
class Single:
    """A class with one field."""

    x: float


@frozen(kw_only=True)
class ByName:
    """A class whose values have names only."""

    z: float = 0.0


@frozen
class Placed(ByName):
    """A class that adds to them a value without a default."""

    place: str


@dataclass(frozen=True)
class Unslotted:
    """A dataclass of a user, without slots."""

    w: float = 0.0


@frozen
class FromUnslotted(Unslotted):
    """A class that derives from one of `dataclasses`."""

    v: float = 0.0


@frozen
class Named(Point):
    """A point with a name, which derives from another of these classes."""

    name: str = ""


@dataclass(frozen=True, slots=True)
class Coloured(Point):
    """A point of a user, who knows `dataclasses` only."""

    colour: str = "red"


class Free(Point):
    """An ordinary class with a value of its own."""

    def __init__(self) -> None:
        super().__init__(1.0)
        self.own = 2


@frozen
class Equal:
    """A class with methods of its own."""

    x: int

    def __eq__(self, other: object) -> bool:
        return True

    def __repr__(self) -> str:
        return "equal"


@pytest.mark.parametrize("cls", [OURS, THEIRS])
def test_fields_defaults_and_post_init(cls):
    sample = cls(1, named=7)
    values = (1, "none", [], None, 4, 3, 5, 2, 7)
    assert dataclasses.astuple(sample) == values
    assert cls(1).made is not cls(1).made
    assert cls("a" and 2, missing="m", made=[1], hidden=0).doubled() == 4
    assert not hasattr(sample, "__dict__")


@pytest.mark.parametrize("cls", [OURS, THEIRS])
def test_nothing_can_be_set_or_deleted(cls):
    sample = cls(1)
    for name in ("one", "other"):
        with pytest.raises((FrozenInstanceError, TypeError)):
            setattr(sample, name, 2)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'one'"):
        sample.one = 2
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'one'"):
        del sample.one
    assert sample.one == 1


def test_text_equality_and_hash_are_those_of_dataclasses():
    ours, theirs = OURS(1, made=(), apart=1), THEIRS(1, made=(), apart=1)
    assert repr(ours) == repr(theirs)
    assert ours == OURS(1, made=(), apart=2)
    assert ours != OURS(2, made=())
    assert ours != theirs
    assert hash(ours) == hash(OURS(1, made=(), apart=2)) == hash(theirs)
    assert (hash(Single(1.0)), hash(Nothing())) == (hash((1.0,)), hash(()))
    assert (Single(1.0), Nothing()) == (Single(1.0), Nothing())
    assert Single(1.0) != Single(2.0)


def test_what_a_class_defines_itself_stays():
    assert (Equal(1) == Equal(2), repr(Equal(1)), hash(Equal(1))) == (True, "equal", hash((1,)))


@pytest.mark.parametrize(
    ("arguments", "keywords"), [((), {}), ((1, 2, 3, 4, 5, 6), {}), ((1,), {"no": 2})]
)
def test_wrong_arguments_are_refused_in_the_same_words(arguments, keywords):
    messages = []
    for cls in (OURS, THEIRS):
        with pytest.raises(TypeError) as error:
            cls(*arguments, **keywords)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_the_module_dataclasses_knows_it():
    names = [each.name for each in dataclasses.fields(OURS)]
    assert names == [each.name for each in dataclasses.fields(THEIRS)]
    assert OURS.__match_args__ == THEIRS.__match_args__
    assert dataclasses.replace(Point(1.0), y=2.0) == Point(1.0, 2.0)
    ours, theirs = inspect.signature(OURS), inspect.signature(THEIRS)
    assert [*ours.parameters] == [*theirs.parameters]
    assert ours.return_annotation is theirs.return_annotation
    assert OURS.__doc__ == "A sample."


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))]
)
def test_copies_are_equal(copied):
    assert copied(Point(1.0, 2.0)) == Point(1.0, 2.0)
    assert copied(Named(1.0, 2.0, "a")) == Named(1.0, 2.0, "a")


def test_values_of_a_derived_class_come_after_those_with_names_only():
    placed = Placed("here", z=1.0)
    assert (placed.z, placed.place) == (1.0, "here")
    assert repr(placed) == "Placed(z=1.0, place='here')"
    assert (placed, hash(placed)) == (Placed("here", z=1.0), hash((1.0, "here")))
    assert not hasattr(placed, "__dict__")
    with pytest.raises(TypeError, match="takes 2 positional arguments"):
        Placed("here", 1.0)
    for name in ("z", "place", "other"):
        with pytest.raises(FrozenInstanceError):
            setattr(placed, name, 2.0)
        with pytest.raises(FrozenInstanceError):
            delattr(placed, name)


def test_it_may_derive_from_a_dataclass_without_slots():
    derived = FromUnslotted(1.0, 2.0)
    assert (derived.w, derived.v) == (1.0, 2.0)
    with pytest.raises(FrozenInstanceError):
        derived.w = 3.0


@pytest.mark.parametrize("cls", [Named, Coloured])
def test_frozen_classes_may_derive_from_it(cls):
    point = cls(1.0, 2.0, "a")
    assert (point.x, point.y) == (1.0, 2.0)
    assert [each.name for each in dataclasses.fields(point)][:2] == ["x", "y"]
    assert point != Point(1.0, 2.0)
    with pytest.raises(FrozenInstanceError):
        point.x = 3.0


def test_a_class_that_is_not_frozen_may_not_derive_from_it():
    with pytest.raises(TypeError, match="non-frozen"):

        @dataclass
        class _Open(Point):
            name: str = ""


def test_an_ordinary_class_that_derives_from_it_may_have_more():
    free = Free()
    free.own += 1
    assert (free.x, free.own) == (1.0, 3)
    del free.own
    with pytest.raises(FrozenInstanceError):
        free.x = 2.0
