"""Finds the parameters of one controller in the content of a ROS parameter file."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from arm_control.errors import ParameterError
from arm_node.limited_yaml import YamlError
from arm_node.parameter_file import (
    PARAMETERS,
    applies,
    given_parameters,
    parameters_by_node,
    read_parameters,
)
from arm_node.user_file import read_text

_ANY = "/**"
_MANAGER = "controller_manager"


class ParametersByNode:
    """Parameters in ros2_control's format, by the names of nodes.

    Attributes:
        source: what they are from, for messages.
    """

    def __init__(self, content: Mapping[str, Any], source: str) -> None:
        self.source = source
        self._content = parameters_by_node(content)

    def given(self, node: str, namespace: str) -> dict[str, Any]:
        """Return all parameters that apply to a node by their full names, with dots.

        The namespace has its leading slash.

        Raises:
            ParameterError: an entry for the node has no ros__parameters.
        """
        list(self._entries(node, namespace))  # Each of them must have parameters.
        return given_parameters(self._content, _full_name(node, namespace))

    def mentions(self, controller: str, namespace: str) -> bool:
        """Return whether the file has parameters of a controller's own node.

        Raises:
            ParameterError: see `lookup`.
        """
        return any(True for _ in self._entries_of_controller(controller, namespace))

    def lookup(self, controller: str, namespace: str, parameter: str) -> Any:
        """Return a parameter of a controller, None if the file does not have it.

        It may be under the controller's name, alone or with its namespace or `/**`; under `/**`; or
        among the manager's parameters, where the controller manager looks. The most specific entry
        wins. The namespace has its leading slash.

        Raises:
            ParameterError: an entry for the controller has no ros__parameters, or lacks the
                controller's namespace.
        """
        for parameters in self._entries_of_controller(controller, namespace):
            if parameter in parameters:
                return parameters[parameter]
        for of_manager in self._entries(_MANAGER, namespace):
            entry = of_manager.get(controller)
            if isinstance(entry, Mapping) and parameter in entry:
                return entry[parameter]
        return None

    def own_type(self, controller: str, namespace: str) -> tuple[str, ...]:
        """Return the type in the controller's own entry, if any."""
        entries = self._entries_by_name(controller, namespace)
        value = next((entry["type"] for entry in entries if "type" in entry), None)
        return (value,) if isinstance(value, str) else ()

    def _entries_of_controller(
        self, controller: str, namespace: str
    ) -> Iterator[Mapping[str, Any]]:
        full_name = _full_name(controller, namespace)
        if (
            namespace != "/"
            and controller in self._content
            and not any(True for _ in self._entries_by_name(controller, namespace))
        ):
            raise ParameterError(
                f"{self.source} names '{controller}' without its namespace: "
                f"write '{full_name}' or '{_ANY}/{controller}'"
            )
        return self._entries(controller, namespace)

    def _entries(self, node: str, namespace: str) -> Iterator[Mapping[str, Any]]:
        """Yield the parameters that apply to a node, the most specific ones first."""
        yield from self._entries_by_name(node, namespace)
        if PARAMETERS in self._content.get(_ANY, {}):
            yield self._content[_ANY][PARAMETERS]

    def _entries_by_name(self, node: str, namespace: str) -> Iterator[Mapping[str, Any]]:
        full_name = _full_name(node, namespace)
        found = [
            key
            for key in self._content
            if key.rpartition("/")[2] == node and applies(key, full_name)
        ]
        for key in sorted(found, key=lambda key: (key.count("*"), len(found) - len(key))):
            if PARAMETERS not in self._content[key]:
                raise ParameterError(f"{self.source}: '{key}' has no mapping {PARAMETERS}")
            yield self._content[key][PARAMETERS]


class ControllerParameterFile(ParametersByNode):
    """A parameter file in ros2_control's format.

    Attributes:
        path: its absolute path.
    """

    def __init__(self, path: str) -> None:
        """Read the file.

        Raises:
            ParameterError: the file does not exist, or is not a YAML mapping.
        """
        self.path = Path(path).absolute()
        source = f"parameter file '{self.path}'"
        try:
            content = read_parameters(read_text(self.path))
        except YamlError as error:
            raise ParameterError(f"{source} is not YAML: {error}") from error
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            raise ParameterError(f"cannot read {source}: {reason}") from error
        if not content:
            raise ParameterError(f"{source} contains no nodes")
        super().__init__(content, source)


def manager_parameters(
    controller: str, namespace: str, files: Sequence[ControllerParameterFile]
) -> dict[str, str | list[str]]:
    """Return the parameters that a manager needs before it loads a controller of these files.

    The first file that has a value counts.

    Raises:
        ParameterError: see `ParametersByNode.lookup`, or a value has a wrong type.
    """

    def found(parameter: str) -> Any:
        values = (file.lookup(controller, namespace, parameter) for file in files)
        return next((value for value in values if value is not None), None)

    parameters: dict[str, str | list[str]] = {}
    if paths := [str(file.path) for file in files if file.mentions(controller, namespace)]:
        parameters[f"{controller}.params_file"] = paths
    type_name = found("type")
    if type_name is not None:
        if not isinstance(type_name, str):
            raise ParameterError(f"the type of controller '{controller}' is {type_name!r}")
        parameters[f"{controller}.type"] = type_name
    if fallbacks := found("fallback_controllers"):
        if not isinstance(fallbacks, list) or not all(isinstance(f, str) for f in fallbacks):
            raise ParameterError(
                f"fallback_controllers of controller '{controller}' must be a list of names, "
                f"not {fallbacks!r}"
            )
        parameters[f"{controller}.fallback_controllers"] = fallbacks
    return parameters


def _full_name(node: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{node}"
