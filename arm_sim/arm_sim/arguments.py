"""What a simulation is made of: a robot, its world, and the settings of both.

The settings of the physics are declared once, for the node and for programs alike; the arguments
add what only a program gives.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import KW_ONLY
from functools import wraps
from inspect import Parameter, signature
from os import fspath
from typing import Any, Concatenate, ParamSpec, TypeVar

from arm_gazebo.run.settings import PhysicsSettings
from arm_node.frozen import frozen
from arm_node.names import describe_known
from arm_node.setting import settings_of
from arm_sim.errors import ArgumentsError
from arm_sim.robots import AnyPath

P = ParamSpec("P")
SelfT = TypeVar("SelfT")
ArgumentsT = TypeVar("ArgumentsT")


@frozen
class SimulationArguments(PhysicsSettings):
    """The arguments of `Simulation`, which describes them, and the settings of the physics."""

    description: AnyPath = "arm"
    _: KW_ONLY
    world: AnyPath | None = None
    controllers: AnyPath | Mapping[str, Any] | None = None
    arguments: Mapping[str, object] | None = None
    spawn: Iterable[str] | None = None
    base: str = "fixed"
    pose: Iterable[float] | None = None
    package_path: Iterable[AnyPath] = ()
    record: AnyPath | None = None

    def parameters(self) -> dict[str, object]:
        """Return the values for the simulation's parameters; None for a default."""
        return {
            **{each.name: getattr(self, each.attribute) for each in settings_of(PhysicsSettings)},
            "world": None if self.world is None else fspath(self.world),
            "base": self.base,
            "pose": None if self.pose is None else [float(value) for value in self.pose],
        }


def takes(
    make: Callable[P, ArgumentsT],
) -> Callable[[Callable[[SelfT, ArgumentsT], None]], Callable[Concatenate[SelfT, P], None]]:
    """Let `__init__` take a dataclass's fields as its arguments, with their names and types."""

    def decorate(
        method: Callable[[SelfT, ArgumentsT], None],
    ) -> Callable[Concatenate[SelfT, P], None]:
        @wraps(method)
        def __init__(self: SelfT, *arguments: P.args, **keywords: P.kwargs) -> None:
            try:
                own = make(*arguments, **keywords)
            except TypeError as error:
                called = f"{make.__qualname__}.__init__"
                reason = str(error).replace(called, type(self).__name__)
                known = signature(make).parameters
                unknown = next((name for name in keywords if name not in known), None)
                if unknown is not None:
                    reason += f"; {describe_known(unknown, known, 'it takes')}"
                raise ArgumentsError(reason) from None
            method(self, own)

        of_self = Parameter("self", Parameter.POSITIONAL_ONLY)
        fields = signature(make).parameters.values()
        # Not the method's signature, which whoever unwraps it would show.
        del vars(__init__)["__wrapped__"]
        vars(__init__)["__signature__"] = signature(make).replace(parameters=[of_self, *fields])
        return __init__

    return decorate


def with_settings(cls: type[SelfT]) -> type[SelfT]:
    """Add the settings of the physics to the arguments at the end of a class's docstring."""
    lines = [f"        {each.attribute}: {each.about}." for each in settings_of(PhysicsSettings)]
    cls.__doc__ = "\n".join([(cls.__doc__ or "").rstrip(), *lines, "    "])
    return cls
