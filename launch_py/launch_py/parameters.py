"""Node parameters of a launch file, and the file in which a node gets them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from os import PathLike
from typing import TYPE_CHECKING, Any, get_args, get_origin

from launch_py.errors import ParameterError
from launch_py.substitution import Substitution, Text, describe_text, perform_text
from launch_py.truth import parse_truth

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

UNPRINTABLE = re.compile("[\x7f-\x9f\ufffe\uffff]")
"""What JSON writes as it is and YAML does not allow bare."""

YAML_WORDS = {
    spelling: value
    for words, value in {"true yes on": True, "false no off": False, "null ~": ""}.items()
    for word in words.split()
    for spelling in (word, word.capitalize(), word.upper())
}
"""Words that YAML does not read as text; for null, which no parameter can be, ROS takes ''."""

YAML_NO_NUMBERS = (".nan", ".inf", "+.inf", "-.inf")
"""How YAML writes the floats that have no digits; a bare nan or infinity is text."""

NODE_KEY = "ros__parameters"
"""What a parameter file has between the name of a node and its parameters."""

Value = bool | int | float | str | list[Any] | dict[str, Any]


class ParameterValue:
    """A parameter's value with its type.

    Without one, the text of a substitution is read as YAML, as in ROS: 'true' is a boolean, '1'
    an integer. `value_type` is str, int, float, bool or a list of one of these.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = value
        self.value_type = value_type

    def evaluate(self, context: LaunchContext) -> Value:
        """Return the value.

        Raises:
            ParameterError: the text cannot be read as the type.
        """
        if self.value_type is None:
            return evaluate_value(context, self.value)
        origin = get_origin(self.value_type)
        if origin is list:
            value = self.value
            items = read_yaml(value) if isinstance(value, str) else evaluate_value(context, value)
            if not isinstance(items, list):
                raise ParameterError(f"a list is needed, not {items!r}")
            item_type = get_args(self.value_type)[0]
            return [_convert(str(item), item_type) for item in items]
        return _convert(_text(context, self.value), self.value_type)


def evaluate_parameters(context: LaunchContext, parameters: Mapping[Any, Any]) -> dict[str, Value]:
    """Return a dict of parameters with all substitutions performed.

    Raises:
        ParameterError: a value is of no type that a parameter can have; the message names it.
    """
    evaluated: dict[str, Value] = {}
    for key, value in parameters.items():
        name = _text(context, key)
        try:
            evaluated[name] = evaluate_value(context, value)
        except ParameterError as error:
            raise ParameterError(f"parameter {name!r}: {error}") from None
    return evaluated


def evaluate_value(context: LaunchContext, value: Any) -> Value:
    """Return one value with its substitutions performed.

    Raises:
        ParameterError: it is of no type that a parameter can have.
    """
    match value:
        case ParameterValue():
            return value.evaluate(context)
        case Substitution():
            return read_yaml(perform_text(context, value))
        case bool() | str():
            return value
        case int():
            return int(value)  # An enumeration's would be written by its name.
        case float():
            return float(value)  # A numpy.float64 would be written with its class.
        case PathLike():
            return str(value.__fspath__())
        case Mapping() if value:
            return evaluate_parameters(context, value)
        case list() | tuple() if any(isinstance(item, Substitution) for item in value):
            return read_yaml(perform_text(context, value))
        case list() | tuple():
            return _one_type([evaluate_value(context, item) for item in value])
        case _ if hasattr(value, "tolist"):  # Another number of numpy, or an array.
            return evaluate_value(context, value.tolist())
    raise ParameterError(
        f"{value!r} of type {type(value).__name__} cannot be a parameter; it takes bool, int, "
        "float, str, a list of one of these, a dict or a substitution"
    )


def read_yaml(text: str) -> Value:
    """Return what a text means as a YAML value; a text that is no YAML scalar or list is itself."""
    word = text.strip()
    if word in YAML_WORDS:
        return YAML_WORDS[word]
    if word.lower() in YAML_NO_NUMBERS:
        return float(word.replace(".", ""))
    if any(map(str.isdigit, word)):
        for number in (int, lambda digits: int(digits, base=0), float):
            with suppress(ValueError):
                return number(word)
    if word[:1] not in ("[", "{", "'", '"'):
        return text
    import yaml  # Only here: importing it costs as much as starting a process.

    try:
        value = yaml.safe_load(word)
    except (yaml.YAMLError, ValueError) as error:  # A ValueError: no date, though written as one.
        raise ParameterError(f"{text!r} is not YAML: {str(error).splitlines()[0]}") from None
    return _one_type(value) if isinstance(value, list) else value


def parameters_by_node(
    parameters: Mapping[Any, Any], node_name: str
) -> Mapping[str, Mapping[Any, Any]]:
    """Return a dict's parameters by node.

    Args:
        parameters: of one node, or of several in the form of a parameter file.
        node_name: whose they are if the dict does not say; "" for every node of the process.
    """
    if parameters and all(isinstance(v, Mapping) and NODE_KEY in v for v in parameters.values()):
        return {str(node): entry[NODE_KEY] for node, entry in parameters.items()}
    return {node_name: parameters}


def parameter_file_text(node_name: str, parameters: Mapping[str, Value]) -> str:
    """Return the text of a parameter file for one node, "/**" for every node of the process.

    Written as JSON, which is YAML: strings are quoted, so 'yes' stays a string.
    """
    return f"{json.dumps(node_name)}: {_dump({NODE_KEY: parameters})}\n"


def _dump(value: Value | Mapping[str, Any]) -> str:
    match value:
        case Mapping():
            pairs = (f"{json.dumps(str(k))}: {_dump(v)}" for k, v in value.items())
            return "{" + ", ".join(pairs) + "}"
        case list():
            return "[" + ", ".join(_dump(item) for item in value) + "]"
        case bool():
            return "true" if value else "false"
        case float():
            return _dump_float(value)
        case str():
            return UNPRINTABLE.sub(_escape, json.dumps(value, ensure_ascii=False))
    return str(value)


def _dump_float(value: float) -> str:
    if value != value:
        return ".nan"
    if value in (float("inf"), float("-inf")):
        return ".inf" if value > 0 else "-.inf"
    mantissa, exponent, power = repr(value).partition("e")
    # YAML wants the point: 1e-07 would be a string.
    return f"{mantissa}.0e{power}" if exponent and "." not in mantissa else repr(value)


def _escape(match: re.Match[str]) -> str:
    return f"\\u{ord(match[0]):04x}"


def _one_type(items: list[Any]) -> list[Any]:
    if not items:
        raise ParameterError("an empty list has no type that a node could read; leave it out")
    types = {type(item) for item in items}
    if types == {int, float}:
        return [float(item) for item in items]
    if len(types) > 1 or types & {list, dict, type(None)}:
        raise ParameterError(
            f"{items!r} mixes types; a list parameter holds bool, int, float or str only"
        )
    return items


def _convert(text: str, value_type: Any) -> Value:
    if value_type is str:
        return text
    if value_type is bool:
        truth = parse_truth(text)
        if truth is None:
            raise ParameterError(f"{text!r} is neither true nor false")
        return truth
    if value_type in (int, float):
        try:
            return value_type(text)
        except ValueError:
            kind = "an integer" if value_type is int else "a number"
            raise ParameterError(f"{text!r} is not {kind}") from None
    raise ParameterError(f"value_type {value_type!r} is none of str, int, float, bool, list[...]")


def _text(context: LaunchContext, value: Any) -> str:
    if isinstance(value, str | PathLike | Substitution) or (
        isinstance(value, Iterable) and not isinstance(value, bytes | Mapping)
    ):
        items: Text = value
        return perform_text(context, items)
    if isinstance(value, bool | int | float):
        return str(value)
    raise ParameterError(f"a text is needed, not {describe_text(str(value))}")
