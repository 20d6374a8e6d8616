"""What the command lines of spawner, unspawner and hardware_spawner have in common."""

import argparse
from collections.abc import Sequence
from itertools import pairwise


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


def parameter_files(ros_arguments: Sequence[str]) -> tuple[str, ...]:
    """Return the files that ROS arguments give with `--params-file`."""
    return tuple(value for flag, value in pairwise(ros_arguments) if flag == "--params-file")


def absolute_name(manager: str, namespace: str) -> str:
    """Return the manager's absolute name; a relative one is looked for in a namespace.

    Args:
        manager: name of its node as given.
        namespace: of the asking node, with or without the leading slash.
    """
    if manager.startswith("/"):
        return manager
    prefix = namespace.strip("/")
    return f"/{prefix}/{manager}" if prefix else f"/{manager}"


def add_controller_manager(parser: argparse.ArgumentParser) -> None:
    """Offer the choice of the controller manager."""
    parser.add_argument(
        "-c",
        "--controller-manager",
        default="controller_manager",
        metavar="NODE",
        help="name of the controller manager's node (default: %(default)s)",
    )


def add_controller_manager_timeout(parser: argparse.ArgumentParser) -> None:
    """Offer the choice of how long to wait for the controller manager."""
    _add_timeout(
        parser, "--controller-manager-timeout", 0.0, "for the controller manager; 0 for ever"
    )


def add_switch_timeout(parser: argparse.ArgumentParser) -> None:
    """Offer the choice of how long a switch may take."""
    _add_timeout(
        parser, "--switch-timeout", 5.0, "for a switch, as in a paused simulation; 0 for 1 s"
    )


def add_service_call_timeout(parser: argparse.ArgumentParser) -> None:
    """Offer the choice of how long to wait for an answer."""
    _add_timeout(
        parser, "--service-call-timeout", 10.0, "for an answer, before asking again", positive=True
    )


def _add_timeout(
    parser: argparse.ArgumentParser,
    flag: str,
    default_s: float,
    meaning: str,
    *,
    positive: bool = False,
) -> None:
    parser.add_argument(
        flag,
        type=_positive_seconds if positive else _seconds,
        default=default_s,
        metavar="SECONDS",
        help=f"how long to wait {meaning} (default: %(default)s)",
    )


def _seconds(text: str) -> float:
    """Read a time-out that may be 0."""
    try:
        seconds = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number of seconds, not '{text}'") from None
    if not 0.0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"must be 0 or positive, not {text}")
    return seconds


def _positive_seconds(text: str) -> float:
    """Read a time-out that may not."""
    seconds = _seconds(text)
    if seconds == 0.0:
        raise argparse.ArgumentTypeError("must be positive, not 0")
    return seconds
