"""Make a package import each of its classes on first use.

The generated ``control_msgs/msg/__init__.py`` imports every class of the package, which takes a
third of a millisecond each, but a process uses only a few. Type checkers still see all of them.
"""

import ast
from collections.abc import Iterator

_TEMPLATE = '''\
"""Classes of {package}; each is imported on its first use."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
{imports}

_MODULES = {{
{modules}
}}

__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    try:
        module = _MODULES[name]
    except KeyError:
        raise AttributeError(f"module {{__name__!r}} has no attribute {{name!r}}") from None
    found = globals()[name] = getattr(import_module(module), name)
    return found


def __dir__() -> list[str]:
    return sorted({{*globals(), *_MODULES}})
'''


def make_lazy(source: str, package: str) -> str:
    """Return the text of an ``__init__.py`` that imports its classes on their first use.

    Args:
        source: the generated text: ``from <module> import <class>`` on every line.
        package: dotted name of the package, for its docstring.
    """
    modules = dict(_imports(source))
    return _TEMPLATE.format(
        package=package,
        imports="\n".join(
            f"    from {module} import {name} as {name}" for name, module in modules.items()
        ),
        modules="\n".join(f'    "{name}": "{module}",' for name, module in modules.items()),
    )


def _imports(source: str) -> Iterator[tuple[str, str]]:
    """Yield each imported name with its module."""
    for statement in ast.parse(source).body:
        if not isinstance(statement, ast.ImportFrom) or statement.module is None:
            raise ValueError(f"not an import: {ast.unparse(statement)}")
        for alias in statement.names:
            yield alias.name, statement.module
