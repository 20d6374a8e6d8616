"""Selects the ROS arguments of a process that each of its nodes gets."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

_PAIRED = ("-r", "--remap", "-p", "--param", "--params-file")
_RENAMING = ("__node", "__name")
_PLACING = ("__ns",)


def split_ros_arguments(argv: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split a command line, without the program name, into ordinary and ROS arguments."""
    own: list[str] = []
    ros: list[str] = []
    inside = False
    for argument in argv:
        if argument == "--ros-args":
            inside = True
        if inside:
            ros.append(argument)
        else:
            own.append(argument)
        if argument == "--":
            inside = False
    return own, ros


def parameter_files(ros_arguments: Sequence[str]) -> tuple[str, ...]:
    """Return the `--params-file` arguments among ROS arguments."""
    return tuple(value for flag, value in pairwise(ros_arguments) if flag == "--params-file")


def manager_arguments(argv: Sequence[str]) -> list[str]:
    """Return the arguments for the controller manager's node.

    They are remaps, parameters and parameter files, except `__node:=x`, which would give every node
    of the process the same name (`controller_manager:__node:=x` renames this one). Only arguments
    after `--ros-args` are used.
    """
    return _as_arguments(_chosen(argv, _RENAMING))


def controller_arguments(argv: Sequence[str], extra: Sequence[str] = ()) -> list[str]:
    """Return the arguments for a controller's node.

    Like `manager_arguments`, but without the namespace, because the node uses the manager's, and
    without a `robot_description` parameter; one in a parameter file is kept. `extra` comes from the
    manager's `<controller>.node_options_args`.
    """
    kept = [
        pair
        for pair in _chosen(argv, (*_RENAMING, *_PLACING))
        if not pair[1].startswith("robot_description:=")
    ]
    own = [argument for argument in extra if argument != "--ros-args"]
    return [*_as_arguments(kept), *own]


def _chosen(argv: Sequence[str], dropped: Sequence[str]) -> list[tuple[str, str]]:
    return [
        (flag, value)
        for flag, value in _pairs(argv)
        if not any(value.startswith(f"{rule}:=") for rule in dropped)
    ]


def _pairs(argv: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield the flags that concern a node, each with its value."""
    arguments = iter(argv)
    inside = False
    for argument in arguments:
        if argument in ("--ros-args", "--"):
            inside = argument == "--ros-args"
        elif inside and argument in _PAIRED:
            value = next(arguments, None)
            if value is not None:
                yield argument, value


def _as_arguments(pairs: Sequence[tuple[str, str]]) -> list[str]:
    return ["--ros-args", *(part for pair in pairs for part in pair)]
