"""Files of controllers: what they say, and which controllers can run side by side from the start.

`${name}` in a file stands for the argument of that name of the robot's xacro, so one file serves a
robot under every prefix; so does `$(var name)`, which drivers' files have for ROS 2's launch.
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
Controllers = Path | Mapping[str, Any]
"""A file of controllers, or the content of one by node: no more keys above `ros__parameters`."""
ANYWHERE = "/**"
"""What a file has for the namespaces of a process, whichever they are."""

_ARGUMENT = re.compile(r"\$\{\s*(\w+)\s*\}|\$\(\s*var\s+(\w+)\s*\)")


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
    places = list(_ARGUMENT.finditer(text))
    if not places:
        return path
    unknown = next((place for place in places if _name(place) not in arguments), None)
    if unknown:
        raise SettingsError(
            f"{TITLE} {path} has {unknown[0]}, which is no argument of the "
            f"robot; it has {listing(sorted(arguments))}"
        )
    return _content(_ARGUMENT.sub(lambda place: arguments[_name(place)], text), path)


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
    for name, type_name in dict(_controllers(content)).items():
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

    Nodes that the file puts into a namespace itself stay there; "/**" is every one below this one,
    for the same process has the other robots' nodes.

    Args:
        namespace: without slashes around it.
        controllers: the file, or its content.

    Raises:
        SettingsError: the file cannot be read, or names no controllers.
    """
    return {_below(namespace, node): entry for node, entry in _read(controllers).items()}


def _below(namespace: str, node: str) -> str:
    if node.startswith(ANYWHERE):
        return f"/{namespace}{node}"
    return node if node.startswith("/") else f"/{namespace}/{node}"


def _read(controllers: Controllers) -> Mapping[str, Any]:
    if isinstance(controllers, Path):
        return _content(read_text(controllers, TITLE), controllers)
    return controllers


def _content(text: str, path: Path) -> Mapping[str, Any]:
    content = parse_yaml(text, path, TITLE)
    by_node: dict[str, dict[str, Any]] = {}
    for node, parameters in _nodes(content) if isinstance(content, Mapping) else ():
        by_node.setdefault(node, {PARAMETERS: {}})[PARAMETERS].update(parameters)
    if not list(_controllers(by_node)):
        raise SettingsError(
            f"{TITLE} {path} names no controllers; it needs "
            f"{MANAGER}: {PARAMETERS}: NAME: type: TYPE"
        )
    return by_node


def _nodes(content: Mapping[Any, Any], above: str = "") -> Iterator[tuple[str, Mapping[Any, Any]]]:
    """Yield nodes and their parameters: keys nest into a node's name, as rcl reads a file.

    A node of a namespace has its full name, another one its bare name.
    """
    for key, entry in content.items():
        if not isinstance(entry, Mapping):
            continue
        if key == PARAMETERS:
            yield (f"/{above}" if "/" in above and above[0] != "/" else above), entry
        else:
            yield from _nodes(entry, f"{above}/{key}" if above else str(key))


def _controllers(content: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield name and type of the manager's controllers."""
    for node, entry in content.items():
        for name, value in entry[PARAMETERS].items() if _ends(node, MANAGER) else ():
            if isinstance(value, Mapping) and "type" in value:
                yield str(name), str(value["type"])
            elif str(name).endswith(".type"):
                yield str(name).removesuffix(".type"), str(value)


def _joints(content: Mapping[str, Any], controller: str) -> list[str]:
    """Return the joints that a controller's parameters name; none for one that only reads."""
    for node, entry in content.items():
        if _ends(node, controller):
            parameters = entry[PARAMETERS]
            single = [parameters["joint"]] if "joint" in parameters else []
            joints = parameters.get("joints", single)
            return [str(joint) for joint in joints] if isinstance(joints, list) else []
    return []


def _ends(node: str, name: str) -> bool:
    return node.rpartition("/")[2] == name


def _name(place: re.Match[str]) -> str:
    return place[1] or place[2]
