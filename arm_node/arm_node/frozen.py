"""Frozen data classes that cost a start little."""

from collections.abc import Callable, Iterable
from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, field, fields, is_dataclass
from functools import partial
from operator import attrgetter
from reprlib import recursive_repr
from typing import Any, TypeVar, dataclass_transform, overload

ClassT = TypeVar("ClassT")
Function = Callable[..., Any]
Fields = tuple[Field[Any], ...]


@overload
def frozen(cls: type[ClassT], /) -> type[ClassT]: ...


@overload
def frozen(*, kw_only: bool) -> Callable[[type[ClassT]], type[ClassT]]: ...


@dataclass_transform(frozen_default=True, field_specifiers=(field, Field))
def frozen(cls: type[Any] | None = None, /, *, kw_only: bool = False) -> Any:
    """Make a class what `@dataclass(frozen=True, slots=True)` makes it, in a fifth of the time.

    `dataclasses` writes and compiles six functions for each class, which is a tenth of the work of
    a start. Only `__init__` needs that; the others are closures here. Use it in the modules that
    every start imports; elsewhere the time does not matter.

    A class that derives from a dataclass without slots is left to `dataclasses`. There is no
    `InitVar`.
    """
    if cls is None:
        return partial(_made, kw_only=kw_only)
    return _made(cls, kw_only)


def _made(cls: type[Any], kw_only: bool) -> type[Any]:
    bases = [base for base in cls.__mro__[1:] if is_dataclass(base)]
    if not all("__slots__" in vars(base) for base in bases):
        return dataclass(frozen=True, slots=True, kw_only=kw_only)(cls)
    # What the class defines stays; `__hash__` is None in one that defines `__eq__`.
    defined = {name for name, value in vars(cls).items() if value is not None}
    # Without a docstring, `dataclasses` writes one from the signature, which is not there yet.
    cls.__doc__ = cls.__doc__ or cls.__name__
    # Only a frozen class may derive from a frozen one.
    is_frozen = bool(bases)
    made = dataclass(
        init=False, repr=False, eq=False, frozen=is_frozen, slots=True, kw_only=kw_only
    )(cls)
    # Frozen dataclasses may derive from it, and no others.
    vars(made)["__dataclass_params__"].frozen = True
    known = fields(made)
    functions = (
        _initializer(made, known),
        *_guards(made, known),
        *_comparisons(known),
        *_for_copies(known),
    )
    for function in functions:
        if function.__name__ not in defined:
            function.__qualname__ = f"{made.__qualname__}.{function.__name__}"
            setattr(made, function.__name__, function)
    return made


def _initializer(cls: type, known: Fields) -> Function:
    """Compile `__init__`, which stores through the slots' descriptors, past `__setattr__`."""
    names: dict[str, Any] = {"__missing": MISSING}
    positional, by_keyword, body = ["self"], list[str](), list[str]()
    for one in known:
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
    made.__annotations__ = {one.name: one.type for one in known if one.init} | {"return": None}
    return made


def _guards(cls: type, known: Fields) -> tuple[Function, ...]:
    names = frozenset(one.name for one in known)

    # An ordinary class that derives from it may have other attributes.
    def __setattr__(self: object, name: str, value: object) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def __delattr__(self: object, name: str) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return __setattr__, __delattr__


def _comparisons(known: Fields) -> tuple[Function, ...]:
    compared = _values(one.name for one in known if one.compare)
    hashed = _values(one.name for one in known if (one.compare if one.hash is None else one.hash))
    shown = [one.name for one in known if one.repr]

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


def _for_copies(known: Fields) -> tuple[Function, ...]:
    """Return what `pickle` and `copy` call, which may not set attributes either."""
    names = tuple(one.name for one in known)

    def __getstate__(self: object) -> list[object]:
        return [getattr(self, name) for name in names]

    def __setstate__(self: object, state: list[object]) -> None:
        for name, value in zip(names, state, strict=True):
            object.__setattr__(self, name, value)

    return __getstate__, __setstate__


def _values(names: Iterable[str]) -> Callable[[object], tuple[object, ...]]:
    """Return a function that returns the values of an object's attributes."""
    chosen = tuple(names)
    if len(chosen) > 1:
        return attrgetter(*chosen)
    return lambda owner: tuple([getattr(owner, name) for name in chosen])
