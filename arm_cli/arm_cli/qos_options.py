"""The --qos-* options of publishers and subscriptions, in ros2's words."""

import argparse
from dataclasses import dataclass

from arm_cli.command_parser import positive_number, whole_number

PROFILES = (
    "system_default",
    "default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
)
HISTORIES = ("system_default", "keep_last", "keep_all")
RELIABILITIES = ("system_default", "reliable", "best_effort", "best_available")
DURABILITIES = ("system_default", "transient_local", "volatile", "best_available")
LIVELINESSES = ("system_default", "automatic", "manual_by_topic", "best_available")
LARGEST_DEPTH = 2**31 - 1
"""What rclpy takes."""


@dataclass(frozen=True, slots=True)
class QosChoice:
    """What was asked for; None leaves it to the profile, or to what the other side offers.

    Attributes:
        profile: short name of a preset.
        depth: of the queue.
        history: short name.
        reliability: short name.
        durability: short name.
        liveliness: short name.
        lease_s: liveliness lease duration.
    """

    profile: str | None = None
    depth: int | None = None
    history: str | None = None
    reliability: str | None = None
    durability: str | None = None
    liveliness: str | None = None
    lease_s: float | None = None

    @property
    def is_given(self) -> bool:
        """Whether anything was asked for."""
        return self != QosChoice()


def add_qos_arguments(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the options.

    Args:
        parser: to add them to.
        default: says what holds where none is given.
    """
    group = parser.add_argument_group("quality of service", f"By default: {default}.")
    group.add_argument("--qos-profile", choices=PROFILES, help="preset to start from")
    group.add_argument("--qos-depth", type=_depth, metavar="N", help="length of the queue")
    group.add_argument("--qos-history", choices=HISTORIES)
    group.add_argument("--qos-reliability", choices=RELIABILITIES)
    group.add_argument("--qos-durability", choices=DURABILITIES)
    group.add_argument("--qos-liveliness", choices=LIVELINESSES)
    group.add_argument(
        "--qos-liveliness-lease-duration-seconds", type=positive_number, metavar="SECONDS"
    )


def _depth(text: str) -> int:
    return whole_number(text, LARGEST_DEPTH)


def qos_choice(options: argparse.Namespace) -> QosChoice:
    """Return what the parsed options ask for."""
    return QosChoice(
        profile=options.qos_profile,
        depth=options.qos_depth,
        history=options.qos_history,
        reliability=options.qos_reliability,
        durability=options.qos_durability,
        liveliness=options.qos_liveliness,
        lease_s=options.qos_liveliness_lease_duration_seconds,
    )
