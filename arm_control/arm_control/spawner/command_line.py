"""The command lines of unspawner and hardware_spawner, and options shared with spawner's."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

from arm_control.lifecycle import LifecycleState


def absolute_name(manager: str, namespace: str) -> str:
    """Return the manager's absolute name; a relative one belongs to a namespace.

    Args:
        manager: name of its node as given.
        namespace: namespace of the client's node, with or without the leading slash.
    """
    if manager.startswith("/"):
        return manager
    prefix = namespace.strip("/")
    return f"/{prefix}/{manager}" if prefix else f"/{manager}"


def add_controller_manager(parser: argparse.ArgumentParser) -> None:
    """Add the option for the controller manager."""
    parser.add_argument(
        "-c",
        "--controller-manager",
        default="controller_manager",
        metavar="NODE",
        help="name of the controller manager's node (default: %(default)s)",
    )


def add_controller_manager_timeout(parser: argparse.ArgumentParser) -> None:
    """Add the timeout for the controller manager."""
    _add_timeout(
        parser, "--controller-manager-timeout", 0.0, "for the controller manager; 0 waits for ever"
    )


def add_switch_timeout(parser: argparse.ArgumentParser) -> None:
    """Add the timeout of a switch."""
    _add_timeout(
        parser, "--switch-timeout", 5.0, "for a switch, as in a paused simulation; 0 means 1 s"
    )


def add_service_call_timeout(parser: argparse.ArgumentParser) -> None:
    """Add the timeout of a service call."""
    _add_timeout(
        parser, "--service-call-timeout", 10.0, "for an answer before asking again", positive=True
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
    """Convert a timeout that may be 0."""
    try:
        seconds = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number of seconds, not '{text}'") from None
    if not 0.0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"must be 0 or positive, not {text}")
    return seconds


def _positive_seconds(text: str) -> float:
    """Convert a timeout that must not be 0."""
    seconds = _seconds(text)
    if seconds == 0.0:
        raise argparse.ArgumentTypeError("must be positive, not 0")
    return seconds


@dataclass(frozen=True, slots=True)
class UnspawnerOptions:
    """The options of an unspawner.

    Attributes:
        names: controllers, in the order in which to unload them.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        switch_timeout_s: how long the manager may take to switch; 0 for its default.
    """

    names: tuple[str, ...]
    controller_manager: str
    switch_timeout_s: float


def parse_unspawner_options(arguments: Sequence[str]) -> UnspawnerOptions:
    """Parse the unspawner's arguments; an error ends the process with code 2."""
    parser = argparse.ArgumentParser(
        prog="unspawner", description="Deactivate and unload controllers.", allow_abbrev=False
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="controllers, in this order")
    add_controller_manager(parser)
    add_switch_timeout(parser)
    options = parser.parse_intermixed_args(arguments)
    return UnspawnerOptions(
        names=tuple(options.names),
        controller_manager=options.controller_manager,
        switch_timeout_s=options.switch_timeout,
    )


@dataclass(frozen=True, slots=True)
class HardwareSpawnerOptions:
    """The options of a hardware spawner.

    Attributes:
        names: hardware components, in the order in which to change them.
        target: the state to bring them to.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        controller_manager_timeout_s: how long to wait for the manager; 0 for ever.
    """

    names: tuple[str, ...]
    target: LifecycleState
    controller_manager: str
    controller_manager_timeout_s: float


def parse_hardware_spawner_options(arguments: Sequence[str]) -> HardwareSpawnerOptions:
    """Parse the hardware spawner's arguments; an error ends the process with code 2."""
    parser = argparse.ArgumentParser(
        prog="hardware_spawner",
        description="Configure or activate hardware components.",
        allow_abbrev=False,
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="components, in this order")
    add_controller_manager(parser)
    add_controller_manager_timeout(parser)
    target = parser.add_mutually_exclusive_group(required=True)
    for flag, state, meaning in (
        ("--activate", LifecycleState.ACTIVE, "configure and activate them"),
        ("--configure", LifecycleState.INACTIVE, "configure them, so that they are inactive"),
    ):
        target.add_argument(flag, action="store_const", const=state, dest="target", help=meaning)
    options = parser.parse_intermixed_args(arguments)
    return HardwareSpawnerOptions(
        names=tuple(options.names),
        target=options.target,
        controller_manager=options.controller_manager,
        controller_manager_timeout_s=options.controller_manager_timeout,
    )
