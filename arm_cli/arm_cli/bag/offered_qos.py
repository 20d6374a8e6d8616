"""The quality of service that a publisher offered, as rosbag2 writes it into its files."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arm_cli.bag.yaml_text import dump_yaml, load_yaml

INFINITE_NS = 2**63 - 1
"""A duration that nobody has limited."""

# The position is the number that files before metadata version 9 hold instead of the name.
POLICIES = {
    "history": ("system_default", "keep_last", "keep_all", "unknown"),
    "reliability": ("system_default", "reliable", "best_effort", "unknown", "best_available"),
    "durability": ("system_default", "transient_local", "volatile", "unknown", "best_available"),
    "liveliness": (
        "system_default",
        "automatic",
        "manual_by_node",
        "manual_by_topic",
        "unknown",
        "best_available",
    ),
}


@dataclass(frozen=True, slots=True)
class OfferedQos:
    """One publisher's offer; policies by rclpy's short names.

    Attributes:
        history: Fast DDS does not tell it to others: "unknown".
        depth: 0 where the history is unknown.
        reliability: policy.
        durability: policy.
        deadline_ns: INFINITE_NS is none, as for the other durations.
        lifespan_ns: duration.
        liveliness: policy.
        lease_ns: liveliness lease duration.
        avoid_ros_namespace_conventions: whether the topic has no `rt/` before its DDS name.
    """

    history: str = "unknown"
    depth: int = 0
    reliability: str = "reliable"
    durability: str = "volatile"
    deadline_ns: int = INFINITE_NS
    lifespan_ns: int = INFINITE_NS
    liveliness: str = "automatic"
    lease_ns: int = INFINITE_NS
    avoid_ros_namespace_conventions: bool = False

    def to_plain(self) -> dict[str, Any]:
        """Return it as metadata version 9 has it."""
        return {
            "history": self.history,
            "depth": self.depth,
            "reliability": self.reliability,
            "durability": self.durability,
            "deadline": _duration(self.deadline_ns),
            "lifespan": _duration(self.lifespan_ns),
            "liveliness": self.liveliness,
            "liveliness_lease_duration": _duration(self.lease_ns),
            "avoid_ros_namespace_conventions": self.avoid_ros_namespace_conventions,
        }


def offers_to_text(offers: Sequence[OfferedQos]) -> str:
    """Return offers as the text that an MCAP channel carries."""
    return dump_yaml([offer.to_plain() for offer in offers])


def read_offers(value: Any) -> tuple[OfferedQos, ...]:
    """Return the offers of a file's entry, a list or its YAML text; what is unclear is default."""
    if isinstance(value, str):
        try:
            value = load_yaml(value)
        except ValueError:
            return ()
    if not isinstance(value, list):
        return ()
    return tuple(_offer(item) for item in value if isinstance(item, dict))


def _offer(item: dict[str, Any]) -> OfferedQos:
    depth = item.get("depth", 0)
    return OfferedQos(
        history=_policy(item, "history", "unknown"),
        depth=depth if isinstance(depth, int) and depth >= 0 else 0,
        reliability=_policy(item, "reliability", "reliable"),
        durability=_policy(item, "durability", "volatile"),
        deadline_ns=_nanoseconds(item.get("deadline")),
        lifespan_ns=_nanoseconds(item.get("lifespan")),
        liveliness=_policy(item, "liveliness", "automatic"),
        lease_ns=_nanoseconds(item.get("liveliness_lease_duration")),
        avoid_ros_namespace_conventions=item.get("avoid_ros_namespace_conventions") is True,
    )


def _policy(item: dict[str, Any], key: str, default: str) -> str:
    value, names = item.get(key), POLICIES[key]
    if isinstance(value, int) and 0 <= value < len(names):
        return names[value]
    return value if isinstance(value, str) and value in names else default


def _duration(nanoseconds: int) -> dict[str, int]:
    sec, nsec = divmod(nanoseconds, 10**9)
    return {"sec": sec, "nsec": nsec}


def _nanoseconds(value: Any) -> int:
    if not isinstance(value, dict):
        return INFINITE_NS
    sec, nsec = value.get("sec"), value.get("nsec")
    if not isinstance(sec, int) or not isinstance(nsec, int):
        return INFINITE_NS
    # Zero is how older middlewares wrote "not limited".
    return min(sec * 10**9 + nsec, INFINITE_NS) or INFINITE_NS
