"""Parameters of a node, declared and checked one by one."""

import math
import os
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arm_gazebo.errors import SettingsError


class ParameterValues:
    """Declares parameters with forgiving types: an integer is a fine number.

    Every method declares the parameter `name` and returns its value; SettingsError names the
    parameter and what it takes.

    Args:
        node: gets the parameters.
        prefix: before every name, such as "left.".
    """

    def __init__(self, node: Node, prefix: str = "") -> None:
        self._node = node
        self._prefix = prefix

    def error(self, name: str, problem: str) -> SettingsError:
        """Return an error about a parameter that says which one it is."""
        return SettingsError(f"{self._prefix}{name} {problem}")

    def below(self, group: str) -> "ParameterValues":
        """Return the values of a group of parameters, GROUP.NAME."""
        return ParameterValues(self._node, f"{self._prefix}{group}.")

    def text(self, name: str, default: str, description: str) -> str:
        """Return a text."""
        value = self._declare(name, default, description)
        if not isinstance(value, str):
            raise self.error(name, f"must be a text, not {value!r}")
        return value

    def choice(self, name: str, default: str, choices: tuple[str, ...], description: str) -> str:
        """Return one of the choices."""
        value = self._declare(name, default, f"{description}: {', '.join(choices)}")
        if value not in choices:
            raise self.error(name, f"must be one of {', '.join(choices)}, not {value!r}")
        return value

    def flag(self, name: str, default: bool, description: str) -> bool:
        """Return true or false."""
        value = self._declare(name, default, description)
        if not isinstance(value, bool):
            raise self.error(name, f"must be true or false, not {value!r}")
        return value

    def whole(self, name: str, default: int, description: str) -> int:
        """Return a whole number."""
        value = self._declare(name, default, description)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.error(name, f"must be a whole number, not {value!r}")
        return value

    def number(self, name: str, default: float, description: str) -> float:
        """Return a finite number of at least 0."""
        value = self._declare(name, default, description)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(name, f"must be a number, not {value!r}")
        if not math.isfinite(value) or value < 0:
            raise self.error(name, f"must be finite and not negative, not {value!r}")
        return float(value)

    def numbers(self, name: str, description: str) -> list[float]:
        """Return finite numbers, none where nothing is given."""
        value = self._declare(name, None, description)
        if value is None or value == "" or value == []:
            return []
        try:
            numbers = [float(v) for v in value]
        except (TypeError, ValueError):
            numbers = [math.nan]
        if not all(map(math.isfinite, numbers)):
            raise self.error(name, f"must be a list of finite numbers, not {value!r}")
        return numbers

    def texts(self, name: str, description: str) -> list[str]:
        """Return texts: a list, or one text with commas or blanks."""
        value = self._declare(name, None, description)
        if value is None or value == "" or value == []:
            return []
        if isinstance(value, str):
            return value.replace(",", " ").split()
        if not all(isinstance(v, str) for v in value):
            raise self.error(name, f"must be a list of texts, not {value!r}")
        return list(value)

    def folders(self, name: str, description: str) -> tuple[Path, ...]:
        """Return folders: one text with colons."""
        return tuple(
            Path(folder).expanduser()
            for folder in self.text(name, "", f"folders {description}").split(os.pathsep)
            if folder
        )

    def _declare(self, name: str, default: object, description: str) -> Any:
        descriptor = ParameterDescriptor(
            description=description, read_only=True, dynamic_typing=True
        )
        return self._node.declare_parameter(f"{self._prefix}{name}", default, descriptor).value
