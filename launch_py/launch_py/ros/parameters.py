"""Node parameters of a launch file, and the parameter file that passes them to a node."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, get_args, get_origin

from launch_py.errors import NodeParameterError
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.typed_values import parse_boolean

MAX_DEPTH = 64
"""How deep lists and dicts may be nested."""
LONGEST_SHOWN = 100
LONGEST_SCALAR = 1000
"""A longer text than this, such as a robot description, is not read as YAML."""
UNPRINTABLE = re.compile("[\x7f-\x9f\ufffe\uffff]")
"""Characters that JSON does not escape and YAML does not allow unescaped."""

SAME_IN_YAML = re.compile(r"[A-Za-z/][\w/-]*(\.[A-Za-z]\w*)?|-?(0|[1-9]\d*)(\.\d+)?", re.ASCII)
"""Names, paths and plain numbers: all YAML readers agree on them, but for `WORDS`."""
WORD_LIST = "y n yes no on off true false null nan inf infinity"
WORDS = frozenset(WORD_LIST.split())
"""Words that a YAML reader may take for something else than a text."""
BOOLEANS = {"true": True, "True": True, "false": False, "False": False}
BARE = re.compile(r"[\w.+()-]+", re.ASCII)
"""Texts that rcl may read as something else if they have no quotes around them."""

NODE_KEY = "ros__parameters"
"""The key between a node's name and its parameters in a parameter file."""


class BareText(str):
    """A text that is written without quotes, so that rcl decides its type.

    In ROS a launch file writes the text of a substitution so: `1e3`, which is a text to PyYAML,
    becomes a double, and `y` a boolean.
    """

    __slots__ = ()


Value = bool | int | float | str | list[Any] | dict[str, Any]


class ParameterValue:
    """A parameter's value with its type.

    `value_type` is str, int, float, bool or a list of one of these. Without a type the text of a
    substitution is read as YAML, as in ROS: 'true' is a boolean, '1' an integer.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = value
        self.value_type = value_type

    def evaluate(self, context: LaunchScope) -> Value:
        """Return the value.

        Raises:
            NodeParameterError: the text cannot be read as the type.
        """
        if self.value_type is None:
            return evaluate_value(context, self.value)
        origin = get_origin(self.value_type)
        if origin is list:
            value = self.value
            text = perform_text(context, value) if isinstance(value, Substitution) else value
            items = load_value(text) if isinstance(text, str) else evaluate_value(context, value)
            if not isinstance(items, list):
                raise NodeParameterError(f"a list is needed, not {items!r}")
            item_type = get_args(self.value_type)[0]
            return [_convert(str(item), item_type) for item in items]
        return _convert(_text(context, self.value), self.value_type)


def evaluate_parameters(context: LaunchScope, parameters: Mapping[Any, Any]) -> dict[str, Value]:
    """Return a dict of parameters with all substitutions performed.

    Raises:
        NodeParameterError: a parameter cannot have a value of that type; the message names it.
    """
    evaluated: dict[str, Value] = {}
    for key, value in parameters.items():
        name = _text(context, key)
        try:
            evaluated[name] = evaluate_value(context, value)
        except NodeParameterError as error:
            raise NodeParameterError(f"parameter {name!r}: {error}") from None
    return evaluated


def evaluate_value(context: LaunchScope, value: Any) -> Value:
    """Return one value with its substitutions performed.

    Raises:
        NodeParameterError: a parameter cannot have a value of that type.
    """
    match value:
        case ParameterValue():
            return value.evaluate(context)
        case Substitution():
            return read_yaml(perform_text(context, value))
        case bool() | str():
            return value
        case int():
            return int(value)  # An enum member would be written as its name.
        case float():
            return float(value)  # A numpy.float64 would be written with its class name.
        case PathLike():
            return str(value.__fspath__())
        case Mapping() if value:
            return evaluate_parameters(context, value)
        case list() | tuple() if any(isinstance(item, Substitution) for item in value):
            return read_yaml(perform_text(context, value))
        case list() | tuple():
            return _one_type([evaluate_value(context, item) for item in value])
        case _ if hasattr(value, "tolist"):  # Any other numpy scalar, or an array.
            return evaluate_value(context, value.tolist())
    raise NodeParameterError(
        f"{value!r} of type {type(value).__name__} cannot be a parameter; it takes bool, int, "
        "float, str, a list of one of these, a dict or a substitution"
    )


def read_yaml(text: str) -> Value:
    """Return the value that the text of a substitution has, as in ROS.

    It is read as YAML; what is not a YAML scalar or list stays as it is. A text without quotes, or
    with needless ones, becomes a `BareText`.

    Raises:
        NodeParameterError: it begins like a list or a dict and is not YAML, or a list mixes types.
    """
    value = load_value(text)
    if isinstance(value, list):
        return [_bare(item) for item in _one_type(value)]
    return _bare(value)


def load_value(text: str) -> Any:
    """Return the value of a text as PyYAML reads it; see `read_yaml`."""
    word = text.strip()
    if word in BOOLEANS:
        return BOOLEANS[word]
    if _is_same_in_yaml(word):
        if word[0].isalpha() or word[0] == "/":
            return word
        return float(word) if "." in word else int(word)
    begins_collection = word[:1] in ("[", "{", "'", '"')
    if not begins_collection and ("\n" in word or len(word) > LONGEST_SCALAR):
        return text
    import yaml  # Imported late, because the import takes as long as starting a process.

    try:
        check_depth(word)
        if any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(word)):
            # A few lines of aliases can stand for more values than fit into memory.
            raise NodeParameterError(
                f"{_shortened(text)} has an alias (*), which a value cannot have"
            )
        value = yaml.safe_load(word)
    # PyYAML's constructors raise any of these, for an invalid date or `!!bool x`.
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, TypeError) as error:
        if not begins_collection:
            return text
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise NodeParameterError(f"{_shortened(text)} is not YAML: {reason}") from None
    if value is None:
        return ""
    return value if begins_collection or isinstance(value, bool | int | float | str) else text


def _is_same_in_yaml(word: str) -> bool:
    return bool(SAME_IN_YAML.fullmatch(word)) and word.lower() not in WORDS


def _bare(value: Any) -> Any:
    """Return a `BareText` for a text that ROS writes without quotes and that may not stay one."""
    if not isinstance(value, str) or _is_same_in_yaml(value) or not BARE.fullmatch(value):
        return value
    import yaml

    tag = yaml.SafeLoader("").resolve(yaml.ScalarNode, value, (True, False))
    return BareText(value) if tag == "tag:yaml.org,2002:str" else value


def check_depth(text: str) -> None:
    """Refuse YAML that is nested so deeply that reading it would exhaust the interpreter's stack.

    Raises:
        NodeParameterError: the text is nested too deeply.
        yaml.YAMLError: the text is not YAML.
    """
    import yaml

    depth = 0
    for event in yaml.parse(text):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > MAX_DEPTH:
            raise NodeParameterError(f"{_shortened(text)} is nested more than {MAX_DEPTH} deep")


def _shortened(text: str) -> str:
    return repr(text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}...")


def parameters_by_node(
    parameters: Mapping[Any, Any], node_name: str
) -> Mapping[str, Mapping[Any, Any]]:
    """Return parameters by node, of a dict for one node or in the form of a parameter file.

    `node_name` is the node of a dict that names none; "" stands for every node of the process.
    """
    if parameters and all(isinstance(v, Mapping) and NODE_KEY in v for v in parameters.values()):
        return {str(node): entry[NODE_KEY] for node, entry in parameters.items()}
    return {node_name: parameters}


def parameter_file_text(node_name: str, parameters: Mapping[str, Value]) -> str:
    """Return the text of a parameter file for one node, "/**" for every node of the process.

    The text is JSON, a subset of YAML that quotes strings, so 'yes' stays a string.
    """
    return f"{json.dumps(node_name)}: {dump_value({NODE_KEY: parameters})}\n"


def dump_value(value: Value | Mapping[str, Any]) -> str:
    """Return a value as YAML in one line, with quotes around texts."""
    match value:
        case Mapping():
            pairs = (f"{json.dumps(str(k))}: {dump_value(v)}" for k, v in value.items())
            return "{" + ", ".join(pairs) + "}"
        case list():
            return "[" + ", ".join(dump_value(item) for item in value) + "]"
        case bool():
            return "true" if value else "false"
        case float():
            return _dump_float(value)
        case BareText():
            return value
        case str():
            return UNPRINTABLE.sub(_escape, json.dumps(value, ensure_ascii=False))
    return str(value)


def _dump_float(value: float) -> str:
    if value != value:
        return ".nan"
    if value in (float("inf"), float("-inf")):
        return ".inf" if value > 0 else "-.inf"
    mantissa, exponent, power = repr(value).partition("e")
    # YAML requires the decimal point: 1e-07 would be a string.
    return f"{mantissa}.0e{power}" if exponent and "." not in mantissa else repr(value)


def _escape(match: re.Match[str]) -> str:
    return f"\\u{ord(match[0]):04x}"


def _one_type(items: list[Any]) -> list[Any]:
    if not items:
        raise NodeParameterError("an empty list has no type that a node could read; leave it out")
    types = {str if isinstance(item, str) else type(item) for item in items}
    if types == {int, float}:
        return [float(item) for item in items]
    if len(types) > 1 or types & {list, dict, type(None)}:
        raise NodeParameterError(
            f"{items!r} mixes types; a list parameter holds bool, int, float or str only"
        )
    return items


def _convert(text: str, value_type: Any) -> Value:
    if value_type is str:
        return text
    if value_type is bool:
        truth = parse_boolean(text)
        if truth is None:
            raise NodeParameterError(f"{text!r} is neither true nor false")
        return truth
    if value_type in (int, float):
        try:
            return value_type(text)
        except ValueError:
            kind = "an integer" if value_type is int else "a number"
            raise NodeParameterError(f"{text!r} is not {kind}") from None
    raise NodeParameterError(f"value_type {value_type!r} is not str, int, float, bool or list[...]")


def _text(context: LaunchScope, value: Any) -> str:
    if isinstance(value, str | PathLike | Substitution) or (
        isinstance(value, Iterable) and not isinstance(value, bytes | Mapping)
    ):
        items: Text = value
        return perform_text(context, items)
    if isinstance(value, bool | int | float):
        return str(value)
    raise NodeParameterError(f"a text is needed, not {describe_text(str(value))}")
