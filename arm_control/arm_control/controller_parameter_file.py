"""What a ROS parameter file says about one controller."""

from collections.abc import Mapping
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

    def lookup(self, controller: str, namespace: str, parameter: str) -> Any:
        """Return a parameter of a controller, None where the file does not have it.

        It may stand under the controller's name, alone, with its namespace or with `/**`; under
        `/**`; and, as that is where the controller manager looks, among the manager's parameters.

        Args:
            controller: its name.
            namespace: of its node, with the leading slash.
            parameter: name of the parameter.

        Raises:
            ParameterError: an entry for the controller has no ros__parameters, or only one
                without its namespace where it has one.
        """
        own = self._own_parameters(controller, namespace)
        if own is not None and parameter in own:
            return own[parameter]
        manager = self._content.get(_MANAGER, self._content.get(f"/{_MANAGER}"))
        of_manager = manager.get(_PARAMETERS) if isinstance(manager, Mapping) else None
        entry = of_manager.get(controller) if isinstance(of_manager, Mapping) else None
        return entry.get(parameter) if isinstance(entry, Mapping) else None

    def _own_parameters(self, controller: str, namespace: str) -> Mapping[str, Any] | None:
        full_name = f"{namespace.rstrip('/')}/{controller}"
        for key in (full_name, f"{_ANY}/{controller}"):
            if key in self._content:
                return self._parameters(self._content[key], key)
        if controller in self._content:
            if namespace != "/":
                raise ParameterError(
                    f"parameter file '{self.path}' has '{controller}' without its namespace: "
                    f"write '{full_name}' or '{_ANY}/{controller}'"
                )
            return self._parameters(self._content[controller], controller)
        if _ANY in self._content:
            every = self._content[_ANY]
            nested = every.get(controller) if isinstance(every, Mapping) else None
            if nested is not None:
                return self._parameters(nested, f"{_ANY}: {controller}")
            return self._parameters(every, _ANY)
        return None

    def _parameters(self, entry: object, key: str) -> Mapping[str, Any]:
        parameters = entry.get(_PARAMETERS) if isinstance(entry, Mapping) else None
        if not isinstance(parameters, Mapping):
            raise ParameterError(
                f"parameter file '{self.path}': '{key}' has no mapping {_PARAMETERS}"
            )
        return parameters
