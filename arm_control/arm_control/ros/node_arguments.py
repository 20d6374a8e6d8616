"""The ROS arguments of the process, sorted out for a node that is one of several in it."""

from collections.abc import Iterator, Sequence

_PAIRED = ("-r", "--remap", "-p", "--param", "--params-file")
_RENAMING = ("__node", "__name")
_PLACING = ("__ns",)


def manager_arguments(argv: Sequence[str]) -> list[str]:
    """Return the arguments that the controller manager's node takes over.

    Remaps, parameters and parameter files; not `__node:=x`, which would give every node of the
    process the same name (`controller_manager:__node:=x` renames this one).

    Args:
        argv: of the process; what follows `--ros-args` counts.
    """
    return _as_arguments(_chosen(argv, _RENAMING))


def controller_arguments(argv: Sequence[str], extra: Sequence[str] = ()) -> list[str]:
    """Return the arguments that a controller's node takes over.

    As `manager_arguments`, but without the namespace, which is the manager's, and without a robot
    description that is given by itself: one in a parameter file comes along.

    Args:
        argv: of the process.
        extra: the controller's own, given through the manager's `<controller>.node_options_args`.
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
    """Yield the flags that matter to a node, each with its value."""
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
