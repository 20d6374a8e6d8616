"""The --qos-* options of publishers and subscriptions, spelled as in ros2."""

import argparse
from dataclasses import dataclass

from arm_cli.arguments import Argument, Group, positive_number, whole_number

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
    """The requested QoS policies by their short names, and the liveliness lease duration.

    None leaves a policy to the profile or to the other side's QoS.
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


def _depth(text: str) -> int:
    return whole_number(text, LARGEST_DEPTH)


def qos_arguments(default: str) -> Group:
    """Return the options; `default` describes the QoS without any."""
    return Group(
        "quality of service",
        Argument("--qos-profile", choices=PROFILES, help="preset to start from"),
        Argument("--qos-depth", type=_depth, metavar="N", help="length of the queue"),
        Argument("--qos-history", choices=HISTORIES),
        Argument("--qos-reliability", choices=RELIABILITIES),
        Argument("--qos-durability", choices=DURABILITIES),
        Argument("--qos-liveliness", choices=LIVELINESSES),
        Argument(
            "--qos-liveliness-lease-duration-seconds", type=positive_number, metavar="SECONDS"
        ),
        description=f"By default: {default}.",
    )


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
