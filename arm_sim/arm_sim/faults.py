"""Faults on demand in the library: each is a context manager."""

import heapq
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from itertools import count
from typing import Any

from arm_gazebo.faults.injector import FaultInjector
from arm_gazebo.run.run import SimulationRun
from arm_sim.cameras import Camera
from arm_sim.controllers import ControllerHandle, Controllers
from arm_sim.faulty_link import FaultyLink, LinkFault
from arm_sim.injected_faults import InjectedFaults

TOLERANCE_S = 1e-9
"""Rounding error of a time that is a sum of periods."""


class SimulationFaults(InjectedFaults):
    """Faults of one simulation; each lasts as long as its `with` block. The simulation's thread.

    Attributes:
        log: the faults so far.
    """

    def __init__(
        self, run: SimulationRun, controllers: Controllers, find_camera: Callable[[str], Camera]
    ) -> None:
        injector = FaultInjector(run)
        super().__init__(lambda: run.physics.time_s, injector.begin, injector.end)
        self._run = run
        self._controllers = controllers
        self._find_camera = find_camera

    def messages_dropped(
        self, controller: str, fraction: float = 1.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Lose commands to a controller.

        Args:
            controller: its name.
            fraction: fraction of lost commands, from 0 to 1.
            seed: seed of the random choice.
        """
        return self._linked("dropped", controller, LinkFault(lost=fraction, seed=seed))

    def messages_delayed(
        self, controller: str, by_s: float, jitter_s: float = 0.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Deliver commands later; those still delayed at the end of the block arrive then.

        Args:
            controller: its name.
            by_s: how late, in simulated seconds.
            jitter_s: largest random additional delay; commands may overtake others.
            seed: seed of the random delays.
        """
        fault = LinkFault(delay_s=by_s, jitter_s=jitter_s, seed=seed)
        return self._linked("delayed", controller, fault)

    def messages_doubled(
        self, controller: str, fraction: float = 1.0, after_s: float = 0.0, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Deliver commands twice.

        Args:
            controller: its name.
            fraction: fraction of doubled commands, from 0 to 1.
            after_s: how long after the first copy the second arrives, in simulated seconds.
            seed: seed of the random choice.
        """
        fault = LinkFault(doubled=fraction, again_s=after_s, seed=seed)
        return self._linked("doubled", controller, fault)

    @contextmanager
    def camera_dark(self, name: str) -> Iterator[None]:
        """Cover a camera's lens: images are black, and all distances are too near."""
        camera = self._find_camera(name)
        with self.log.noted(f"{name} dark"):
            camera.is_dark = True
            try:
                yield
            finally:
                camera.is_dark = False

    @contextmanager
    def _linked(self, how: str, controller: str, fault: LinkFault) -> Iterator[None]:
        handle, run = self._controllers[controller], self._run
        line = _CommandLine(handle, FaultyLink(fault), lambda: run.physics.time_s)
        with self.log.noted(f"{controller} {how}"):
            run.tick.add_feed(line)
            try:
                yield
            finally:
                run.tick.remove_feed(line)
                line.close()


class _CommandLine:
    """Passes a program's commands to a controller, and delivers due ones after each tick."""

    def __init__(
        self, handle: ControllerHandle, link: FaultyLink, now_s: Callable[[], float]
    ) -> None:
        self._handle, self._link, self._now_s = handle, link, now_s
        self._behind = handle.deliver
        self._under_way: list[tuple[float, int, Sequence[float]]] = []
        self._numbers = count()
        handle.deliver = self._take

    def _take(self, values: Sequence[float]) -> None:
        for delay_s in self._link.delays_s():
            item = (self._now_s() + delay_s, next(self._numbers), tuple(values))
            heapq.heappush(self._under_way, item)
        self._deliver(self._now_s())

    def publish_due(self, time_s: float, data: Any) -> None:
        """Deliver the commands that are due before the next tick."""
        self._deliver(time_s)

    def close(self) -> None:
        """Deliver the remaining commands, and connect program and controller directly again."""
        self._deliver(float("inf"))
        self._handle.deliver = self._behind

    def _deliver(self, time_s: float) -> None:
        while self._under_way and self._under_way[0][0] <= time_s + TOLERANCE_S:
            _, _, values = heapq.heappop(self._under_way)
            # A controller that has stopped in the meantime takes no commands.
            if self._handle.is_active:
                self._behind(values)
