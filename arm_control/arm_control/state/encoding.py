"""Encode plain values as bytes: equal values give equal bytes, and decoding runs no code.

Plain values are None, booleans, numbers, strings, bytes, arrays of numbers, enumerations, and
tuples, lists, deques, sets, dictionaries, data classes and `StateValue`s of these. A class is
stored by its name. Decoding looks it up among the modules of the suite and those that are already
imported, and fills in its attributes without calling its constructor, so a file from a stranger can
do no harm.

Each value is a byte that says what it is, and its content. Numbers are little-endian.
"""

import struct
from array import array
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from arm_control.errors import StateError
from arm_control.state.class_names import attributes_by_present_name, class_name, class_named

LENGTH = struct.Struct("<I")
FLOAT = struct.Struct("<d")
ARRAY_KINDS = "biufcSU"
"""Kinds of NumPy arrays whose bytes are their whole content."""
MOST_LEVELS = 100


class StateValue:
    """Base of an immutable class whose attributes are plain values, which makes it one as well."""

    __slots__ = ()


class NotPlainError(StateError):
    """A value cannot be encoded.

    Attributes:
        path: where it is, such as '.queue[3]'; empty for the value that was to be encoded.
        reason: why it cannot be encoded, as the predicate of a sentence.
    """

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path or 'the value'} {reason}")
        self.path = path
        self.reason = reason


def encode(value: Any) -> bytes:
    """Return the bytes of a plain value.

    Raises:
        NotPlainError: the value, or something in it, is not plain.
    """
    parts: list[bytes] = []
    _ByteWriter(parts).write(value, "", 0)
    return b"".join(parts)


def decode(content: bytes) -> Any:
    """Return the value of `encode`d bytes. Its arrays are copies and may be changed.

    Raises:
        StateError: the bytes are damaged, or name a class that is not loaded or has changed.
    """
    reader = _ByteReader(content)
    try:
        value = reader.read()
    except (struct.error, ValueError, TypeError, UnicodeDecodeError, RecursionError) as error:
        raise StateError(f"the state is damaged near byte {reader.at}: {error}") from error
    if reader.at != len(content):
        raise StateError(f"the state ends at byte {reader.at} of {len(content)}")
    return value


class _ByteWriter:
    """Appends the bytes of values to a list."""

    def __init__(self, parts: list[bytes]) -> None:
        self._add = parts.append

    def write(self, value: Any, path: str, level: int) -> None:
        kind = type(value)
        if kind is float:
            self._add(b"f" + FLOAT.pack(value))
        elif value is None:
            self._add(b"N")
        elif kind is bool:
            self._add(b"T" if value else b"F")
        elif kind is int:
            self._sized(b"i", value.to_bytes(value.bit_length() // 8 + 1, "little", signed=True))
        elif kind is str:
            self._sized(b"s", value.encode("utf-8", "surrogatepass"))
        elif kind is bytes:
            self._sized(b"b", value)
        elif kind is np.ndarray:
            self._array(b"a", value, path)
        elif kind is array:
            # A sequence of a ROS message.
            self._array(b"A", np.array(value), path)
        elif level >= MOST_LEVELS:
            raise NotPlainError(path, "is nested too deeply, or contains itself")
        elif kind in _CONTAINERS:
            self._container(value, path, level + 1)
        else:
            self._instance(value, path, level + 1)

    def _sized(self, tag: bytes, content: bytes) -> None:
        self._add(tag + LENGTH.pack(len(content)))
        self._add(content)

    def _array(self, tag: bytes, values: np.ndarray, path: str) -> None:
        if values.dtype.kind not in ARRAY_KINDS:
            raise NotPlainError(path, f"is an array of {values.dtype}, not of numbers")
        little = values.astype(values.dtype.newbyteorder("<"), copy=False)
        self._add(tag)
        self.write(little.dtype.str, path, 0)
        self.write(values.shape, path, 0)
        self._sized(b"", little.tobytes())

    def _container(self, value: Any, path: str, level: int) -> None:
        self._add(_CONTAINERS[type(value)] + LENGTH.pack(len(value)))
        if isinstance(value, dict):
            for key, item in value.items():
                inside = f"{path}.{key}" if isinstance(key, str) else f"{path}[{key!r}]"
                self.write(key, inside, level)
                self.write(item, inside, level)
            return
        if isinstance(value, deque):
            self.write(value.maxlen, path, level)
        if isinstance(value, (set, frozenset)):
            # The order of a set depends on the process.
            self._add(b"".join(sorted(encode(item) for item in value)))
            return
        for index, item in enumerate(value):
            self.write(item, f"{path}[{index}]", level)

    def _instance(self, value: Any, path: str, level: int) -> None:
        kind = type(value)
        if isinstance(value, np.generic):
            self.write(value.item(), path, level)
        elif isinstance(value, Enum):
            self._add(b"e")
            self.write(_name_of(kind, path), path, 0)
            self.write(value.name, path, 0)
        elif isinstance(value, tuple) and hasattr(kind, "_fields"):
            self._add(b"n")
            self.write(_name_of(kind, path), path, 0)
            self.write(tuple(value), path, level)
        elif _has_plain_attributes(kind):
            self._add(b"D")
            self.write(_name_of(kind, path), path, 0)
            names = [name for name in _attributes_of(kind) if hasattr(value, name)]
            self._add(LENGTH.pack(len(names)))
            for name in names:
                self.write(name, path, 0)
                self.write(getattr(value, name), f"{path}.{name}", level)
        else:
            raise NotPlainError(path, f"is a {kind.__module__}.{kind.__qualname__}")


class _ByteReader:
    """Reads values from bytes.

    Attributes:
        at: where the next value begins.
    """

    def __init__(self, content: bytes) -> None:
        self._content = content
        self.at = 0

    def read(self) -> Any:
        tag = self._take(1)
        make = _READERS.get(tag)
        if make is None:
            raise ValueError(f"{tag!r} starts no value")
        return make(self)

    def number(self) -> float:
        return FLOAT.unpack(self._take(8))[0]

    def sized(self) -> bytes:
        return self._take(self._length())

    def items(self) -> Iterator[Any]:
        for _ in range(self._length()):
            yield self.read()

    def numbers(self) -> np.ndarray:
        dtype, shape = np.dtype(self.read()), self.read()
        if dtype.kind not in ARRAY_KINDS:
            raise ValueError(f"an array of {dtype}")
        return np.frombuffer(self.sized(), dtype).reshape(shape).copy()

    def dictionary(self) -> dict[Any, Any]:
        return {self.read(): self.read() for _ in range(self._length())}

    def queue(self) -> deque[Any]:
        count, most = self._length(), self.read()
        return deque((self.read() for _ in range(count)), most)

    def member(self) -> Enum:
        kind, name = self._class(lambda found: issubclass(found, Enum)), self.read()
        if name not in kind.__members__:
            raise StateError(f"{kind.__qualname__} has no member {name}: its code has changed")
        return kind[name]

    def named_tuple(self) -> Any:
        kind = self._class(lambda found: issubclass(found, tuple) and hasattr(found, "_fields"))
        return tuple.__new__(kind, self.read())

    def instance(self) -> Any:
        kind = self._class(_has_plain_attributes)
        value, title = object.__new__(kind), str(kind.__qualname__)
        known = set(_attributes_of(kind))
        given = attributes_by_present_name(kind, self.dictionary())
        if not given.keys() <= known or (is_dataclass(kind) and given.keys() != known):
            raise StateError(
                f"{title} has the attributes {', '.join(sorted(known))}, but the state "
                f"has {', '.join(sorted(given))}: its code has changed"
            )
        for name, item in given.items():
            object.__setattr__(value, name, item)
        return value

    def _class(self, fits: Callable[[type[Any]], bool]) -> Any:
        name = self.read()
        try:
            found = class_named(name)
        except ImportError:
            found = None
        if not (isinstance(found, type) and fits(found)):
            raise StateError(f"the state needs the class '{name}', which is not loaded")
        return found

    def _length(self) -> int:
        return LENGTH.unpack(self._take(LENGTH.size))[0]

    def _take(self, size: int) -> bytes:
        end = self.at + size
        if end > len(self._content):
            raise ValueError(f"{size} bytes are needed, {len(self._content) - self.at} are left")
        taken, self.at = self._content[self.at : end], end
        return taken


_CONTAINERS: dict[type[Any], bytes] = {
    tuple: b"t",
    list: b"l",
    dict: b"d",
    set: b"S",
    frozenset: b"Z",
    deque: b"q",
}
_READERS: dict[bytes, Callable[[_ByteReader], Any]] = {
    b"N": lambda _: None,
    b"T": lambda _: True,
    b"F": lambda _: False,
    b"f": _ByteReader.number,
    b"i": lambda reader: int.from_bytes(reader.sized(), "little", signed=True),
    b"s": lambda reader: reader.sized().decode("utf-8", "surrogatepass"),
    b"b": _ByteReader.sized,
    b"a": _ByteReader.numbers,
    b"A": lambda reader: _array_of(reader.numbers()),
    b"t": lambda reader: tuple(reader.items()),
    b"l": lambda reader: list(reader.items()),
    b"S": lambda reader: set(reader.items()),
    b"Z": lambda reader: frozenset(reader.items()),
    b"d": _ByteReader.dictionary,
    b"q": _ByteReader.queue,
    b"e": _ByteReader.member,
    b"n": _ByteReader.named_tuple,
    b"D": _ByteReader.instance,
}


def _array_of(numbers: np.ndarray) -> "array[Any]":
    return array(numbers.dtype.char, numbers.tobytes())


def _has_plain_attributes(kind: type[Any]) -> bool:
    return is_dataclass(kind) or issubclass(kind, StateValue)


def _attributes_of(kind: type[Any]) -> Iterable[str]:
    if is_dataclass(kind):
        return [field.name for field in fields(kind)]
    return [name for base in kind.__mro__ for name in base.__dict__.get("__slots__", ())]


def _name_of(kind: type[Any], path: str) -> str:
    if "<locals>" in kind.__qualname__:
        raise NotPlainError(path, f"is a {kind.__qualname__}, a class that no other run can find")
    return class_name(kind)
