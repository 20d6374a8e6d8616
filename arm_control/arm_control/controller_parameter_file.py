"""What a ROS parameter file says about one controller."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from arm_control.errors import ParameterError

_PARAMETERS = "ros__parameters"
_ANY = "/**"
_MANAGER = "controller_manager"


class ControllerParameterFile:
    """A parameter file in ros2_control's form."""

    def __init__(self, path: str) -> None:
        """Read the file.

        Raises:
            ParameterError: there is no such file, or it is no YAML mapping.
        """
        self.path = Path(path).absolute()
        try:
            content = yaml.safe_load(self.path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError) as error:
            raise ParameterError(f"cannot read parameter file '{self.path}': {error}") from error
        except yaml.YAMLError as error:
            first = " ".join(str(error).split())
            raise ParameterError(f"parameter file '{self.path}' is not YAML: {first}") from error
        if not isinstance(content, dict):
            raise ParameterError(f"parameter file '{self.path}' holds no nodes")
        self._content: dict[str, Any] = content

    def mentions(self, controller: str, namespace: str) -> bool:
        """Return whether the file holds parameters of a controller's own node.

        Raises:
            ParameterError: as `lookup`.
        """
        return any(True for _ in self._entries_of_controller(controller, namespace))

    def lookup(self, controller: str, namespace: str, parameter: str) -> Any:
        """Return a parameter of a controller, None where the file does not have it.

        It may stand under the controller's name, alone, with its namespace or with `/**`; under
        `/**`; and, as that is where the controller manager looks, among the manager's parameters.
        Of several places the one that names the controller most exactly counts.

        Args:
            controller: its name.
            namespace: of its node, with the leading slash.
            parameter: name of the parameter.

        Raises:
            ParameterError: an entry for the controller has no ros__parameters, or only one
                without its namespace where it has one.
        """
        for parameters in self._entries_of_controller(controller, namespace):
            if parameter in parameters:
                return parameters[parameter]
        for of_manager in self._entries(_MANAGER, namespace):
            entry = of_manager.get(controller)
            if isinstance(entry, Mapping) and parameter in entry:
                return entry[parameter]
        return None

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
                f"parameter file '{self.path}' has '{controller}' without its namespace: "
                f"write '{full_name}' or '{_ANY}/{controller}'"
            )
        return self._entries(controller, namespace)

    def _entries(self, node: str, namespace: str) -> Iterator[Mapping[str, Any]]:
        """Yield the parameters that concern a node, those that name it most exactly first."""
        yield from self._entries_by_name(node, namespace)
        every = self._content.get(_ANY)
        if isinstance(every, Mapping) and _PARAMETERS in every:
            yield self._parameters(every, _ANY)

    def _entries_by_name(self, node: str, namespace: str) -> Iterator[Mapping[str, Any]]:
        full_name = _full_name(node, namespace)
        bare = (node,) if namespace == "/" else ()
        every = self._content.get(_ANY)
        for place, where, keys in (
            (self._content, "", (full_name, *bare, f"{_ANY}{full_name}", f"{_ANY}/{node}")),
            (every if isinstance(every, Mapping) else {}, f"{_ANY}: ", (full_name, node)),
        ):
            for key in dict.fromkeys(keys):
                if key in place:
                    yield self._parameters(place[key], f"{where}{key}")

    def _parameters(self, entry: object, key: str) -> Mapping[str, Any]:
        parameters = entry.get(_PARAMETERS) if isinstance(entry, Mapping) else None
        if not isinstance(parameters, Mapping):
            raise ParameterError(
                f"parameter file '{self.path}': '{key}' has no mapping {_PARAMETERS}"
            )
        return parameters


def _full_name(node: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{node}"
