"""QoS of recorded topics: the policies that publishers offered, and a user's overrides."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from arm_cli.bag_format.yaml_text import dump_yaml, load_yaml
from arm_cli.errors import BagError
from arm_cli.names import absolute_name
from arm_node.names import describe_known
from arm_node.user_file import read_text

UNLIMITED_SEC = 2**31 - 1
"""The whole seconds of "no limit" in older recordings; newer ones have more."""


class QosDuration(NamedTuple):
    """A duration as a bag holds it, because other readers compare the numbers."""

    sec: int
    nsec: int

    @property
    def limit_ns(self) -> int | None:
        """The duration in nanoseconds, None for no limit, for which there are several numbers."""
        total_ns = self.sec * 10**9 + self.nsec
        return total_ns if self.sec < UNLIMITED_SEC and total_ns > 0 else None


INFINITE = QosDuration(*divmod(2**63 - 1, 10**9))
"""No limit, as Jazzy writes it."""

# The position of a name is the number that metadata before version 9 hold instead of it.
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
    """The QoS that one publisher offers, with policies by rclpy's short names.

    If recorded, the history is "unknown" and the depth 0, because Fast DDS does not announce them.
    The topic's DDS name has the prefix `rt/` unless ROS's naming conventions are avoided.
    """

    history: str = "unknown"
    depth: int = 0
    reliability: str = "reliable"
    durability: str = "volatile"
    deadline: QosDuration = INFINITE
    lifespan: QosDuration = INFINITE
    liveliness: str = "automatic"
    lease: QosDuration = INFINITE
    avoid_ros_namespace_conventions: bool = False

    def to_plain(self) -> dict[str, Any]:
        """Return the offer in the form of metadata version 9."""
        return {
            "history": self.history,
            "depth": self.depth,
            "reliability": self.reliability,
            "durability": self.durability,
            "deadline": self.deadline._asdict(),
            "lifespan": self.lifespan._asdict(),
            "liveliness": self.liveliness,
            "liveliness_lease_duration": self.lease._asdict(),
            "avoid_ros_namespace_conventions": self.avoid_ros_namespace_conventions,
        }


def offers_to_text(offers: Sequence[OfferedQos]) -> str:
    """Return offers as the text of an MCAP channel's metadata."""
    return dump_yaml([offer.to_plain() for offer in offers])


def read_offers(value: Any) -> tuple[OfferedQos, ...]:
    """Return the offers in a list or its YAML text; invalid values become defaults."""
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
        deadline=_duration(item.get("deadline")),
        lifespan=_duration(item.get("lifespan")),
        liveliness=_policy(item, "liveliness", "automatic"),
        lease=_duration(item.get("liveliness_lease_duration")),
        avoid_ros_namespace_conventions=item.get("avoid_ros_namespace_conventions") is True,
    )


def _policy(item: dict[str, Any], key: str, default: str) -> str:
    value, names = item.get(key), POLICIES[key]
    if isinstance(value, int) and 0 <= value < len(names):
        return names[value]
    return value if isinstance(value, str) and value in names else default


def _duration(value: Any) -> QosDuration:
    if not isinstance(value, dict):
        return INFINITE
    sec, nsec = value.get("sec"), value.get("nsec")
    if not isinstance(sec, int) or not isinstance(nsec, int):
        return INFINITE
    return QosDuration(sec, nsec)


def read_qos_overrides(path: Path | None) -> dict[str, OfferedQos]:
    """Return the QoS overrides by topic; an empty dict without a file.

    Raises:
        BagError: the file is missing or malformed; the message says what is wrong and where.
    """
    if path is None:
        return {}
    try:
        content = load_yaml(read_text(path))
    except OSError as error:
        raise BagError(f"cannot read {path}: {error.strerror}") from error
    except ValueError as error:
        raise BagError(f"{path} is {error}") from error
    if not isinstance(content, dict):
        raise BagError(f"{path} has no topics: its form must be '/topic: {{depth: 10}}'")
    return {
        absolute_name(str(name)): _override(value, f"{path}: {name}")
        for name, value in content.items()
    }


def _override(value: Any, where: str) -> OfferedQos:
    if not isinstance(value, Mapping):
        raise BagError(f"{where} has no policies, such as 'reliability: best_effort'")
    known = OfferedQos().to_plain()
    for key, setting in value.items():
        if key not in known:
            raise BagError(f"{where} has no policy {str(key)!r}; {describe_known(str(key), known)}")
        names = POLICIES.get(key)
        if names is not None and setting not in names:
            hint = describe_known(str(setting), names)
            raise BagError(f"{where}: {key} cannot be {setting!r}; {hint}")
    return read_offers([dict(value)])[0]
