"""The substitution for Python expressions of Python launch files."""

from __future__ import annotations

from importlib import import_module
from os import PathLike
from typing import Any
from warnings import catch_warnings

from launch_py.errors import LaunchError, SubstitutionError
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text

NAMES = {"true": True, "false": False}
"""Launch arguments spell booleans in lower case; to Python these would be unknown names."""


class PythonExpression(Substitution):
    """The value of a Python expression, as text.

    A Python launch file is a program, so any expression is evaluated. `$(eval ...)` in XML, YAML
    and parameter files is a `SafeExpression`.

    Args:
        expression: the expression.
        python_modules: modules that the expression uses by their names; the names in `math` can
            also be used without it.
    """

    def __init__(self, expression: Text, python_modules: Text = ("math",)) -> None:
        self.expression = expression
        single = isinstance(python_modules, str | PathLike | Substitution)
        self.python_modules = [python_modules] if single else list(python_modules)

    def perform(self, context: LaunchScope) -> str:
        """Return the value as text.

        Raises:
            SubstitutionError: there is no such module, or evaluating raises an error.
        """
        text = perform_text(context, self.expression)
        names: dict[str, Any] = dict(NAMES)
        try:
            for part in self.python_modules:
                name = perform_text(context, part)
                module = import_module(name)
                if name == "math":
                    names |= vars(module)
                names[name] = module
            with catch_warnings(action="ignore", category=SyntaxWarning):
                # The text after substitution is often `'arm' is not None`.
                code = compile(text.strip(), "expression", "eval")
            # As globals, because the scopes of comprehensions and lambdas see these only.
            return str(eval(code, names))
        except LaunchError:
            raise
        except SyntaxError as error:
            raise SubstitutionError(f"expression {text!r} is not Python: {error.msg}") from error
        except Exception as error:
            kind = type(error).__name__
            raise SubstitutionError(f"expression {text!r} raises {kind}: {error}") from error

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"PythonExpression({describe_text(self.expression)!r})"
