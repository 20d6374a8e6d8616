"""The probe process: watches topics, services, actions, nodes and web pages for the supervisor.

It reads one JSON object per line from standard input: an id, the kind of the condition (the class
name in `launch_py.plan.readiness`) and its fields. It writes {"id": n} when condition n is met, and
{"id": n, "error": text} when it can never be met. Kind "Forget" removes a condition. Kind "Nodes"
is never met: the probe writes {"id": n, "seen": nodes} whenever the nodes on the graph change; see
`find_nodes`. The probe exits at the end of its standard input.
"""

from __future__ import annotations

import importlib
import json
import os
import queue
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from launch_py.fast_dds.participants import PID_BITS, domain_of, find_ports
from launch_py.fast_dds.shared_memory import hide, segments_of
from launch_py.standard_streams import library_output_on_stderr

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
        hide(segments_of(lambda pid: pid == os.getpid()))
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


POLL_S = 0.02
HTTP_POLL_S = 0.1
HTTP_TIMEOUT_S = 2.0

Check = Callable[[], bool]


class Probe:
    """Checks the conditions that are not met yet; `run` is the main loop of the process."""

    def __init__(self, answer: Callable[[Mapping[str, Any]], None]) -> None:
        self._answer = answer
        self._checks: dict[int, Check] = {}
        self._graph: RosGraph | None = None

    def run(self, messages: queue.SimpleQueue[dict[str, Any] | None]) -> None:
        """Watch the conditions in `messages` until a None arrives."""
        try:
            while True:
                message = self._next_message(messages)
                if message is None:
                    return
                if message:
                    self._take(message)
                self._check_all()
        finally:
            if self._graph is not None:
                self._graph.close()

    def _next_message(
        self, messages: queue.SimpleQueue[dict[str, Any] | None]
    ) -> dict[str, Any] | None:
        """Return the next message, or {} after a short wait; block if nothing is being watched."""
        if self._graph is not None and self._checks:
            self._graph.spin(POLL_S)
        try:
            if not self._checks:
                return messages.get()
            return messages.get(timeout=0.0 if self._graph else POLL_S)
        except queue.Empty:
            return {}

    def _take(self, message: dict[str, Any]) -> None:
        number, kind = message["id"], message["kind"]
        if kind == "Forget":
            self._checks.pop(number, None)
            return
        try:
            self._checks[number] = self._make_check(number, kind, message)
        except (ImportError, ProbeError) as error:
            self._answer({"id": number, "error": f"cannot watch a {kind} condition: {error}"})

    def _make_check(self, number: int, kind: str, message: dict[str, Any]) -> Check:
        if kind == "HttpOk":
            return _HttpCheck(message["url"])
        if self._graph is None:
            self._graph = RosGraph()
        graph = self._graph
        match kind:
            case "TopicPublished":
                return lambda: graph.has_topic(
                    message["topic"], message["type"], message["first_message"]
                )
            case "ServiceAvailable":
                return lambda: graph.has_service(message["service"])
            case "ActionAvailable":
                return lambda: graph.has_service(f"{message['action']}/_action/send_goal")
            case "Nodes":
                return _NodesCheck(lambda seen: self._answer({"id": number, "seen": seen}), graph)
        raise ProbeError("there is no such condition")

    def _check_all(self) -> None:
        for number, check in list(self._checks.items()):
            try:
                if not check():
                    continue
                self._answer({"id": number})
            except ProbeError as error:
                self._answer({"id": number, "error": str(error)})
            self._checks.pop(number, None)


class _NodesCheck:
    """Reports the nodes on the graph whenever they change."""

    def __init__(self, report: Callable[[dict[str, Any]], None], graph: RosGraph) -> None:
        self._report = report
        self._graph = graph
        self._reported: dict[str, Any] | None = None

    def __call__(self) -> bool:
        """Look once; return False, because the nodes can always change again."""
        seen = self._graph.census()
        if seen != self._reported:
            self._reported = seen
            self._report(seen)
        return False


class _HttpCheck:
    """Checks whether a GET request to a URL returns status 200, in a thread of its own."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._met = threading.Event()
        threading.Thread(target=self._ask, daemon=True).start()

    def __call__(self) -> bool:
        """Return whether the status 200 has been returned."""
        return self._met.is_set()

    def _ask(self) -> None:
        import urllib.request

        pause = threading.Event()
        while True:
            try:
                with urllib.request.urlopen(self._url, timeout=HTTP_TIMEOUT_S) as response:
                    if response.status == 200:
                        self._met.set()
                        return
            except (OSError, ValueError):
                pass  # The server is not up yet, or returns an error.
            pause.wait(HTTP_POLL_S)


def main() -> None:
    """Run until standard input ends."""
    messages: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            messages.put(json.loads(line))
        messages.put(None)

    def answer(message: Mapping[str, Any]) -> None:
        sys.stdout.write(json.dumps(message) + "\n")
        sys.stdout.flush()

    threading.Thread(target=read, daemon=True).start()
    with library_output_on_stderr():
        Probe(answer).run(messages)
