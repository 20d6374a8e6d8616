"""Every test asserts something: itself, or in a function of its own file that it calls."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
FAILING = ("raises", "warns", "fail")


def called(function: ast.AST) -> Iterator[str]:
    """Yield the names of what a function calls, without what they are attributes of."""
    for node in ast.walk(function):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute):
            yield node.func.id if isinstance(node.func, ast.Name) else node.func.attr


def asserts(function: ast.AST) -> bool:
    """Whether a function has an assertion of its own."""
    return any(isinstance(node, ast.Assert) for node in ast.walk(function)) or any(
        name in FAILING or name.startswith("assert_") for name in called(function)
    )


def without_assertion(text: str) -> list[str]:
    """The tests of a file that assert nothing."""
    functions = {
        node.name: node
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    }
    good = {name for name, node in functions.items() if asserts(node)}
    while found := {
        name for name in functions.keys() - good if not good.isdisjoint(called(functions[name]))
    }:
        good |= found
    return sorted(name for name in functions.keys() - good if name.startswith("test_"))


def test_every_test_asserts():
    lazy = {
        str(path.relative_to(TESTS)): names
        for path in TESTS.rglob("test_*.py")
        if (names := without_assertion(path.read_text()))
    }
    assert lazy == {}


@pytest.mark.parametrize(
    ("body", "names"),
    [
        ("act()", ["test_it"]),
        ("assert act()", []),
        ("with pytest.raises(ValueError): act()", []),
        ("check()", []),
        ("wait_until(done)", ["test_it"]),
    ],
)
def test_a_test_without_an_assertion_is_found(body, names):
    helper = "def check(): inner()\ndef inner(): assert act()\n"
    assert without_assertion(f"{helper}def test_it():\n    {body}\n") == names
