"""Files of controllers: what they say, and which controllers can run side by side from the start.

`${name}` in a file stands for the argument of that name of the robot's xacro, so one file serves a
robot under every prefix.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arm_description.names import listing
from arm_gazebo.errors import SettingsError
from arm_gazebo.launching.settings_file import parse_yaml, read_text

MANAGER = "controller_manager"
PARAMETERS = "ros__parameters"
TITLE = "the controllers' file"
Controllers = Path | Mapping[Any, Any]
"""A file of controllers, or the content of one."""

_ARGUMENT = re.compile(r"\$\{\s*(\w+)\s*\}")


@dataclass(frozen=True, slots=True)
class Startable:
    """The controllers to start, in the file's order, and why others wait.

    Attributes:
        names: those whose joints nobody before them holds.
        remarks: one sentence for each that waits.
    """

    names: tuple[str, ...]
    remarks: tuple[str, ...]


def fill_in(path: Path, arguments: Mapping[str, str]) -> Controllers:
    """Return a file as it is, or its content with the robot's arguments in their places.

    Args:
        path: a parameter file in ros2_control's form.
        arguments: values by name.

    Raises:
        SettingsError: the file cannot be read, or has a place for an argument that is not there.
    """
    text = read_text(path, TITLE)
    if not _ARGUMENT.search(text):
        return path
    unknown = [name for name in _ARGUMENT.findall(text) if name not in arguments]
    if unknown:
        raise SettingsError(
            f"{TITLE} {path} has ${{{unknown[0]}}}, which is no argument of the "
            f"robot; it has {listing(sorted(arguments))}"
        )
    return _content(_ARGUMENT.sub(lambda place: arguments[place[1]], text), path)


def startable_controllers(controllers: Controllers, known_types: frozenset[str]) -> Startable:
    """Return the controllers of a file that can be active together.

    Args:
        controllers: a parameter file in ros2_control's form, or the content of one.
        known_types: types that can be loaded.

    Raises:
        SettingsError: the file cannot be read, or names no controllers.
    """
    content = _read(controllers)
    names: list[str] = []
    remarks: list[str] = []
    holders: dict[str, str] = {}
    for name, type_name in _controllers(content):
        joints = _joints(content, name)
        held = next((joint for joint in joints if joint in holders), None)
        if type_name not in known_types:
            remarks.append(f"{name} does not start: its type {type_name} is not known here")
        elif held is not None:
            remarks.append(f"{name} does not start: {holders[held]} holds '{held}'")
        else:
            names.append(name)
            holders.update(dict.fromkeys(joints, name))
    return Startable(tuple(names), tuple(remarks))


def controllers_below(namespace: str, controllers: Controllers) -> Mapping[str, Any]:
    """Return the content of a controllers' file with its nodes in a namespace.

    Nodes that the file puts somewhere itself, by a slash in front, stay there.

    Args:
        namespace: without slashes around it.
        controllers: the file, or its content.

    Raises:
        SettingsError: the file cannot be read, or names no controllers.
    """
    content = _read(controllers)
    return {
        str(node) if str(node).startswith("/") else f"/{namespace}/{node}": entry
        for node, entry in content.items()
    }


def _read(controllers: Controllers) -> Mapping[Any, Any]:
    if isinstance(controllers, Path):
        return _content(read_text(controllers, TITLE), controllers)
    return controllers


def _content(text: str, path: Path) -> Mapping[Any, Any]:
    content = parse_yaml(text, path, TITLE)
    if not isinstance(content, Mapping) or not list(_controllers(content)):
        raise SettingsError(
            f"{TITLE} {path} names no controllers; it needs "
            f"{MANAGER}: {PARAMETERS}: NAME: type: TYPE"
        )
    return content


def _controllers(content: Mapping[Any, Any]) -> Iterator[tuple[str, str]]:
    """Yield name and type of the manager's controllers."""
    for key, entry in content.items():
        if str(key).rpartition("/")[2] != MANAGER or not isinstance(entry, Mapping):
            continue
        parameters = entry.get(PARAMETERS)
        for name, value in parameters.items() if isinstance(parameters, Mapping) else ():
            if isinstance(value, Mapping) and "type" in value:
                yield str(name), str(value["type"])
            elif str(name).endswith(".type"):
                yield str(name).removesuffix(".type"), str(value)


def _joints(content: Mapping[Any, Any], controller: str) -> list[str]:
    """Return the joints that a controller's parameters name; none for one that only reads."""
    for key, entry in content.items():
        if str(key).rpartition("/")[2] == controller and isinstance(entry, Mapping):
            parameters = entry.get(PARAMETERS)
            parameters = parameters if isinstance(parameters, Mapping) else {}
            single = [parameters["joint"]] if "joint" in parameters else []
            joints = parameters.get("joints", single)
            return [str(joint) for joint in joints] if isinstance(joints, list) else []
    return []
