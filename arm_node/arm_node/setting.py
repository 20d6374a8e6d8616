"""One declaration of a setting: a field of a frozen dataclass.

The launch argument, the node's parameter, the keyword of the library and the manual's tables come
from it:

    @frozen(kw_only=True)
    class PhysicsSettings:
        hold_joints: bool = setting(True, "joints that no controller claims hold their position")

    settings = read_settings(PhysicsSettings, partial(declare_setting, node))

No ROS is imported here, because launch files read declarations before anything starts.
"""

import dataclasses
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, TypeVar

from arm_node.frozen import frozen
from arm_node.parameter_values import (
    ParameterValueError,
    Reader,
    one_of,
    read_flag,
    read_integer,
    read_number,
    read_parameter,
    read_text,
)

SettingsT = TypeVar("SettingsT")
_METADATA_KEY = "arm_node.setting"
_READERS: Mapping[type, Reader[Any]] = {
    bool: read_flag,
    int: read_integer,
    float: read_number,
    str: read_text,
}


@frozen
class Setting:
    """The declaration of one setting.

    Attributes:
        attribute: its name in the dataclass.
        name: its name as a parameter and as a launch argument.
        default: the parameter's default, which also has the parameter's type.
        read: checks and converts a parameter's value; raises ParameterValueError.
        about: what it is for, in one line, with its unit.
        changes: whether it may change while the node runs.
        choices: what a launch file accepts; empty for anything, which the node then checks.
        launches: whether launch files have it as an argument.
        adapt: makes the attribute's value of one that `read` returns.
    """

    attribute: str
    name: str
    default: Any
    read: Reader[Any]
    about: str
    changes: bool
    choices: tuple[str, ...]
    launches: bool
    adapt: Callable[[Any], Any]

    @property
    def launch_argument(self) -> dict[str, Any]:
        """What DeclareLaunchArgument takes beside the name."""
        return {
            "default_value": _word(self.default),
            "description": self.about,
            "choices": list(self.choices) or None,
        }


Parameters = Callable[[Setting], Any]
"""A source of values: a node that declares parameters, or `given_values`.

It returns the value of a setting's parameter, converted by `read`; ParameterValueError says that
`read` refuses it, and names the parameter.
"""


def setting(
    default: Any,
    about: str,
    read: Reader[Any] | None = None,
    *,
    unit: str = "",
    name: str = "",
    choices: tuple[str, ...] = (),
    changes: bool = False,
    launches: bool = True,
    adapt: Callable[[Any], Any] = lambda value: value,
) -> Any:
    """Declare a field of a frozen dataclass with keyword-only fields.

    Args:
        default: of the parameter; an empty tuple for texts, an empty `array("d")` for numbers. The
            field gets it as `read` and `adapt` convert it, or no default if `read` refuses it.
        about: what it is for, in one line.
        read: checks and converts a value; by default one of `choices`, or anything of the type of
            the default.
        unit: of the parameter's value; it is added to the first clause of `about`.
        name: of the parameter, if the field has another one, such as one with its unit.
        choices: the texts that it accepts; for a flag, those that a launch file accepts.
        changes: whether it may change while the node runs.
        launches: whether launch files have it as an argument.
        adapt: converts what `read` returns to what the field holds.
    """
    own = read or (one_of(choices) if isinstance(default, str) and choices else None)
    own = own or _READERS[type(default)]
    if unit:
        head, colon, rest = about.partition(";")
        about = f"{head}, in {unit}{colon}{rest}"
    declared = Setting("", name, default, own, about, changes, choices, launches, adapt)
    metadata = {_METADATA_KEY: declared}
    try:
        return dataclasses.field(default=adapt(own(default)), metadata=metadata)
    except ParameterValueError:
        return dataclasses.field(metadata=metadata)


@cache
def settings_of(cls: type[Any]) -> tuple[Setting, ...]:
    """Return the settings that a dataclass declares, in order."""
    return tuple(
        dataclasses.replace(declared, attribute=field.name, name=declared.name or field.name)
        for field in dataclasses.fields(cls)
        if isinstance(declared := field.metadata.get(_METADATA_KEY), Setting)
    )


def setting_of(cls: type[Any], attribute: str) -> Setting:
    """Return the setting that a field of a dataclass declares."""
    return next(each for each in settings_of(cls) if each.attribute == attribute)


def read_settings(
    cls: type[SettingsT], parameters: Parameters, prefix: str = "", **others: object
) -> SettingsT:
    """Return an instance with the values of parameters.

    `prefix` is what the parameters' names begin with, such as "left."; the others are values of the
    fields that no `setting` declares.

    Raises:
        ParameterValueError: a value is invalid; the message names it and the valid values.
    """
    values = {
        each.attribute: each.adapt(parameters(dataclasses.replace(each, name=prefix + each.name)))
        for each in settings_of(cls)
    }
    return cls(**values, **others)


def given_values(values: Mapping[str, object]) -> Parameters:
    """Return a program's own values by parameter name as a source; others have their defaults."""
    return lambda each: read_parameter(each.name, values.get(each.name, each.default), each.read)


def _word(default: object) -> str:
    """Return a default as a launch file writes it."""
    if isinstance(default, bool):
        return str(default).lower()
    return str(default) if isinstance(default, str | int | float) else ""
