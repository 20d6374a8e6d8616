"""The expressions of XML, YAML and parameter files: Python's, but without a way out.

Such a file is data, often from elsewhere, and the values that a user types for launch arguments end
up in its expressions. So nothing is looked up by a name that is not listed here, and an expression
that would take much time or memory is refused before it does.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NoReturn

from launch_py.errors import SubstitutionError
from launch_py.near_names import describe_known
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.substitutions.command import NAMES

MAX_CHARACTERS = 4000
"""The longest expression: the parser's stack grows with it."""
MAX_SIZE = 10_000
"""The most characters of a text, or items of a list with all that they hold."""
MAX_BITS = 4096
"""The largest integer."""
MAX_ARGUMENT = 1000
"""The largest argument of those in `BOUNDED`."""
MAX_WORK = 100_000
"""How many operations and items of lists one expression takes, loops included."""

OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Invert: operator.invert,
    ast.Not: operator.not_,
}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{f.__name__: f for f in (abs, all, any, bool, float, int, len, list, max, min, range, repr)},
    **{f.__name__: f for f in (round, sorted, str, sum, tuple)},
}
PLAIN = (bool, int, float, complex, str, list, tuple, dict, set, type(None))
"""What functions may return; views of dicts, ranges and iterators become lists."""
TEXT_METHODS = """
capitalize count endswith find index isalnum isalpha isdigit islower isnumeric isspace isupper join
lower lstrip partition removeprefix removesuffix replace rfind rindex rpartition rsplit rstrip split
splitlines startswith strip swapcase title upper
"""
METHODS: dict[type, frozenset[str]] = {
    str: frozenset(TEXT_METHODS.split()),
    list: frozenset({"count", "index"}),
    tuple: frozenset({"count", "index"}),
    dict: frozenset({"get", "items", "keys", "values"}),
}
"""Methods that return what they can without much time or memory, `join` and `replace` checked."""
BOUNDED = {"comb": 0, "factorial": 0, "perm": 0, "round": 1}
"""Functions whose time grows with the value of an argument, and the first such argument."""
MATH: Mapping[str, Any] = {
    name: value
    for name, value in vars(math).items()
    if not name.startswith("_") and name not in ("lcm", "prod")
}
"""The names of `math`, but for two functions that make large integers of many small ones."""
WIDTH = re.compile(r"\d{4,}|\*")
"""A width or precision that would make a text long, or that an argument gives."""


class SafeExpression(Substitution):
    """The value of a Python expression without side effects, as text.

    Literals, operators, if-else, f-strings, indexing, slices, comprehensions, the usual functions,
    methods of texts and lists that only read, and the names of `math`, with and without its name.
    """

    def __init__(self, expression: Text, python_modules: Text = "math") -> None:
        self.expression = expression
        self.python_modules = python_modules

    def perform(self, context: LaunchScope) -> str:
        """Return the value as text.

        Raises:
            SubstitutionError: the expression is not Python, uses more than is allowed, takes too
                much time or memory, or has no value.
        """
        text = perform_text(context, self.expression).strip()
        for word in perform_text(context, self.python_modules).split(","):
            if word.strip() not in ("", "math"):
                raise SubstitutionError(
                    f"an expression in a file can use the module math only, not {word.strip()!r}"
                )
        if len(text) > MAX_CHARACTERS:
            raise SubstitutionError(f"an expression has more than {MAX_CHARACTERS} characters")
        try:
            return str(_Evaluation().value(ast.parse(text, mode="eval").body, {}))
        except SyntaxError as error:
            raise SubstitutionError(f"expression {text!r} is not Python: {error.msg}") from error
        except (RecursionError, MemoryError) as error:
            raise SubstitutionError(f"expression {text!r} is nested too deep") from error
        except (TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
            raise SubstitutionError(f"expression {text!r} has no value: {error}") from error

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"$(eval {describe_text(self.expression)!r})"


class _Evaluation:
    """Evaluates one expression and counts its work."""

    def __init__(self) -> None:
        self._work = 0

    def value(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        """Return the value of a node, with the variables of the comprehensions around it."""
        return self._checked(self._value(node, local))

    def _value(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        match node:
            case ast.Constant(bool() | int() | float() | complex() | str() | None as value):
                return value
            case ast.Name(name):
                return self._named(name, local)
            case ast.Attribute(ast.Name("math"), name):
                return _known(name, MATH, "math has no")
            case ast.UnaryOp(op, operand):
                return OPERATORS[type(op)](self.value(operand, local))
            case ast.BinOp(left, op, right) if type(op) in OPERATORS:
                return self._binary(type(op), self.value(left, local), self.value(right, local))
            case ast.BoolOp(op, values):
                return self._first_deciding(values, isinstance(op, ast.Or), local)
            case ast.IfExp(test, body, orelse):
                return self.value(body if self.value(test, local) else orelse, local)
            case ast.Compare():
                return self._compare(node, local)
            case ast.Subscript(whole, key):
                return self.value(whole, local)[self._key(key, local)]
            case ast.Call(function, arguments, keywords):
                return self._call(function, self._items(arguments, local), keywords, local)
        return self._collection(node, local)

    def _collection(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        match node:
            case ast.List(items):
                return self._items(items, local)
            case ast.Tuple(items):
                return tuple(self._items(items, local))
            case ast.Set(items):
                return set(self._items(items, local))
            case ast.Dict(keys, values) if None not in keys:
                known = [key for key in keys if key is not None]
                return dict(zip(self._items(known, local), self._items(values, local), strict=True))
            case ast.ListComp(item, loops) | ast.GeneratorExp(item, loops):
                return [self.value(item, inner) for inner in self._loop(loops, local)]
            case ast.JoinedStr(parts):
                return "".join(self.value(part, local) for part in parts)
            case ast.FormattedValue():
                return self._formatted(node, local)
        _refuse(node)

    def _named(self, name: str, local: Mapping[str, Any]) -> Any:
        return _known(name, {**FUNCTIONS, **MATH, **NAMES, **local}, "no name")

    def _items(self, nodes: Iterable[ast.expr], local: Mapping[str, Any]) -> list[Any]:
        items: list[Any] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                items += self._checked(list(self.value(node.value, local)))
            else:
                items.append(self.value(node, local))
        return items

    def _key(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        if not isinstance(node, ast.Slice):
            return self.value(node, local)
        ends = (node.lower, node.upper, node.step)
        return slice(*(None if end is None else self.value(end, local) for end in ends))

    def _binary(self, kind: type[ast.AST], left: Any, right: Any) -> Any:
        size = 0
        if kind is ast.Mult:
            for whole, times in ((left, right), (right, left)):
                if isinstance(whole, str | list | tuple) and isinstance(times, int):
                    size = self._size(whole) * times
        elif kind is ast.Mod and isinstance(left, str) and WIDTH.search(left):
            raise SubstitutionError(f"the format {left!r} makes too long a text")
        elif isinstance(left, int) and isinstance(right, int) and right > 0:
            if kind is ast.Pow:
                _check_bits(left.bit_length() * right)
            elif kind is ast.LShift:
                _check_bits(left.bit_length() + right)
        _check_size(size)
        return OPERATORS[kind](left, right)

    def _first_deciding(
        self, operands: list[ast.expr], truth: bool, local: Mapping[str, Any]
    ) -> Any:
        """Return the first operand whose truth value is `truth`, else the last, as and/or do."""
        value = None
        for operand in operands:
            value = self.value(operand, local)
            if bool(value) is truth:
                break
        return value

    def _compare(self, node: ast.Compare, local: Mapping[str, Any]) -> bool:
        left = self.value(node.left, local)
        for op, comparator in zip(node.ops, node.comparators, strict=True):
            right = self.value(comparator, local)
            if not OPERATORS[type(op)](left, right):
                return False
            left = right
        return True

    def _call(
        self,
        node: ast.expr,
        arguments: list[Any],
        keywords: list[ast.keyword],
        local: Mapping[str, Any],
    ) -> Any:
        named = {k.arg: self.value(k.value, local) for k in keywords if k.arg is not None}
        if len(named) < len(keywords) or "key" in named:
            _refuse(node)
        match node:
            case ast.Name(name) if name not in local:
                function = _known(name, {**FUNCTIONS, **MATH}, "no function")
            case ast.Attribute(ast.Name("math"), name):
                function = _known(name, MATH, "math has no")
            case ast.Attribute(owner, name):
                whole = self.value(owner, local)
                known = METHODS.get(type(whole), ())
                if name not in known:
                    hint = describe_known(name, known, "it can call")
                    raise SubstitutionError(
                        f"{ast.unparse(node)!r} is not allowed in a file; {hint}"
                    )
                self._check_method(name, whole, arguments)
                function = getattr(whole, name)
            case _:
                _refuse(node)
        if name in BOUNDED:
            for argument in (*arguments[BOUNDED[name] :], *named.values()):
                if isinstance(argument, int) and abs(argument) > MAX_ARGUMENT:
                    raise SubstitutionError(f"{name}() of {argument} takes too long")
        result = function(*arguments, **named)
        if isinstance(result, range):
            _check_size(len(result))
        return result if isinstance(result, PLAIN) else list(result)

    def _check_method(self, name: str, whole: Any, arguments: list[Any]) -> None:
        size = 0
        if name == "join" and arguments:
            arguments[0] = list(arguments[0])
            size = len(arguments[0]) * len(whole) + self._size(arguments[0])
        elif name == "replace" and len(arguments) > 1:
            size = (len(whole) + 1) * len(arguments[1])
        _check_size(size)

    def _loop(
        self, loops: list[ast.comprehension], local: Mapping[str, Any]
    ) -> Iterator[Mapping[str, Any]]:
        """Yield the variables of each turn of the nested loops of a comprehension."""
        if not loops:
            yield local
            return
        first, *others = loops
        for item in list(self.value(first.iter, local)):
            inner = {**local, **_bound(first.target, item)}
            if all(self.value(test, inner) for test in first.ifs):
                yield from self._loop(others, inner)

    def _formatted(self, node: ast.FormattedValue, local: Mapping[str, Any]) -> str:
        value = self.value(node.value, local)
        if node.conversion != -1:
            value = {"s": str, "r": repr, "a": ascii}[chr(node.conversion)](value)
        spec = "" if node.format_spec is None else self.value(node.format_spec, local)
        if WIDTH.search(spec):
            raise SubstitutionError(f"the format {spec!r} makes too long a text")
        return format(value, spec)

    def _checked(self, value: Any) -> Any:
        """Return a value that is small enough; count the work for it."""
        if isinstance(value, int):
            _check_bits(value.bit_length())
        else:
            _check_size(self._size(value))
        self._spend(1)
        return value

    def _size(self, value: Any) -> int:
        """Return the characters and items in a value, with all that it holds."""
        if isinstance(value, str):
            return len(value)
        if isinstance(value, dict):
            return self._size([*value, *value.values()])
        if not isinstance(value, list | tuple | set):
            return 1
        size = 0
        for item in value:
            self._spend(1)
            size += 1 + self._size(item)
            _check_size(size)
        return size

    def _spend(self, work: int) -> None:
        self._work += work
        if self._work > MAX_WORK:
            raise SubstitutionError("an expression in a file takes too long")


def _known(name: str, known: Mapping[str, Any], sentence: str) -> Any:
    if name not in known:
        raise SubstitutionError(
            f"{sentence} {name!r} in an expression of a file; {describe_known(name, known)}"
        )
    return known[name]


def _bound(target: ast.expr, item: Any) -> dict[str, Any]:
    match target:
        case ast.Name(name):
            return {name: item}
        case ast.Tuple(targets) | ast.List(targets):
            pairs = zip(targets, item, strict=True)
            return {n: v for one, part in pairs for n, v in _bound(one, part).items()}
    _refuse(target)


def _check_bits(bits: int) -> None:
    if bits > MAX_BITS:
        raise SubstitutionError(f"an expression in a file makes an integer of {bits} bits")


def _check_size(size: int) -> None:
    if size > MAX_SIZE:
        raise SubstitutionError(
            f"an expression in a file makes a value of more than {MAX_SIZE} characters"
        )


def _refuse(node: ast.expr) -> NoReturn:
    raise SubstitutionError(
        f"{ast.unparse(node)!r} is not allowed in an expression of a file; a Python launch file "
        "can use any expression"
    )
