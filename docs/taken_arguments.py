"""Griffe extensions: show the arguments of classes whose source does not list them.

`arm_sim.arguments.takes` gives a class's `__init__` those of a dataclass, which has the help of
each. `arm_node.frozen` makes dataclasses, as Griffe knows them from `dataclasses` only.
"""

import inspect
from importlib import import_module
from typing import Any

import griffe

DECORATOR = "takes"
FROZEN = "frozen"


class TakenArguments(griffe.Extension):
    """Gives the page of a class the signature and the docstring that Python itself shows."""

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        """Replace what the source says about the arguments of `__init__`."""
        method = cls.members.get("__init__")
        if not isinstance(method, griffe.Function):
            return
        if not any(str(each.value).startswith(f"{DECORATOR}(") for each in method.decorators):
            return
        found = getattr(import_module(cls.module.path), cls.name)
        taken = inspect.signature(found.__init__).parameters.values()
        method.parameters = griffe.Parameters(*map(_parameter, taken))
        cls.docstring = griffe.Docstring(inspect.getdoc(found) or "", parent=cls)


class FrozenClasses(griffe.Extension):
    """Makes Griffe read a class of `arm_node.frozen` as a dataclass."""

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        """Put the decorator in its place that Griffe knows."""
        for each in cls.decorators:
            if str(each.value) == FROZEN:
                each.value = griffe.ExprName("dataclass", griffe.ExprName("dataclasses"))


def _parameter(taken: inspect.Parameter) -> griffe.Parameter:
    annotated = taken.annotation is not taken.empty
    return griffe.Parameter(
        taken.name,
        annotation=inspect.formatannotation(taken.annotation) if annotated else None,
        kind=griffe.ParameterKind[taken.kind.name.lower()],
        default=None if taken.default is taken.empty else repr(taken.default),
    )
