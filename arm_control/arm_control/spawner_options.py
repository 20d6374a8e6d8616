"""The spawner's command line."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SpawnerOptions:
    """What a spawner is to do.

    Attributes:
        names: controllers, in the order to start them.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        param_files: parameter files for the controllers.
        namespace: of the controllers; empty for that of the spawner's own node.
        load_only: whether to stop once they are loaded.
        inactive: whether to stop once they are configured.
        unload_on_kill: whether to go on running, and to unload them in the end.
        controller_manager_timeout_s: how long to wait for the manager; 0 for ever.
        switch_timeout_s: how long the manager may take to switch; 0 for its default.
        service_call_timeout_s: how long to wait for an answer before asking again.
        activate_as_group: whether to activate all in one switch.
        switch_asap: passed on to the manager.
        controller_ros_args: ROS arguments for the controllers' nodes.
    """

    names: tuple[str, ...]
    controller_manager: str
    param_files: tuple[str, ...]
    namespace: str
    load_only: bool
    inactive: bool
    unload_on_kill: bool
    controller_manager_timeout_s: float
    switch_timeout_s: float
    service_call_timeout_s: float
    activate_as_group: bool
    switch_asap: bool
    controller_ros_args: tuple[str, ...]


def split_ros_arguments(argv: Sequence[str]) -> tuple[list[str], list[str]]:
    """Part a command line, without the program's name, into its own and its ROS arguments."""
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


def parse_spawner_options(arguments: Sequence[str]) -> SpawnerOptions:
    """Read the spawner's own arguments; a mistake ends the process with code 2, as usual."""
    options = _parser().parse_args(arguments)
    return SpawnerOptions(
        names=tuple(options.controller_names),
        controller_manager=options.controller_manager,
        param_files=tuple(options.param_file),
        namespace=options.namespace,
        load_only=options.load_only,
        inactive=options.inactive,
        unload_on_kill=options.unload_on_kill,
        controller_manager_timeout_s=options.controller_manager_timeout,
        switch_timeout_s=options.switch_timeout,
        service_call_timeout_s=options.service_call_timeout,
        activate_as_group=options.activate_as_group,
        switch_asap=options.switch_asap,
        controller_ros_args=tuple(
            word for words in options.controller_ros_args for word in words.split()
        ),
    )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="spawner", description="Load, configure and activate controllers."
    )
    parser.add_argument(
        "controller_names", nargs="+", metavar="NAME", help="controllers to start, in this order"
    )
    parser.add_argument(
        "-c",
        "--controller-manager",
        default="controller_manager",
        metavar="NODE",
        help="name of the controller manager's node (default: %(default)s)",
    )
    parser.add_argument(
        "-p",
        "--param-file",
        action="append",
        default=[],
        metavar="FILE",
        help="parameter file of the controllers; may be given several times",
    )
    parser.add_argument(
        "-n",
        "--namespace",
        default="",
        help="deprecated: give the namespace with --ros-args -r __ns:=/x",
    )
    _add_extent(parser)
    _add_timeouts(parser)
    parser.add_argument(
        "--activate-as-group",
        action="store_true",
        help="activate all controllers in one switch instead of one after the other",
    )
    parser.add_argument(
        "--switch-asap",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="passed on to the controller manager",
    )
    parser.add_argument(
        "--controller-ros-args",
        action="append",
        default=[],
        metavar="ARGS",
        help="ROS arguments for the nodes of the controllers; may be given several times",
    )
    return parser


def _add_extent(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--load-only", action="store_true", help="load, and do not configure")
    parser.add_argument("--inactive", action="store_true", help="configure, and do not activate")
    parser.add_argument(
        "-u",
        "--unload-on-kill",
        action="store_true",
        help="keep running; deactivate and unload the controllers when it is ended",
    )


def _add_timeouts(parser: argparse.ArgumentParser) -> None:
    for flag, read, default, meaning in (
        ("--controller-manager-timeout", _seconds, 0.0, "for the controller manager; 0 for ever"),
        ("--switch-timeout", _seconds, 5.0, "for a switch; 0 for the manager's own default"),
        ("--service-call-timeout", _positive_seconds, 10.0, "for an answer, before asking again"),
    ):
        parser.add_argument(
            flag,
            type=read,
            default=default,
            metavar="SECONDS",
            help=f"how long to wait {meaning} (default: %(default)s)",
        )


def _seconds(text: str) -> float:
    """Read a time-out that may be 0."""
    seconds = float(text)
    if not 0.0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"must be 0 or positive, not {text}")
    return seconds


def _positive_seconds(text: str) -> float:
    """Read a time-out that may not."""
    seconds = _seconds(text)
    if seconds == 0.0:
        raise argparse.ArgumentTypeError("must be positive, not 0")
    return seconds
