"""Helpers for tests with nodes in several processes."""

import time
from typing import Any

from rclpy.node import Node
from type_description_interfaces.srv import GetTypeDescription

ASK_AGAIN_S = 0.5
NO_TYPE_HASH = f"RIHS01_{0:064}"
"""A well-formed hash, so that nodes do not log an error about it."""
PROCESS_BYTES = 12
"""How many bytes of an end point's gid identify its participant (DDSI-RTPS 2.5, 9.3.1)."""


class DiscoveryCheck:
    """Tells whether discovery is complete: the readers of a topic know all end points of a node.

    Messages and answers that are sent earlier may be lost, even with reliable QoS. A process
    discovers another's end points in the order of their creation: if it answers a client, it knows
    everything created before that client. Every node answers for its process, by
    `get_type_description`.

    Create a check after the node's end points, and poll `complete` until it is true, while an
    executor spins the node.
    """

    def __init__(self, node: Node, topic: str, no_mangle: bool = False) -> None:
        """Ask the subscribers of a topic.

        `no_mangle` says that the topic is given by its DDS name.
        """
        self._node = node
        self._topic = topic
        self._no_mangle = no_mangle
        self._queries: dict[bytes, _Query] = {}

    @classmethod
    def with_server(cls, node: Node, service: str) -> "DiscoveryCheck":
        """Ask the server of a service, by its fully qualified name."""
        return cls(node, f"rq{service}Request", no_mangle=True)

    @property
    def complete(self) -> bool:
        """Whether there are subscribers and all their processes have answered; also asks them."""
        readers = self._node.get_subscriptions_info_by_topic(self._topic, self._no_mangle)
        processes = {bytes(reader.endpoint_gid)[:PROCESS_BYTES]: reader for reader in readers}
        answered = [self._answered(process, reader) for process, reader in processes.items()]
        return bool(answered) and all(answered)

    def close(self) -> None:
        """Destroy its clients; if the executor spins, call it on its thread."""
        for query in self._queries.values():
            self._node.destroy_client(query.client)
        self._queries.clear()

    def __str__(self) -> str:
        """Say what is still missing, for a test that fails."""
        waiting = [query for query in self._queries.values() if not query.is_answered]
        if not waiting:
            return f"known to those behind {self._topic}, which has no reader with a name"
        return f"known to those behind {self._topic}: {', '.join(map(str, waiting))}"

    def _answered(self, process: bytes, reader: Any) -> bool:
        if process not in self._queries:
            if "UNKNOWN" in reader.node_name:
                return False  # Its name arrives later, on another topic.
            name = f"{reader.node_namespace.rstrip('/')}/{reader.node_name}/get_type_description"
            self._queries[process] = _Query(self._node.create_client(GetTypeDescription, name))
        return self._queries[process].answered()


class _Query:
    """A request that is repeated, because its answer may be lost as well.

    An answer to any of them counts: on a busy machine each may come later than the next request.
    """

    def __init__(self, client: Any) -> None:
        self.client = client
        self._futures: list[Any] = []
        self._asked_s = 0.0

    def __str__(self) -> str:
        there = "there" if self.client.service_is_ready() else "not there"
        return f"{self.client.srv_name} is {there}, {len(self._futures)} requests unanswered"

    @property
    def is_answered(self) -> bool:
        return any(future.done() for future in self._futures)

    def answered(self) -> bool:
        """Return whether there was an answer; ask again now and then."""
        if self.is_answered:
            return True
        now_s = time.monotonic()
        if now_s - self._asked_s > ASK_AGAIN_S and self.client.service_is_ready():
            request = GetTypeDescription.Request(type_hash=NO_TYPE_HASH)
            self._futures.append(self.client.call_async(request))
            self._asked_s = now_s
        return False
