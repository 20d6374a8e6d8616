"""Names on the ROS graph, told by a process of this user that has discovered them already.

Discovery takes half a second, which is too long for the Tab key. So `robot_state_publisher`, which
every robot has, tells the names that it knows to each process of its user that asks. It listens on
a socket in the abstract namespace of unix(7), which needs no file, ends with the process, and is
limited to the network namespace, like discovery. An answer is all names as JSON; there is no
request.
"""

import json
import logging
import os
import socket
import struct
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING
from zlib import crc32

from arm_node.frozen import frozen
from arm_node.workarounds.local_profile import RANGE, STATIC_PEERS, use_general_profile

if TYPE_CHECKING:
    from rclpy.node import Node

LISTEN_AFTER_S = 2.0
"""A process has discovered the others by this time after its start."""
ANSWER_TIMEOUT_S = 0.2
RETRY_S = 0.1
DEFAULT_RANGE = "SUBNET"
"""The range of a process whose environment names none."""
SOCKETS = "/proc/net/unix"
_CREDENTIALS = struct.Struct("3i")
"""Process, user and group of the peer; see SO_PEERCRED in unix(7)."""

logger = logging.getLogger(__name__)


@frozen
class GraphNames:
    """All names on the graph, hidden ones included.

    Attributes:
        topics: the topics, those of actions included.
        services: the services, those of actions included.
        nodes: the full names of the nodes.
    """

    topics: list[str]
    services: list[str]
    nodes: list[str]

    @property
    def actions(self) -> list[str]:
        """The actions; each has a topic for its feedback."""
        suffix = "/_action/feedback"
        return [name.removesuffix(suffix) for name in self.topics if name.endswith(suffix)]


@contextmanager
def telling_names(node: "Node") -> Iterator[None]:
    """Tell this user's processes the names that a node knows, in a thread until the end of `with`.

    Another thread spins the node.
    """
    stop = threading.Event()
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as server:
        thread = threading.Thread(
            target=_tell, args=(server, node, stop), name="graph names", daemon=True
        )
        try:
            server.bind(f"\0{_socket_name(os.environ)}")
            thread.start()
        except OSError as error:
            logger.info("Tab discovers the names of the graph itself: %s", error)
        try:
            yield
        finally:
            stop.set()
            with suppress(OSError):  # It does not listen yet, or not at all.
                server.shutdown(socket.SHUT_RDWR)
            if thread.ident is not None:
                thread.join()


def ask_for_names(environ: Mapping[str, str], sockets: str = SOCKETS) -> GraphNames | None:
    """Return the names from a process in the same domain, or None if none answers.

    The names are those that this process discovers. A caller with another discovery range gets
    none; one without a range of its own gets all.
    """
    wanted = _socket_prefix(environ)
    if environ.get(RANGE) or environ.get(STATIC_PEERS):
        wanted += _reach(environ)
    for name in _socket_names(sockets):
        if name.startswith(wanted):
            with suppress(OSError, ValueError, TypeError):
                return _ask(f"\0{name}")
    return None


def _tell(server: socket.socket, node: "Node", stop: threading.Event) -> None:
    if stop.wait(LISTEN_AFTER_S):
        return
    server.listen()
    while not stop.is_set():
        try:
            with server.accept()[0] as connection:
                connection.settimeout(ANSWER_TIMEOUT_S)
                if _user_of_peer(connection) == os.geteuid():
                    connection.sendall(json.dumps(_names(node)).encode())
        except OSError:
            # The caller has gone, this process has no file descriptor left, or it is the end.
            stop.wait(RETRY_S)


def _names(node: "Node") -> dict[str, list[str]]:
    nodes = node.get_node_names_and_namespaces()
    return {
        "topics": sorted(name for name, _ in node.get_topic_names_and_types()),
        "services": sorted(name for name, _ in node.get_service_names_and_types()),
        "nodes": sorted({f"{namespace.rstrip('/')}/{name}" for name, namespace in nodes}),
    }


def _ask(address: str) -> GraphNames:
    """Return the answer.

    Raises:
        OSError: there is no answer in time, or from another user.
        ValueError, TypeError: the answer is not valid.
    """
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
        client.settimeout(ANSWER_TIMEOUT_S)
        client.connect(address)
        if _user_of_peer(client) != os.geteuid():
            raise PermissionError(f"{address!r} belongs to another user")
        with client.makefile("rb") as answer:
            return GraphNames(**json.loads(answer.read()))


def _user_of_peer(connection: socket.socket) -> int:
    size = _CREDENTIALS.size
    packed = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, size)
    return _CREDENTIALS.unpack(packed)[1]


def _socket_names(sockets: str) -> list[str]:
    """Return the names in the abstract namespace, which start with "@"; see proc_net_unix(5)."""
    with suppress(OSError), open(sockets, encoding="utf-8", errors="replace") as file:
        return [line.rstrip("\n").partition(" @")[2] for line in file]
    return []


def _socket_name(environ: Mapping[str, str]) -> str:
    """Return a new name for the socket of a process in this environment."""
    declared = dict(environ)
    use_general_profile(declared)
    return f"{_socket_prefix(declared)}{_reach(declared)}{os.urandom(8).hex()}"


def _socket_prefix(environ: Mapping[str, str]) -> str:
    return f"arm_suite_graph:{environ.get('ROS_DOMAIN_ID') or 0}:"


def _reach(environ: Mapping[str, str]) -> str:
    """Return a word for the hosts that a process in this environment discovers."""
    hosts = f"{environ.get(RANGE) or DEFAULT_RANGE} {environ.get(STATIC_PEERS, '')}"
    return f"{crc32(hosts.encode()):08x}:"
