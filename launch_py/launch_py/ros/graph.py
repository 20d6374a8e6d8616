"""The ROS graph as one node sees it: topics, services, and the nodes with their processes."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from launch_py.fast_dds.participants import PID_BITS, domain_of, find_ports
from launch_py.fast_dds.shared_memory import hide_own_segments

if TYPE_CHECKING:
    from rclpy.node import Node


PREFIX_BYTES = 12
FAST_DDS = bytes((0x01, 0x0F))
"""The vendor id at the start of a GUID; two bytes of the host and two of the process follow."""

TOPICS = ("/parameter_events", "/rosout")
"""Nearly every node publishes both, so their publishers tell which participant a node is in."""

DISCOVERY_TOPIC = "ros_discovery_info"
"""The topic on which rmw announces a participant's nodes: each participant has one publisher."""


class ProbeError(Exception):
    """A condition that cannot be watched."""


class RosGraph:
    """The ROS graph as seen from one node; belongs to the main thread."""

    def __init__(self) -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        self._node: Node = rclpy.create_node(
            "_launch_probe",
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        hide_own_segments()
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._received: set[str] = set()
        self._subscribed: set[str] = set()

    def spin(self, timeout_s: float) -> None:
        """Process what has arrived, waiting up to `timeout_s` for it."""
        self._executor.spin_once(timeout_sec=timeout_s)

    def close(self) -> None:
        """Leave the graph."""
        from rclpy.utilities import try_shutdown

        self._executor.shutdown()
        self._node.destroy_node()
        try_shutdown()

    def has_topic(self, topic: str, type_name: str | None, first_message: bool) -> bool:
        """Return whether the topic has a publisher, or has delivered a message."""
        publishers = self._node.get_publishers_info_by_topic(topic)
        offered = [p for p in publishers if type_name in (None, p.topic_type)]
        if not offered or not first_message:
            return bool(offered)
        if topic not in self._subscribed:
            self._subscribe(topic, offered[0].topic_type, offered[0].qos_profile)
        return topic in self._received

    def census(self) -> dict[str, Any]:
        """Return the nodes and their processes; see `find_nodes`."""
        return find_nodes(self._node)

    def has_service(self, name: str) -> bool:
        """Return whether the service has a server."""
        return self._node.count_services(name) > 0

    def _subscribe(self, topic: str, type_name: str, offered: Any) -> None:
        from rclpy.qos import QoSProfile

        package, _, name = type_name.partition("/msg/")
        try:
            message_type = getattr(importlib.import_module(f"{package}.msg"), name)
        except (ImportError, AttributeError) as error:
            raise ProbeError(f"message type {type_name} of {topic} is not installed") from error
        # The publisher's own QoS always matches, and also delivers a latched message.
        profile = QoSProfile(
            depth=1, reliability=offered.reliability, durability=offered.durability
        )
        self._node.create_subscription(
            message_type, topic, lambda _: self._received.add(topic), profile, raw=True
        )
        self._subscribed.add(topic)


def find_nodes(observer: Node) -> dict[str, Any]:
    """Return the nodes that a node sees on the graph, as JSON-compatible data.

    Returns:
        {"nodes": {full name: [process, ...]}, "complete": bool}. A process is given by the low 16
        bits of its id, and is None if it is unknown or on another host. A name that several
        participants use has several processes. "complete" says whether every participant of this
        host has been found with its nodes.
    """
    prefixes: dict[str, set[bytes]] = {}
    for topic in TOPICS:
        for info in observer.get_publishers_info_by_topic(topic):
            name = _full_name(info.node_namespace, info.node_name)
            prefixes.setdefault(name, set()).add(_prefix(info.endpoint_gid))
    participants = {
        _prefix(info.endpoint_gid)
        for info in observer.get_publishers_info_by_topic(DISCOVERY_TOPIC, no_mangle=True)
    }
    own = _own_prefix(participants)
    nodes: dict[str, list[int | None]] = {}
    named: set[bytes] = set()
    for name, namespace in observer.get_node_names_and_namespaces():
        full = _full_name(namespace, name)
        holders = [_pid_bits(prefix, own) for prefix in prefixes.get(full, ())]
        nodes[full] = sorted(holders, key=lambda bits: bits or 0) or [None]
        named |= prefixes.get(full, set())
    ports = find_ports(domain_of(os.environ.get("ROS_DOMAIN_ID")) or 0)
    complete = len(participants) >= len(ports.indices) and participants <= named
    return {"nodes": dict(sorted(nodes.items())), "complete": complete}


def _full_name(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


def _prefix(gid: Iterable[int]) -> bytes:
    return bytes(gid)[:PREFIX_BYTES]


def _own_prefix(participants: Iterable[bytes]) -> bytes:
    own_bits = (os.getpid() & PID_BITS).to_bytes(2, "little")
    own = (p for p in participants if p.startswith(FAST_DDS) and p[4:6] == own_bits)
    return next(own, b"")


def _pid_bits(prefix: bytes, own: bytes) -> int | None:
    """Return the low bits of a participant's process id if it is on the host of `own`."""
    if not own or prefix[:4] != own[:4]:
        return None
    return int.from_bytes(prefix[4:6], "little")
