"""The substitution for small expressions, evaluated without `eval`."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from launch_py.errors import SubstitutionError
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text

if TYPE_CHECKING:
    import ast
    from collections.abc import Callable


NAMES = {"true": True, "false": False}
"""Launch arguments spell booleans in lower case; to Python these would be unknown names."""

OPERATORS: dict[str, Callable[..., Any]] = {
    "Eq": operator.eq,
    "NotEq": operator.ne,
    "Lt": operator.lt,
    "LtE": operator.le,
    "Gt": operator.gt,
    "GtE": operator.ge,
    "In": lambda a, b: a in b,
    "NotIn": lambda a, b: a not in b,
    "Is": operator.is_,
    "IsNot": operator.is_not,
    "Add": operator.add,
    "Sub": operator.sub,
    "Mult": operator.mul,
    "Div": operator.truediv,
    "FloorDiv": operator.floordiv,
    "Mod": operator.mod,
    "USub": operator.neg,
    "UAdd": operator.pos,
    "Not": operator.not_,
}


class PythonExpression(Substitution):
    """The value of a Python expression of literals: comparisons, logic, arithmetic, if-else.

    Calls, attributes and names other than true and false are errors, because the values that a user
    types for launch arguments end up in this text.
    """

    def __init__(self, expression: Text) -> None:
        self.expression = expression

    def perform(self, context: LaunchScope) -> str:
        """Return the value as text."""
        import ast

        text = perform_text(context, self.expression)
        try:
            return str(_evaluate(ast.parse(text.strip(), mode="eval").body))
        except SyntaxError as error:
            raise SubstitutionError(f"expression {text!r} is not Python: {error.msg}") from error
        except (TypeError, ValueError, ArithmeticError) as error:
            raise SubstitutionError(f"expression {text!r} has no value: {error}") from error

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"PythonExpression({describe_text(self.expression)!r})"


def _evaluate(node: ast.expr) -> Any:
    import ast

    match node:
        case ast.Constant(value):
            return value
        case ast.Name(name) if name in NAMES:
            return NAMES[name]
        case ast.List(items):
            return [_evaluate(item) for item in items]
        case ast.Tuple(items):
            return tuple(_evaluate(item) for item in items)
        case ast.UnaryOp(op, operand) if type(op).__name__ in OPERATORS:
            return OPERATORS[type(op).__name__](_evaluate(operand))
        case ast.BinOp(left, op, right) if type(op).__name__ in OPERATORS:
            return OPERATORS[type(op).__name__](_evaluate(left), _evaluate(right))
        case ast.BoolOp(op, values):
            return _first_deciding(values, truth=isinstance(op, ast.Or))
        case ast.IfExp(test, body, orelse):
            return _evaluate(body if _evaluate(test) else orelse)
        case ast.Compare():
            return _compare(node)
    raise SubstitutionError(
        f"{ast.unparse(node)!r} is not allowed in a PythonExpression: it takes literals, "
        "comparisons, and/or/not, arithmetic and if-else; use Call for anything else"
    )


def _first_deciding(operands: list[ast.expr], truth: bool) -> Any:
    """Return the first operand whose truth value is `truth`, else the last, as and/or do."""
    value = None
    for operand in operands:
        value = _evaluate(operand)
        if bool(value) is truth:
            break
    return value


def _compare(node: ast.Compare) -> bool:
    left = _evaluate(node.left)
    for op, comparator in zip(node.ops, node.comparators, strict=True):
        right = _evaluate(comparator)
        if not OPERATORS[type(op).__name__](left, right):
            return False
        left = right
    return True
