"""Parameters of controllers: a frozen dataclass declares names, types, defaults and rules.

A controller names its dataclass in `Controller.parameters_type`. The ROS half declares the fields
on the controller's node; a program without ROS creates an instance directly. A field that is itself
a dataclass becomes a group: 'map_interface_to_joint_state.position'.
"""

import dataclasses
import math
import operator
from collections.abc import Iterable, Mapping
from dataclasses import MISSING
from functools import cache
from types import MappingProxyType
from typing import Any, TypeGuard, get_args, get_origin, get_type_hints

from arm_control.errors import ParameterError
from arm_node.frozen import frozen

NEAREST, MANY = 5, 15
"""How many known parameters a message names, if there are more than the second."""

_METADATA_KEY = "arm_control.parameter"
_GROUPS_KEY = "arm_control.parameter_groups"
_SCALARS = (bool, int, float, str)


@frozen
class ParameterSpec:
    """One parameter.

    Attributes:
        name: full name, with dots.
        type: bool, int, float or str; of each element if `is_list`.
        is_list: whether it is a list of that type.
        default: value used when none is given.
        description: text for `ros2 param describe`.
        read_only: whether it is fixed once the controller is loaded.
        above: exclusive lower bound; None for no bound.
        at_least: inclusive lower bound, which also refuses infinity; None for no bound.
        at_most: inclusive upper bound; None for no bound.
        one_of: the allowed values; empty allows any.
        at_configuration: whether the controller reads it only when it is configured: a later change
            takes effect at the next configuration.
    """

    name: str
    type: type
    is_list: bool
    default: Any
    description: str = ""
    read_only: bool = False
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    one_of: tuple[str, ...] = ()
    at_configuration: bool = False

    @property
    def constraint(self) -> str:
        """The rule for its value, in words, such as 'above 0'; empty if there is no rule."""
        if self.one_of:
            return f"one of {', '.join(self.one_of)}"
        bounds = (("above", self.above), ("at least", self.at_least), ("at most", self.at_most))
        return " and ".join(f"{word} {bound:g}" for word, bound in bounds if bound is not None)

    @property
    def range(self) -> tuple[float, float] | None:
        """The smallest and largest allowed number; None if there is no bound."""
        if self.is_list or (self.above, self.at_least, self.at_most) == (None, None, None):
            return None
        least = self.at_least
        if self.above is not None:
            least = self.above + 1 if self.type is int else self.above
        return (
            -math.inf if least is None else least,
            math.inf if self.at_most is None else self.at_most,
        )

    def convert(self, value: object) -> Any:
        """Return the value in the parameter's type; an integer is accepted for a float.

        Raises:
            ParameterError: the value has another type or breaks a rule.
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
            is_bare = self.type is str and isinstance(value, int | float)
            hint = "; a text that looks like a number needs quotes in YAML" if is_bare else ""
            raise ParameterError(
                f"parameter '{name}' must be of type {self.type.__name__}, not {value!r}{hint}"
            )
        # Not `value <= above`: a comparison with NaN is false, so NaN would pass.
        too_low = self.above is not None and not value > self.above
        too_low |= self.at_least is not None and not self.at_least <= value < math.inf
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
    at_least: float | None = None,
    at_most: float | None = None,
    one_of: tuple[str, ...] = (),
    at_configuration: bool = False,
) -> Any:
    """Describe a field of a parameters dataclass.

    Args:
        default: value used when none is given; an empty tuple for a list.
        description: one line for `ros2 param describe`.
        read_only: whether it is fixed once the controller is loaded.
        above: exclusive lower bound of the value, or of each element.
        at_least: inclusive lower bound of the value, or of each element; infinity is refused.
        at_most: inclusive upper bound of the value, or of each element.
        one_of: the allowed values.
        at_configuration: whether a change takes effect at the controller's next configuration.
    """
    rules = {
        "description": description,
        "read_only": read_only,
        "above": above,
        "at_least": at_least,
        "at_most": at_most,
        "one_of": one_of,
        "at_configuration": at_configuration,
    }
    return dataclasses.field(default=default, metadata={_METADATA_KEY: rules})


@frozen
class _Groups:
    """What `parameter_groups` says about a field."""

    kind: type[Any]
    by: str
    prefix: str
    only: str
    single: bool

    def names(self, values: Mapping[str, Any]) -> tuple[Any, ...]:
        if not self.single:
            return list_among(values, self.by)
        return tuple(filter(None, (values.get(self.by),)))

    def take(self, values: dict[str, Any]) -> Any:
        """Remove the groups' values from those by full name; return what the field holds."""
        groups = {
            name: take_group(self.kind, f"{self.prefix}.{name}.", values)
            for name in self.names(values)
        }
        if self.single:
            return next(iter(groups.values()), self.kind())
        return {name: getattr(g, self.only) if self.only else g for name, g in groups.items()}


def parameter_groups(
    kind: type[Any], by: str, *, prefix: str = "gains", only: str = "", single: bool = False
) -> Any:
    """Describe a field with a group of parameters for each name that another parameter has.

    `gains: Mapping[str, Gains] = parameter_groups(Gains, by="joints")` stands for 'gains.j0.p' and
    so on if 'j0' is among the joints.

    Args:
        kind: the dataclass of each group.
        by: the parameter that has the names.
        prefix: what precedes them in the parameters' names.
        only: the one parameter of each group whose value stands for the group.
        single: whether `by` is one name, and the field the group itself.
    """
    groups = _Groups(kind, by, prefix, only, single)
    return dataclasses.field(
        default_factory=kind if single else dict, metadata={_GROUPS_KEY: groups}
    )


def specs_of(
    parameters_type: type[Any], prefix: str = "", given: Mapping[str, Any] = MappingProxyType({})
) -> tuple[ParameterSpec, ...]:
    """Return the parameters that a dataclass describes, including those of its groups.

    `given` has values by full name, from which `parameter_groups` take the names of their groups.
    """
    groups = _groups_of(parameters_type).values()
    named = dict.fromkeys((name, g.by) for g in groups for name in g.names(given))
    return _fixed_specs(parameters_type, prefix) + tuple(
        spec
        for name, by in named
        for group in groups
        if group.by == by
        for spec in _fixed_specs(group.kind, f"{prefix}{group.prefix}.{name}.")
    )


@cache
def _groups_of(parameters_type: type[Any]) -> Mapping[str, _Groups]:
    fields = dataclasses.fields(parameters_type)
    return {f.name: f.metadata[_GROUPS_KEY] for f in fields if _GROUPS_KEY in f.metadata}


@cache  # Reading a dataclass is slow, and a node asks at every change.
def _fixed_specs(parameters_type: type[Any], prefix: str = "") -> tuple[ParameterSpec, ...]:
    specs: list[ParameterSpec] = []
    hints = get_type_hints(parameters_type)
    for field in dataclasses.fields(parameters_type):
        if _GROUPS_KEY in field.metadata:
            continue
        hint = hints[field.name]
        name = prefix + field.name
        if dataclasses.is_dataclass(hint) and isinstance(hint, type):
            specs.extend(_fixed_specs(hint, f"{name}."))
            continue
        rules = field.metadata.get(_METADATA_KEY, {})
        is_list = get_origin(hint) is tuple
        element = get_args(hint)[0] if is_list else hint
        if element not in _SCALARS or field.default is MISSING:
            raise ParameterError(
                f"field '{field.name}' of {parameters_type.__name__} needs a default and one of "
                "the types bool, int, float, str, or a tuple[..., ...] of one of them"
            )
        specs.append(ParameterSpec(name, element, is_list, field.default, **rules))
    return tuple(specs)


def list_among(values: Mapping[str, Any], name: str) -> tuple[Any, ...]:
    """Return a list from unchecked values; the names of other parameters depend on it.

    A value that is not a list counts as empty here; the converter reports it.
    """
    value = values.get(name)
    return tuple(value) if _is_list(value) else ()


def _is_list(value: object) -> TypeGuard[Iterable[object]]:
    return isinstance(value, Iterable) and not isinstance(value, str)


def build_parameters(parameters_type: type[Any], values: Mapping[str, object]) -> Any:
    """Make an instance of a parameters dataclass, and call its `check_together` if it has one.

    The values are by full name; missing ones take their defaults.

    Raises:
        ParameterError: a name is unknown, or a value has the wrong type.
    """
    rest = dict(values)
    groups = {name: each.take(rest) for name, each in _groups_of(parameters_type).items()}
    specs = _fixed_specs(parameters_type)
    known = [spec.name for spec in specs]
    unknown = sorted(set(rest) - set(known))
    if unknown:
        raise ParameterError(
            f"unknown parameter {', '.join(unknown)}; {known_parameters(unknown[0], known)}"
        )
    converted = {spec.name: spec.convert(rest[spec.name]) for spec in specs if spec.name in rest}
    parameters = _build(parameters_type, {**converted, **groups}, "")
    if hasattr(parameters, "check_together"):
        parameters.check_together()
    return parameters


def known_parameters(unknown: str, known: Iterable[str]) -> str:
    """Return the second half of a message about an unknown parameter: those that are known.

    Of many it gives the `NEAREST`, which resemble it as a whole or in one part.
    """
    names = list(known)
    if len(names) <= MANY:
        return f"known: {', '.join(names) or 'none'}"
    # Imported here, because most names are known.
    from difflib import SequenceMatcher

    matcher = SequenceMatcher(b=unknown)

    def likeness(name: str) -> float:
        ratios: list[float] = []
        for part in {name, *name.split(".")}:
            matcher.set_seq1(part)
            ratios.append(matcher.ratio())
        return max(ratios)

    nearest = ", ".join(sorted(names, key=likeness, reverse=True)[:NEAREST])
    return f"the nearest of {len(names)} are {nearest}; arm param list shows all"


def take_group(parameters_type: type[Any], prefix: str, values: dict[str, Any]) -> Any:
    """Remove the values below a prefix, such as 'gains.j0.', and return them as a group.

    Raises:
        ParameterError: a name is unknown, or a value has the wrong type; the message names the
            group.
    """
    names = [name for name in values if name.startswith(prefix)]
    own = {name.removeprefix(prefix): values.pop(name) for name in names}
    try:
        return build_parameters(parameters_type, own)
    except ParameterError as error:
        raise ParameterError(f"under '{prefix[:-1]}': {error}") from error


def check_values(parameters: object, specs: Iterable[ParameterSpec], prefix: str = "") -> None:
    """Check the values of an instance that was made without `build_parameters`.

    `prefix` is that of the names in `specs`, which the attributes lack.

    Raises:
        ParameterError: a value breaks the rules of its parameter.
    """
    for spec in specs:
        spec.convert(operator.attrgetter(spec.name.removeprefix(prefix))(parameters))


def _build(parameters_type: type[Any], values: Mapping[str, Any], prefix: str) -> Any:
    hints = get_type_hints(parameters_type)
    arguments: dict[str, Any] = {}
    for field in dataclasses.fields(parameters_type):
        hint = hints[field.name]
        name = prefix + field.name
        if name in values:
            arguments[field.name] = values[name]
        elif dataclasses.is_dataclass(hint) and isinstance(hint, type):
            arguments[field.name] = _build(hint, values, f"{name}.")
    return parameters_type(**arguments)
