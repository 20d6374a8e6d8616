"""Sends states of the simulation to the window process, at the rate of a screen."""

import math
import time
from collections.abc import Callable

import mujoco

from arm_gazebo.feed.state_feed import PreparedModel, StateFeed
from arm_gazebo.window.process import WindowProcess

INTERVAL_S = 1 / 60
"""Wall time between two states; a screen shows no more."""


class WindowFeed:
    """The simulation's side of its window, which is a separate process.

    Call `start`, then `publish_due` at each tick and `supervise` about once a second, and finally
    `close`.
    """

    def __init__(
        self,
        process: WindowProcess | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Prepare without starting the process; `close` is required afterwards.

        Args:
            process: runs the child; by default on the display that the environment names.
            clock: wall time in s.
        """
        self._process = process or WindowProcess()
        self._feed = StateFeed(self._process)
        self._clock = clock
        self._sent_s = -math.inf

    def start(self, model: mujoco.MjModel) -> None:
        """Open the window on a model; see `StateFeed.start` about the thread.

        Raises:
            CameraError: the model's state is too large to send.
        """
        self._feed.start()
        self._feed.set_model(model)

    def prepare(self, model: mujoco.MjModel) -> PreparedModel:
        """Return a model to show later; see `StateFeed.prepare`."""
        return self._feed.prepare(model)

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Send the state if the last one is old enough. Loop thread only; never waits.

        Args:
            time_s: simulation time of the state.
            data: the state.
        """
        now_s = self._clock()
        if self._feed.flowing and now_s - self._sent_s >= INTERVAL_S:
            self._sent_s = now_s
            self._feed.send(time_s, (), data)

    def supervise(self) -> None:
        """Check whether the window still exists; stop sending if it does not."""
        self._feed.supervise()
        if self._process.pid is None:
            self._feed.close()

    def close(self) -> None:
        """Close the window and wait some seconds at most for its end. Idempotent; any thread."""
        self._feed.close()
