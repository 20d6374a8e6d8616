"""Frozen data classes that cost a start little."""

from collections.abc import Callable, Iterable
from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, field, fields, is_dataclass
from operator import attrgetter
from reprlib import recursive_repr
from typing import Any, TypeVar, dataclass_transform

ClassT = TypeVar("ClassT")
Function = Callable[..., Any]


@dataclass_transform(frozen_default=True, field_specifiers=(field, Field))
def frozen(cls: type[ClassT]) -> type[ClassT]:
    """Make a class what `@dataclass(frozen=True, slots=True)` makes it, in a fifth of the time.

    `dataclasses` writes and compiles six functions for each class, which is a tenth of the work of
    a start. Only `__init__` needs that; the others are closures here. Use it in the modules that
    every start imports; elsewhere the time does not matter.

    A class that derives from a dataclass is left to `dataclasses`. There is no `InitVar`.
    """
    if any(map(is_dataclass, cls.__bases__)):
        return dataclass(frozen=True, slots=True)(cls)
    # Without a docstring, `dataclasses` writes one from the signature, which is not there yet.
    cls.__doc__ = cls.__doc__ or cls.__name__
    made = dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    # Frozen dataclasses may derive from it, and no others.
    vars(made)["__dataclass_params__"].frozen = True
    for function in (_initializer(made), *_guards(made), *_comparisons(made), *_for_copies(made)):
        # What the class defines stays; `__hash__` is None in one that defines `__eq__`.
        if vars(made).get(function.__name__) is None:
            function.__qualname__ = f"{made.__qualname__}.{function.__name__}"
            setattr(made, function.__name__, function)
    return made


def _initializer(cls: type) -> Function:
    """Compile `__init__`, which stores through the slots' descriptors, past `__setattr__`."""
    names: dict[str, Any] = {"__missing": MISSING}
    positional, by_keyword, body = ["self"], list[str](), list[str]()
    for one in fields(cls):
        name, value, default = one.name, one.name, ""
        names[f"__set_{name}"] = getattr(cls, name).__set__
        if one.default_factory is not MISSING:
            names[f"__make_{name}"] = one.default_factory
            value = f"__make_{name}() if {name} is __missing else {name}"
            default = "__missing"
        elif one.default is not MISSING:
            names[f"__default_{name}"] = one.default
            default = f"__default_{name}"
        if one.init:
            arguments = by_keyword if one.kw_only else positional
            arguments.append(f"{name}={default}" if default else name)
        elif default:
            body.append(f" {name} = {default}")
        else:
            continue  # `__post_init__` sets it.
        body.append(f" __set_{name}(self, {value})")
    if hasattr(cls, "__post_init__"):
        body.append(" self.__post_init__()")
    head = ", ".join([*positional, *(["*", *by_keyword] if by_keyword else [])])
    exec("\n".join([f"def __init__({head}):", *body, " return"]), names)
    made: Function = names["__init__"]
    made.__annotations__ = {one.name: one.type for one in fields(cls) if one.init}
    return made


def _guards(cls: type) -> tuple[Function, ...]:
    known = frozenset(one.name for one in fields(cls))

    # An ordinary class that derives from it may have other attributes.
    def __setattr__(self: object, name: str, value: object) -> None:
        if type(self) is cls or name in known:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def __delattr__(self: object, name: str) -> None:
        if type(self) is cls or name in known:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return __setattr__, __delattr__


def _comparisons(cls: type) -> tuple[Function, ...]:
    compared = _values(one.name for one in fields(cls) if one.compare)
    hashed = _values(
        one.name for one in fields(cls) if (one.compare if one.hash is None else one.hash)
    )
    shown = [one.name for one in fields(cls) if one.repr]

    def __eq__(self: object, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return compared(self) == compared(other)

    def __hash__(self: object) -> int:
        return hash(hashed(self))

    @recursive_repr()
    def __repr__(self: object) -> str:
        values = (f"{name}={getattr(self, name)!r}" for name in shown)
        return f"{self.__class__.__qualname__}({', '.join(values)})"

    return __eq__, __hash__, __repr__


def _for_copies(cls: type) -> tuple[Function, ...]:
    """Return what `pickle` and `copy` call, which may not set attributes either."""
    names = tuple(one.name for one in fields(cls))

    def __getstate__(self: object) -> list[object]:
        return [getattr(self, name) for name in names]

    def __setstate__(self: object, state: list[object]) -> None:
        for name, value in zip(names, state, strict=True):
            object.__setattr__(self, name, value)

    return __getstate__, __setstate__


def _values(names: Iterable[str]) -> Callable[[object], tuple[object, ...]]:
    """Return a function that returns the values of an object's attributes."""
    known = tuple(names)
    if len(known) > 1:
        return attrgetter(*known)
    return lambda owner: tuple([getattr(owner, name) for name in known])
