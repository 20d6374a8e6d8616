"""Parameters of controllers: a frozen dataclass says names, types, defaults and rules.

A controller names its dataclass in `Controller.parameters_type`; the ROS half declares the fields
on the controller's node, a program without ROS makes an instance itself. A field that is a
dataclass groups its fields under its name: 'map_interface_to_joint_state.position'.
"""

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass
from typing import Any, TypeGuard, get_args, get_origin, get_type_hints

from arm_control.errors import ParameterError

_METADATA_KEY = "arm_control.parameter"
_SCALARS = (bool, int, float, str)


@dataclass(frozen=True, slots=True)
class _Rules:
    description: str
    read_only: bool
    above: float | None = None
    at_most: float | None = None
    one_of: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """One parameter.

    Attributes:
        name: full name, with dots.
        type: bool, int, float or str; of each element where `is_list`.
        is_list: whether it is a list of that type.
        default: its value where none is given.
        description: for `ros2 param describe`.
        read_only: whether it is fixed once the controller is loaded.
        above: what its value must exceed; None for no such bound.
        at_most: what its value must not exceed; None for no such bound.
        one_of: what its value must be; empty for anything.
    """

    name: str
    type: type
    is_list: bool
    default: Any
    description: str
    read_only: bool
    above: float | None = None
    at_most: float | None = None
    one_of: tuple[str, ...] = ()

    @property
    def constraint(self) -> str:
        """What its value must be beyond its type, in words; empty for anything."""
        if self.one_of:
            return f"one of {', '.join(self.one_of)}"
        lower = [] if self.above is None else [f"above {self.above:g}"]
        upper = [] if self.at_most is None else [f"at most {self.at_most:g}"]
        return " and ".join(lower + upper)

    def convert(self, value: object) -> Any:
        """Return the value in the parameter's own type; an integer serves as a float.

        Raises:
            ParameterError: it does not fit.
        """
        if not self.is_list:
            return self._convert_scalar(value, self.name)
        if not _is_list(value):
            raise ParameterError(f"parameter '{self.name}' must be a list, not {value!r}")
        return tuple(
            self._convert_scalar(item, f"{self.name}[{i}]") for i, item in enumerate(value)
        )

    def _convert_scalar(self, value: Any, name: str) -> Any:
        if self.type is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if type(value) is not self.type:
            raise ParameterError(
                f"parameter '{name}' must be of type {self.type.__name__}, not {value!r}"
            )
        # Not `value <= above`: a NaN is above nothing.
        too_low = self.above is not None and not value > self.above
        too_high = self.at_most is not None and not value <= self.at_most
        if too_low or too_high or (self.one_of and value not in self.one_of):
            raise ParameterError(f"parameter '{name}' must be {self.constraint}, but is {value!r}")
        return value


def parameter(
    default: Any,
    description: str,
    *,
    read_only: bool = False,
    above: float | None = None,
    at_most: float | None = None,
    one_of: tuple[str, ...] = (),
) -> Any:
    """Describe a field of a parameters dataclass.

    Args:
        default: its value where none is given; an empty tuple for a list.
        description: one line for `ros2 param describe`.
        read_only: whether it is fixed once the controller is loaded.
        above: what its value, or each element, must exceed.
        at_most: what its value, or each element, must not exceed.
        one_of: what its value, or each element, must be.
    """
    return dataclasses.field(
        default=default,
        metadata={_METADATA_KEY: _Rules(description, read_only, above, at_most, one_of)},
    )


def specs_of(parameters_type: type[Any], prefix: str = "") -> tuple[ParameterSpec, ...]:
    """Return the parameters that a dataclass describes, those of its groups included."""
    specs: list[ParameterSpec] = []
    hints = get_type_hints(parameters_type)
    for field in dataclasses.fields(parameters_type):
        hint = hints[field.name]
        name = prefix + field.name
        if dataclasses.is_dataclass(hint) and isinstance(hint, type):
            specs.extend(specs_of(hint, f"{name}."))
            continue
        rules = field.metadata.get(_METADATA_KEY, _Rules("", read_only=False))
        is_list = get_origin(hint) is tuple
        element = get_args(hint)[0] if is_list else hint
        if element not in _SCALARS or field.default is MISSING:
            raise ParameterError(
                f"field '{field.name}' of {parameters_type.__name__} needs a default and one of "
                "the types bool, int, float, str, or a tuple[..., ...] of one of them"
            )
        specs.append(
            ParameterSpec(
                name,
                element,
                is_list,
                field.default,
                rules.description,
                rules.read_only,
                rules.above,
                rules.at_most,
                rules.one_of,
            )
        )
    return tuple(specs)


def list_among(values: Mapping[str, Any], name: str) -> tuple[Any, ...]:
    """Return a list among values that nobody has checked yet, for names that depend on it.

    What is no list counts as empty: that it is wrong is said where it is converted.
    """
    value = values.get(name)
    return tuple(value) if _is_list(value) else ()


def _is_list(value: object) -> TypeGuard[Iterable[object]]:
    return isinstance(value, Iterable) and not isinstance(value, str)


def build_parameters(parameters_type: type[Any], values: Mapping[str, object]) -> Any:
    """Make an instance of a parameters dataclass.

    Args:
        parameters_type: the dataclass.
        values: by full name; what is missing takes its default.

    Raises:
        ParameterError: a name is unknown, or a value has the wrong type.
    """
    specs = specs_of(parameters_type)
    known = [spec.name for spec in specs]
    unknown = sorted(set(values) - set(known))
    if unknown:
        raise ParameterError(
            f"unknown parameter {', '.join(unknown)}; there is {', '.join(known) or 'none'}"
        )
    converted = {
        spec.name: spec.convert(values[spec.name]) for spec in specs if spec.name in values
    }
    return _build(parameters_type, converted, "")


def _build(parameters_type: type[Any], values: Mapping[str, Any], prefix: str) -> Any:
    hints = get_type_hints(parameters_type)
    arguments: dict[str, Any] = {}
    for field in dataclasses.fields(parameters_type):
        hint = hints[field.name]
        name = prefix + field.name
        if dataclasses.is_dataclass(hint) and isinstance(hint, type):
            arguments[field.name] = _build(hint, values, f"{name}.")
        elif name in values:
            arguments[field.name] = values[name]
    return parameters_type(**arguments)
