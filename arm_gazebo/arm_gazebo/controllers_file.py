"""Which controllers of a parameter file can run side by side from the start."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arm_gazebo.errors import SettingsError

MANAGER = "controller_manager"
PARAMETERS = "ros__parameters"


@dataclass(frozen=True, slots=True)
class Startable:
    """The controllers to start, in the file's order, and why others wait.

    Attributes:
        names: those whose joints nobody before them holds.
        remarks: one sentence for each that waits.
    """

    names: tuple[str, ...]
    remarks: tuple[str, ...]


def startable_controllers(path: Path | str, known_types: frozenset[str]) -> Startable:
    """Return the controllers of a file that can be active together.

    Args:
        path: a parameter file in ros2_control's form.
        known_types: types that can be loaded.

    Raises:
        SettingsError: the file cannot be read, or names no controllers.
    """
    content = _read(path)
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


def controllers_below(namespace: str, controllers: Path | Mapping[Any, Any]) -> Mapping[str, Any]:
    """Return the content of a controllers' file with its nodes in a namespace.

    Nodes that the file puts somewhere itself, by a slash in front, stay there.

    Args:
        namespace: without slashes around it.
        controllers: the file, or its content.

    Raises:
        SettingsError: the file cannot be read, or names no controllers.
    """
    content = _read(controllers) if isinstance(controllers, Path) else controllers
    return {
        str(node) if str(node).startswith("/") else f"/{namespace}/{node}": entry
        for node, entry in content.items()
    }


def _read(path: Path | str) -> Mapping[Any, Any]:
    import yaml  # Only here: most launches name their controllers.

    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise SettingsError(f"cannot read the controllers' file {path}: {error}") from error
    except yaml.YAMLError as error:
        reason = " ".join(str(error).split())
        raise SettingsError(f"the controllers' file {path} is not YAML: {reason}") from error
    if not isinstance(content, Mapping) or not list(_controllers(content)):
        raise SettingsError(
            f"the controllers' file {path} names no controllers; it needs "
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
            joints = parameters.get("joints") if isinstance(parameters, Mapping) else None
            return [str(joint) for joint in joints] if isinstance(joints, list) else []
    return []
