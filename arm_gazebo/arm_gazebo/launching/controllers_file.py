"""Read controller parameter files, and find the controllers that can start together.

`${name}` in a file stands for the xacro argument of that name, so one file serves a robot under any
prefix. `$(var name)`, which drivers' files use for ROS 2's launch, means the same.
"""

import re
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

from arm_gazebo.errors import ControllerTypeError, SimSettingsError
from arm_gazebo.launching.settings_file import read_text
from arm_node.frozen import frozen
from arm_node.limited_yaml import YamlError
from arm_node.names import listing
from arm_node.parameter_file import PARAMETERS, parameters_by_node, read_parameters

MANAGER = "controller_manager"
TITLE = "the controllers' file"
Controllers = Path | Mapping[str, Any]
"""A controller parameter file, or its content by node name, flattened down to `ros__parameters`."""
ANYWHERE = "/**"
"""The wildcard for every namespace of a process."""

_ARGUMENT = re.compile(r"\$\{\s*(\w+)\s*\}|\$\(\s*var\s+(\w+)\s*\)")


@frozen
class StartableControllers:
    """The controllers to start, in the file's order.

    Attributes:
        names: the controllers whose joints no earlier controller claims.
        remarks: one sentence for each controller whose joints another one claims.
        missing: the types that the suite does not have, by controller.
    """

    names: tuple[str, ...]
    remarks: tuple[str, ...]
    missing: Mapping[str, str] = field(default_factory=dict)


def substitute_arguments(path: Path, arguments: Mapping[str, str]) -> Controllers:
    """Substitute the robot's xacro arguments in a file; return the path if it has none to fill.

    Raises:
        SimSettingsError: the file cannot be read, or names an unknown argument.
    """
    text = read_text(path, TITLE)
    placeholders = list(_ARGUMENT.finditer(text))
    if not placeholders:
        return path
    unknown = next((match for match in placeholders if _name(match) not in arguments), None)
    if unknown:
        raise SimSettingsError(
            f"{TITLE} {path} has {unknown[0]}, which is not an argument of the "
            f"robot, which model_args sets; it has {listing(sorted(arguments))}"
        )
    return _content(_ARGUMENT.sub(lambda match: arguments[_name(match)], text), path)


def startable_controllers(
    controllers: Controllers, known_types: frozenset[str]
) -> StartableControllers:
    """Return the controllers of a file that can be active together.

    Raises:
        SimSettingsError: the file cannot be read, or names no controllers.
        ControllerTypeError: the file misspells a type.
    """
    # Imported here, because it takes time that most launches of this project's robots can save.
    from arm_control.manager.type_names import is_misspelt, unknown_type

    content = read_controllers(controllers)
    names: list[str] = []
    missing: dict[str, str] = {}
    remarks: list[str] = []
    holders: dict[str, str] = {}
    for name, type_name in types_of(content).items():
        joints = _joints(content, name)
        held = next((joint for joint in joints if joint in holders), None)
        if type_name not in known_types:
            if is_misspelt(type_name, known_types):
                raise ControllerTypeError(f"{name}: {unknown_type(type_name, known_types)}")
            missing[name] = type_name
        elif held is not None:
            remarks.append(f"{name} does not start: {holders[held]} claims '{held}'")
        else:
            names.append(name)
            holders.update(dict.fromkeys(joints, name))
    return StartableControllers(tuple(names), tuple(remarks), missing)


def controllers_in_namespace(namespace: str, controllers: Controllers) -> Mapping[str, Any]:
    """Return the content of a controllers' file with its nodes in a namespace.

    Nodes that the file itself puts into a namespace stay there. "/**" is limited to this namespace,
    because the process also has the other robots' nodes. The namespace has no slash at either end.

    Raises:
        SimSettingsError: the file cannot be read, or names no controllers.
    """
    return {_below(namespace, node): entry for node, entry in read_controllers(controllers).items()}


def _below(namespace: str, node: str) -> str:
    if node.startswith(ANYWHERE):
        return f"/{namespace}{node}"
    return node if node.startswith("/") else f"/{namespace}/{node}"


def read_controllers(controllers: Controllers) -> Mapping[str, Any]:
    """Return the content of a controllers' file by node, flattened down to `ros__parameters`.

    Raises:
        SimSettingsError: the file cannot be read, or names no controllers.
    """
    if isinstance(controllers, Path):
        return _content(read_text(controllers, TITLE), controllers)
    return controllers


def _content(text: str, path: Path) -> Mapping[str, Any]:
    try:
        return checked_controllers(read_parameters(text), f"{TITLE} {path}")
    except YamlError as error:
        raise SimSettingsError(f"{TITLE} {path} is not YAML: {error}") from error


def checked_controllers(content: object, source: str) -> Mapping[str, Any]:
    """Return the parameters by node, flattened down to `ros__parameters`.

    Raises:
        SimSettingsError: it names no controllers.
    """
    every = parameters_by_node(content) if isinstance(content, Mapping) else {}
    by_node = {node: entry for node, entry in every.items() if PARAMETERS in entry}
    if not types_of(by_node):
        raise SimSettingsError(
            f"{source} names no controllers; it needs "
            f"{MANAGER}: {PARAMETERS}: NAME: type: TYPE, or NAME: {PARAMETERS}: type: TYPE"
        )
    return by_node


def types_of(content: Mapping[str, Any]) -> dict[str, str]:
    """Return the types of the controllers by name.

    A type is in the manager's parameters, or else in the controller's own, as the spawner accepts
    it with `-p`. There only a plugin name counts, because other nodes have a `type` as well.
    """
    types: dict[str, str] = {}
    for node, entry in content.items():
        for name, value in entry[PARAMETERS].items() if _ends(node, MANAGER) else ():
            if isinstance(value, Mapping) and "type" in value:
                types[str(name)] = str(value["type"])
    for node, entry in content.items():
        own_type = entry[PARAMETERS].get("type")
        if isinstance(own_type, str) and "/" in own_type and not _ends(node, MANAGER):
            types.setdefault(node.rpartition("/")[2], own_type)
    return types


def _joints(content: Mapping[str, Any], controller: str) -> list[str]:
    """Return the joints that a controller's parameters name; empty for a broadcaster."""
    for node, entry in content.items():
        if _ends(node, controller):
            parameters = entry[PARAMETERS]
            single = [parameters["joint"]] if "joint" in parameters else []
            joints = parameters.get("joints", single)
            return [str(joint) for joint in joints] if isinstance(joints, list) else []
    return []


def _ends(node: str, name: str) -> bool:
    return node.rpartition("/")[2] == name


def _name(match: re.Match[str]) -> str:
    return match[1] or match[2]
