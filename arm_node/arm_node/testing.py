"""What tests with nodes in several processes need."""

import time
from typing import Any

from rclpy.node import Node
from type_description_interfaces.srv import GetTypeDescription

ASK_AGAIN_S = 0.5
NO_TYPE_HASH = f"RIHS01_{0:064}"
"""Well-formed, so that nobody complains of it in the log."""
PROCESS_BYTES = 12
"""So much of an end point's gid names its participant (DDSI-RTPS 2.5, 9.3.1)."""


class Acquaintance:
    """Tells whether the processes that read a topic know of all that a node has.

    What is sent before that may be lost, best-effort messages and answers alike. A process hears of
    another's end points in their order: one who answers a client knows all that was made before
    that client. Every node answers for its process, by `get_type_description`.

    Make one when the node has all that matters, and look at `complete` until it is true, while an
    executor spins the node.
    """

    def __init__(self, node: Node, topic: str, no_mangle: bool = False) -> None:
        """Ask whoever reads the topic.

        Args:
            node: whose end points are to be known.
            topic: fully qualified.
            no_mangle: whether the topic is named as DDS has it.
        """
        self._node = node
        self._topic = topic
        self._no_mangle = no_mangle
        self._questions: dict[bytes, _Question] = {}

    @classmethod
    def with_server(cls, node: Node, service: str) -> "Acquaintance":
        """Ask whoever serves a service, by its fully qualified name."""
        return cls(node, f"rq{service}Request", no_mangle=True)

    @property
    def complete(self) -> bool:
        """Whether there are readers, and the processes of all have answered; asks them, too."""
        readers = self._node.get_subscriptions_info_by_topic(self._topic, self._no_mangle)
        processes = {bytes(reader.endpoint_gid)[:PROCESS_BYTES]: reader for reader in readers}
        answered = [self._answered(process, reader) for process, reader in processes.items()]
        return bool(answered) and all(answered)

    def close(self) -> None:
        """Destroy its clients; where the executor spins, on its thread."""
        for question in self._questions.values():
            self._node.destroy_client(question.client)
        self._questions.clear()

    def _answered(self, process: bytes, reader: Any) -> bool:
        if process not in self._questions:
            if "UNKNOWN" in reader.node_name:
                return False  # Its name comes by a topic of its own, later.
            name = f"{reader.node_namespace.rstrip('/')}/{reader.node_name}/get_type_description"
            self._questions[process] = _Question(self._node.create_client(GetTypeDescription, name))
        return self._questions[process].answered()


class _Question:
    """Put again and again, for an answer may be lost, too."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self._future: Any = None
        self._asked_s = 0.0

    def answered(self) -> bool:
        if self._future is not None and self._future.done():
            return True
        now_s = time.monotonic()
        if now_s - self._asked_s > ASK_AGAIN_S and self.client.service_is_ready():
            if self._future is not None:
                self.client.remove_pending_request(self._future)
            request = GetTypeDescription.Request(type_hash=NO_TYPE_HASH)
            self._future = self.client.call_async(request)
            self._asked_s = now_s
        return False
