"""Converts the elements of an XML or YAML launch file to actions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from launch_py.action import Action
from launch_py.actions.event_actions import Shutdown
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.actions.grouping import GroupAction, TimerAction
from launch_py.actions.messages import LogInfo
from launch_py.actions.settings import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    PopEnvironment,
    PushEnvironment,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from launch_py.errors import LaunchError, LaunchFileError
from launch_py.frontend.entity import Entity, FileText, read_entities
from launch_py.launch_description import LaunchDescription
from launch_py.near_names import describe_known
from launch_py.ros.actions import (
    Node,
    PushRosNamespace,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from launch_py.ros.composable import (
    ComposableNode,
    ComposableNodeContainer,
    LoadComposableNodes,
)
from launch_py.ros.lifecycle import LifecycleNode
from launch_py.ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_py.substitution import Text

PROCESS_WORDS = {
    "name": "name",
    "cwd": "cwd",
    "launch-prefix": "prefix",
    "output": "output",
    "emulate_tty": "emulate_tty",
    "respawn": "respawn",
    "respawn_delay": "respawn_delay",
    "respawn_max_retries": "respawn_max_retries",
    "sigterm_timeout": "sigterm_timeout",
    "sigkill_timeout": "sigkill_timeout",
}
"""The attributes of processes, and the arguments of `ExecuteProcess` that they set."""

NUMBERS: dict[str, Callable[[str], float]] = {"respawn_delay": float, "respawn_max_retries": int}

TYPES: dict[str, Any] = {
    "bool": bool,
    "int": int,
    "float": float,
    "str": str,
    "yaml": None,
    "list_of_bool": list[bool],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_str": list[str],
}
"""The values of a parameter's attribute `type`."""


@dataclass(frozen=True, slots=True)
class Element:
    """The attributes and children of an element, and its conversion.

    Attributes:
        make: returns the action.
        needed: the attributes that it must have.
        optional: the attributes that it may have, besides `if` and `unless`.
        children: the elements that it may contain; None means any action, and `make` gets the
            actions, too.
        parts: the elements beside those actions that are none.
    """

    make: Callable[..., Action]
    needed: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    children: tuple[str, ...] | None = ()
    parts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Part:
    """An element that belongs to another one and is not an action itself; see `Element`."""

    needed: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    children: tuple[str, ...] = ()


def read_description(path: Path, include: Callable[..., Action]) -> LaunchDescription:
    """Return the launch description in an XML or YAML launch file.

    `include` makes the action of an `include` from the file's name. It is an argument because it
    reads launch files of all formats, and so stands above this module.

    Raises:
        LaunchFileError: the file cannot be read, or an element in it is unknown or malformed.
    """
    root = read_entities(path)
    root.refuse_unknown((), ("version",))
    including = Element(partial(_include, include), ("file",), (), ("arg", "let"))
    elements = {**ELEMENTS, "include": including}
    return LaunchDescription([_action(child, elements) for child in root.children])


def _action(entity: Entity, elements: Mapping[str, Element]) -> Action:
    element = elements.get(entity.tag.replace("-", "_"))
    if element is None:
        known = describe_known(entity.tag, elements)
        raise LaunchFileError(f"{entity.where}: no action {entity.tag!r} here; {known}")
    entity.refuse_unknown(element.needed, (*element.optional, "if", "unless"))
    if element.children is not None:
        _check_parts(entity, element.children)
    inside = [child for child in entity.children if child.tag not in element.parts]
    inner = [] if element.children is not None else [[_action(c, elements) for c in inside]]
    try:
        action = element.make(entity, *inner)
        action.where = entity.where
        return action
    except LaunchFileError:
        raise
    except LaunchError as error:
        raise LaunchFileError(f"{entity.where}: {error}") from error


def _check_parts(entity: Entity, allowed: Iterable[str]) -> None:
    for child in entity.children:
        if child.tag not in allowed:
            known = describe_known(child.tag, allowed, "it takes")
            raise LaunchFileError(
                f"{child.where}: {entity.tag} does not take {child.tag!r}; {known}"
            )
        part = PARTS[child.tag]
        child.refuse_unknown(part.needed, part.optional)
        _check_parts(child, part.children)


def _process_options(entity: Entity) -> dict[str, Any]:
    options: dict[str, Any] = {"condition": entity.condition()}
    for name, argument in PROCESS_WORDS.items():
        if name not in entity.attributes:
            continue
        if name in NUMBERS:
            word = entity.word(name)
            try:
                options[argument] = NUMBERS[name](word)
            except ValueError:
                raise LaunchFileError(f"{entity.where}: {name}={word!r} is not a number") from None
        else:
            options[argument] = entity.text(name)
    variables = [(c.text("name"), c.text("value")) for c in entity.children_named("env")]
    if variables:
        options["additional_env"] = dict(variables)
    return options


def _node(entity: Entity) -> Action:
    return Node(**_node_options(entity))


def _node_options(entity: Entity) -> dict[str, Any]:
    return {
        "executable": entity.text("exec"),
        "exec_name": entity.text_or_none("exec_name"),
        "arguments": entity.words("args"),
        "ros_arguments": entity.words("ros_args"),
        **_graph_options(entity),
        **_process_options(entity),
    }


def _graph_options(entity: Entity) -> dict[str, Any]:
    """Return what nodes and components have in common."""
    return {
        "package": entity.text("pkg"),
        "namespace": entity.text_or_none("namespace"),
        "parameters": _parameters(entity),
        "remappings": [(c.text("from"), c.text("to")) for c in entity.children_named("remap")],
    }


def _lifecycle_node(entity: Entity) -> Action:
    options = _node_options(entity)
    options["namespace"] = options["namespace"] or ""
    return LifecycleNode(autostart=entity.boolean("autostart", False), **options)


def _components(entity: Entity) -> list[ComposableNode]:
    return [
        ComposableNode(
            plugin=child.text("plugin"),
            name=child.text_or_none("name"),
            condition=child.condition(),
            **_graph_options(child),
        )
        for child in entity.children_named("composable_node")
    ]


def _container(entity: Entity) -> Action:
    return ComposableNodeContainer(
        name=entity.text("name"),
        composable_node_descriptions=_components(entity),
        condition=entity.condition(),
    )


def _load_components(entity: Entity) -> Action:
    return LoadComposableNodes(
        composable_node_descriptions=_components(entity),
        target_container=entity.text("target"),
        condition=entity.condition(),
    )


def _parameters(entity: Entity) -> list[Any]:
    parameters: list[Any] = []
    for child in entity.children_named("param"):
        if "from" in child.attributes:
            substitute = child.text("allow_substs") if "allow_substs" in child.attributes else False
            parameters.append(ParameterFile(child.text("from"), allow_substs=substitute))
        else:
            parameters.append(_parameter(child))
    return parameters


def _parameter(entity: Entity) -> dict[Text, Any]:
    if "name" not in entity.attributes:
        raise LaunchFileError(f"{entity.where}: param has neither 'name' nor 'from'")
    name = entity.text("name")
    if entity.children:
        inner: dict[Text, Any] = {}
        for child in entity.children:
            inner.update(_parameter(child))
        return {name: inner}
    if "value" not in entity.attributes:
        raise LaunchFileError(f"{entity.where}: param {name.text!r} has no 'value'")
    return {name: _value(entity)}


def _value(entity: Entity) -> Any:
    value = entity.attributes["value"]
    kind = entity.word("type", "yaml")
    if kind not in TYPES:
        known = describe_known(kind, TYPES, "the types are")
        raise LaunchFileError(f"{entity.where}: no type {kind!r} of a parameter; {known}")
    if not isinstance(value, str) and kind == "yaml":
        return value
    text = FileText(value, entity.where)
    return text if TYPES[kind] is None else ParameterValue(text, value_type=TYPES[kind])


def _executable(entity: Entity) -> Action:
    command = entity.words("cmd")
    command += entity.words("args")
    shell = entity.boolean("shell", False)
    if shell:
        command = [entity.text("cmd")]
    return ExecuteProcess(cmd=command, shell=shell, **_process_options(entity))


def _include(include: Callable[..., Action], entity: Entity) -> Action:
    arguments = [(c.text("name"), c.text("value")) for c in entity.children_named("arg", "let")]
    return include(entity.text("file"), launch_arguments=arguments, condition=entity.condition())


def _argument(entity: Entity) -> Action:
    return DeclareLaunchArgument(
        entity.word("name"),
        default_value=entity.text_or_none("default"),
        description=entity.word("description") or None,
        choices=[c.word("value") for c in entity.children_named("choice")],
        condition=entity.condition(),
    )


def _group(entity: Entity, actions: list[Action]) -> Action:
    kept = entity.children_named("keep")
    for child in kept:
        child.refuse_unknown(PAIR, ())
    # Arguments are declared before the actions that use them, wherever they stand.
    actions.sort(key=lambda action: not isinstance(action, DeclareLaunchArgument))
    return GroupAction(
        actions,
        scoped=entity.boolean("scoped", True),
        forwarding=entity.boolean("forwarding", True),
        launch_configurations={child.word("name"): child.text("value") for child in kept},
        condition=entity.condition(),
    )


def _named(make: Callable[..., Action]) -> Callable[[Entity], Action]:
    """Return a function that makes an action from the attributes `name` and `value`."""
    return lambda entity: make(
        entity.text("name"), entity.text("value"), condition=entity.condition()
    )


def _append_env(entity: Entity) -> Action:
    others = {n: entity.text(n) for n in ("prepend", "separator") if n in entity.attributes}
    return AppendEnvironmentVariable(
        entity.text("name"), entity.text("value"), condition=entity.condition(), **others
    )


def _timer(make: Callable[..., Action], entity: Entity, actions: list[Action]) -> Action:
    return make(period=entity.text("period"), actions=actions, condition=entity.condition())


def _one(make: Callable[..., Action], attribute: str, argument: str) -> Callable[[Entity], Action]:
    """Return a function that makes an action, with one attribute as an argument of it."""
    return lambda entity: make(**{argument: entity.text(attribute)}, condition=entity.condition())


def _set_parameter(entity: Entity) -> Action:
    return SetParameter(entity.text("name"), _value(entity), condition=entity.condition())


def _pairs(entity: Entity, child: str) -> dict[Any, Any]:
    return {(c.text("name"),): c.text("value") for c in entity.children_named(child)}


def _bare(make: Callable[..., Action]) -> Callable[[Entity], Action]:
    """Return a function that makes an action without arguments."""
    return lambda entity: make(condition=entity.condition())


def _reset(entity: Entity) -> Action:
    return ResetLaunchConfigurations(_pairs(entity, "keep"), condition=entity.condition())


def _replace_env(entity: Entity) -> Action:
    return ReplaceEnvironmentVariables(_pairs(entity, "env"), condition=entity.condition())


def _shutdown(entity: Entity) -> Action:
    return Shutdown(reason=entity.text_or_none("reason") or "", condition=entity.condition())


def _set_remap(entity: Entity) -> Action:
    return SetRemap(entity.text("from"), entity.text("to"), condition=entity.condition())


NAMESPACE = Element(_one(PushRosNamespace, "namespace", "namespace"), ("namespace",))
PROCESS = tuple(PROCESS_WORDS)
PAIR = ("name", "value")

NODE_WORDS = ("namespace", "exec_name", "args", "ros_args", *PROCESS)
NODE_PARTS = ("param", "remap", "env")

PARTS = {
    "arg": Part(PAIR),
    "composable_node": Part(
        ("pkg", "plugin"), ("name", "namespace", "if", "unless"), ("param", "remap", "extra_arg")
    ),
    "extra_arg": Part(PAIR),
    "keep": Part(PAIR),
    "choice": Part(("value",)),
    "env": Part(PAIR),
    "let": Part(PAIR),
    "param": Part((), ("name", "value", "from", "type", "allow_substs"), ("param",)),
    "remap": Part(("from", "to")),
}
"""Elements that occur only inside others."""

ELEMENTS = {
    "append_env": Element(_append_env, PAIR, ("prepend", "separator")),
    "arg": Element(_argument, ("name",), ("default", "description"), ("choice",)),
    "executable": Element(_executable, ("cmd",), ("args", "shell", *PROCESS), ("env",)),
    "group": Element(_group, (), ("scoped", "forwarding"), None, ("keep",)),
    "let": Element(_named(SetLaunchConfiguration), PAIR),
    "log": Element(_one(LogInfo, "message", "msg"), ("message",), ("level",)),
    "lifecycle_node": Element(
        _lifecycle_node, ("pkg", "exec", "name"), ("autostart", *NODE_WORDS), NODE_PARTS
    ),
    "load_composable_node": Element(_load_components, ("target",), (), ("composable_node",)),
    "node": Element(_node, ("pkg", "exec"), NODE_WORDS, NODE_PARTS),
    "node_container": Element(
        _container,
        ("pkg", "exec", "name", "namespace"),
        NODE_WORDS,
        ("composable_node", *NODE_PARTS),
    ),
    "pop_env": Element(_bare(PopEnvironment)),
    "push_env": Element(_bare(PushEnvironment)),
    "push_namespace": NAMESPACE,
    "push_ros_namespace": NAMESPACE,
    "rep_env": Element(_replace_env, (), (), ("env",)),
    "reset": Element(_reset, (), (), ("keep",)),
    "reset_env": Element(_bare(ResetEnvironment)),
    "ros_timer": Element(partial(_timer, RosTimer), ("period",), (), None),
    "set_env": Element(_named(SetEnvironmentVariable), PAIR),
    "set_parameter": Element(_set_parameter, PAIR, ("type",)),
    "set_parameters_from_file": Element(
        _one(SetParametersFromFile, "filename", "filename"), ("filename",)
    ),
    "set_remap": Element(_set_remap, ("from", "to")),
    "set_ros_log_dir": Element(_one(SetROSLogDir, "new_log_dir", "new_log_dir"), ("new_log_dir",)),
    "set_use_sim_time": Element(_one(SetUseSimTime, "value", "value"), ("value",)),
    "shutdown": Element(_shutdown, (), ("reason",)),
    "timer": Element(partial(_timer, TimerAction), ("period",), (), None),
    "unset_env": Element(_one(UnsetEnvironmentVariable, "name", "name"), ("name",)),
}
"""The actions by the names of their elements; a hyphen counts as an underscore."""
