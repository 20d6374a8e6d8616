"""The probe process: watches topics, services, actions, nodes and web pages for the supervisor.

It reads one JSON object per line from standard input: an id, the kind of the condition (the class
name in `launch_py.plan.readiness`) and its fields. It writes {"id": n} when condition n is met, and
{"id": n, "error": text} when it can never be met. Kind "Forget" removes a condition. Kind "Nodes"
is never met: the probe writes {"id": n, "seen": nodes} whenever the nodes on the graph change; see
`find_nodes`. The probe exits at the end of its standard input.
"""

from __future__ import annotations

import json
import queue
import sys
import threading
from collections.abc import Callable, Mapping
from typing import Any

from launch_py.ros.graph import ProbeError, RosGraph
from launch_py.standard_streams import library_output_on_stderr

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
