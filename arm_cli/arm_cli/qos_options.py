"""The --qos-* options of publishers and subscriptions, spelled as in ros2."""

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
"""The largest depth that rclpy accepts."""


@dataclass(frozen=True, slots=True)
class QosChoice:
    """The requested QoS policies; None leaves a policy to the profile or to the other side's QoS.

    Attributes:
        profile: short name of a preset.
        depth: length of the queue.
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
        """Whether any policy was requested."""
        return self != QosChoice()


def add_qos_arguments(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the options.

    Args:
        parser: the verb's parser.
        default: describes the QoS without any option.
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
    """Return the QoS policies that the parsed options request."""
    return QosChoice(
        profile=options.qos_profile,
        depth=options.qos_depth,
        history=options.qos_history,
        reliability=options.qos_reliability,
        durability=options.qos_durability,
        liveliness=options.qos_liveliness,
        lease_s=options.qos_liveliness_lease_duration_seconds,
    )
