"""Faults on demand over ROS: each is a context manager."""

import heapq
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from itertools import count
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters

from arm_gazebo.faults.fault import Fault
from arm_sim.bench.processes import LoggedProcess
from arm_sim.bench.ros_connection import RosConnection
from arm_sim.errors import BenchError
from arm_sim.faulty_link import FaultyLink, LinkFault
from arm_sim.injected_faults import InjectedFaults

SIMULATION = "arm_gazebo"


class RosFaults(InjectedFaults):
    """Faults of a launch; each lasts as long as its `with` block. The test's thread.

    Attributes:
        log: the faults so far.
        has_killed: whether a process was killed.
    """

    def __init__(
        self, connection: RosConnection, launch: LoggedProcess, now_s: Callable[[], float]
    ) -> None:
        """Take a launch, and the connection of a node in its domain."""
        super().__init__(
            now_s,
            lambda fault: self._set_injected([*self._present, fault]),
            lambda fault: self._set_injected([one for one in self._present if one != fault]),
        )
        self.has_killed = False
        self._connection = connection
        self._launch = launch
        self._present: list[Fault] = []

    @contextmanager
    def process_killed(self, name: str) -> Iterator[None]:
        """Kill a program of the launch; whether it is restarted is up to the launch.

        Args:
            name: the program's name, as in `RosBench.processes`.

        Raises:
            BenchError: there is none of that name.
        """
        pids = self._pids(name)
        self.has_killed = True
        with self.log.noted(f"{name} killed"):
            for pid in pids:
                os.kill(pid, signal.SIGKILL)
            yield

    @contextmanager
    def process_stopped(self, name: str) -> Iterator[None]:
        """Halt a program of the launch, as a debugger does; it continues after the block.

        Raises:
            BenchError: there is none of that name.
        """
        pids = self._pids(name)
        with self.log.noted(f"{name} stopped"), ExitStack() as ending:
            for pid in pids:
                os.kill(pid, signal.SIGSTOP)
                ending.callback(_go_on, pid)
            yield

    def camera_dark(self, topic: str, to: str) -> AbstractContextManager[None]:
        """Relay a camera's images as black ones.

        Args:
            topic: topic of the images.
            to: topic that the node under test listens to, by a remapping.
        """
        return self._relay("dark", topic, to, LinkFault(), _black)

    def messages_dropped(
        self, topic: str, to: str, fraction: float = 1.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Relay a topic, and lose messages.

        Args:
            topic: the topic that they come from.
            to: the topic that they go to, which the node under test uses by a remapping.
            fraction: fraction of lost messages, from 0 to 1.
            seed: seed of the random choice.
        """
        return self._relay("dropped", topic, to, LinkFault(lost=fraction, seed=seed))

    def messages_delayed(
        self, topic: str, to: str, by_s: float, jitter_s: float = 0.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Relay a topic, and deliver messages later, in wall time; see `messages_dropped`."""
        fault = LinkFault(delay_s=by_s, jitter_s=jitter_s, seed=seed)
        return self._relay("delayed", topic, to, fault)

    def messages_doubled(
        self, topic: str, to: str, fraction: float = 1.0, after_s: float = 0.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Relay a topic, and deliver messages twice; see `messages_dropped`."""
        fault = LinkFault(doubled=fraction, again_s=after_s, seed=seed)
        return self._relay("doubled", topic, to, fault)

    def _set_injected(self, faults: list[Fault]) -> None:
        texts = [fault.text for fault in faults]
        value = ParameterValue(type=ParameterType.PARAMETER_STRING_ARRAY, string_array_value=texts)
        request = SetParameters.Request(parameters=[Parameter(name="faults", value=value)])
        answer = self._connection.call(f"/{SIMULATION}/set_parameters", SetParameters, request)
        (result,) = answer.results
        if not result.successful:
            raise BenchError(result.reason)
        self._present = faults

    def _pids(self, name: str) -> list[int]:
        processes = self._launch.descendants()
        if name not in processes:
            raise BenchError(f"the launch has no program '{name}'; it has {', '.join(processes)}")
        return processes[name]

    @contextmanager
    def _relay(
        self,
        how: str,
        topic: str,
        to: str,
        fault: LinkFault,
        change: Callable[[Any], Any] | None = None,
    ) -> Iterator[None]:
        with self.log.noted(f"{topic} {how}"):
            relay = _Relay(self._connection, topic, to, FaultyLink(fault), change)
            try:
                yield
            finally:
                relay.close()


class _Relay:
    """Passes serialized messages from one topic to another, in a thread of its own."""

    def __init__(
        self,
        connection: RosConnection,
        topic: str,
        to: str,
        link: FaultyLink,
        change: Callable[[Any], Any] | None,
    ) -> None:
        self._link, self._change = link, change
        self._under_way: list[tuple[float, int, Any]] = []
        self._numbers = count()
        self._changed = threading.Condition()
        self._is_closed = False
        self._connection = connection
        kind = connection.type_of(topic)
        self._publisher = connection.run(lambda: connection.node.create_publisher(kind, to, 10), to)
        self._subscription = connection.run(
            lambda: connection.node.create_subscription(
                kind, topic, self._take, 10, raw=change is None
            ),
            topic,
        )
        self._thread = threading.Thread(target=self._deliver, name=f"relay of {topic}", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Deliver the delayed messages, and end."""
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()
        self._thread.join()
        node = self._connection.node
        self._connection.run(lambda: node.destroy_subscription(self._subscription), "relay")
        self._connection.run(lambda: node.destroy_publisher(self._publisher), "relay")

    def _take(self, message: Any) -> None:
        with self._changed:
            for delay_s in self._link.delays_s():
                item = (time.monotonic() + delay_s, next(self._numbers), message)
                heapq.heappush(self._under_way, item)
            self._changed.notify_all()

    def _deliver(self) -> None:
        while True:
            with self._changed:
                if not self._under_way:
                    if self._is_closed:
                        return
                    self._changed.wait()
                    continue
                due_s, _, message = self._under_way[0]
                left_s = due_s - time.monotonic()
                if left_s > 0 and not self._is_closed:
                    self._changed.wait(left_s)
                    continue
                heapq.heappop(self._under_way)
            self._publisher.publish(message if self._change is None else self._change(message))


def _black(image: Any) -> Any:
    image.data = bytes(len(image.data))
    return image


def _go_on(pid: int) -> None:
    # It may have ended in the meantime.
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGCONT)
