"""The thread that talks to an arm, so that the control loop never waits for bytes."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future

import numpy as np
from numpy.typing import NDArray

from arm_control.loop.clock import Throttle
from arm_drivers.arm_device import ArmDevice, ArmReading
from arm_drivers.errors import DriverError
from arm_drivers.goals import GoalTracker

CALL_TIMEOUT_S = 5.0
REMINDER_INTERVAL_S = 1.0
JUMP_RAD = 0.05
"""What a reading may differ from the one before, beside what the joint can move meanwhile."""
PUSHED_RAD = 0.2
"""A joint this far from a goal that stands still is pushed, blocked or too weak."""


class ExchangeThread:
    """Exchanges goals and readings with an arm each time the control loop asks for it.

    The loop sets goals and takes the latest reading without waiting. If the loop no longer asks,
    the arm stops where it is. After a failure the arm is told to stay where it was last seen.

    Any thread may call the methods.

    Attributes:
        failure: why the arm is no longer in use; empty while it works.
        exchanges: exchanges so far.
        latest: the last good values of each joint.
        missed: shape (n,), how often each joint did not report.
    """

    def __init__(
        self,
        device: ArmDevice,
        goals: GoalTracker,
        logger: logging.Logger,
        *,
        max_missed: int,
        watchdog_s: float,
    ) -> None:
        """Take the first reading; `start` starts the thread, which owns the device from then on.

        Args:
            device: the arm.
            goals: turns commands into goals for it.
            logger: where it says what happens.
            max_missed: exchanges in a row that a joint may miss, or have an alarm.
            watchdog_s: how long the loop may leave a powered arm without commands.

        Raises:
            DriverError: the arm does not report all of its joints.
        """
        self._device = device
        self._goals = goals
        self._logger = logger
        self._max_missed = max_missed
        self._watchdog_s = watchdog_s
        self._calls: deque[tuple[Callable[[], None], Future[None]]] = deque()
        self._asked = threading.Event()
        self._stopping = False
        self._engaged = False
        self._reminder = Throttle(REMINDER_INTERVAL_S)
        self._alarmed = 0
        self._pushed = ""
        self.failure = ""
        self.exchanges = 0
        count = len(device.names)
        self.missed = np.zeros(count, int)
        self._missed_in_a_row = np.zeros(count, int)
        self._reported_s = np.full(count, goals.now_s())
        unknown = np.full(count, np.nan)
        self.latest = ArmReading(unknown, unknown, unknown)
        self._read_all()
        self._thread = threading.Thread(target=self._run, name="arm exchange", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def ask(self) -> None:
        """Ask for an exchange; without waiting."""
        self._asked.set()

    def engage(self) -> None:
        """Power on and hold the measured positions; wait until that is done.

        Raises:
            DriverError: the arm refuses, or does not answer.
        """
        self._call(self._engage)

    def disengage(self, *, release: bool) -> None:
        """Hold where the arm is, or power off; wait until that is done.

        Raises:
            DriverError: the arm refuses, or does not answer.
        """
        self._call(self._release if release else self._hold)

    def stop(self) -> None:
        """End the thread, and close the port; the arm does what it was told last."""
        self._stopping = True
        self._asked.set()
        self._thread.join(CALL_TIMEOUT_S)

    def _call(self, function: Callable[[], None]) -> None:
        future: Future[None] = Future()
        self._calls.append((function, future))
        self._asked.set()
        try:
            future.result(CALL_TIMEOUT_S)
        except TimeoutError:
            raise DriverError(f"the arm did not answer within {CALL_TIMEOUT_S:g} s") from None

    # The thread

    def _run(self) -> None:
        while not self._stopping:
            asked = self._asked.wait(self._watchdog_s if self._engaged else None)
            self._asked.clear()
            while self._calls:
                self._serve(*self._calls.popleft())
            if self._stopping or self.failure:
                continue
            try:
                if not asked:
                    self._logger.warning(
                        "no command for %g s: the arm holds where it is", self._watchdog_s
                    )
                    self._goals.hold(self.latest.positions)
                self.exchange()
            except DriverError as error:
                self._fail(str(error))
        self._device.close()

    def _serve(self, function: Callable[[], None], future: "Future[None]") -> None:
        try:
            function()
        except DriverError as error:
            future.set_exception(error)
        else:
            future.set_result(None)

    def _engage(self) -> None:
        self._read_all()
        self._device.engage(self.latest.positions)
        self._goals.hold(self.latest.positions)
        self._engaged = True

    def _read_all(self) -> None:
        """Read until each joint has reported, a few times at most."""
        reported = np.zeros(len(self._device.names), bool)
        for _ in range(self._max_missed):
            reading = self._device.exchange(None)
            self._merge(reading)
            reported |= ~np.isnan(reading.positions)
            if reported.all():
                return
        raise DriverError(self._describe_missing(~reported))

    def _hold(self) -> None:
        if self._engaged and not self.failure:
            self._device.exchange(self.latest.positions)
        self._engaged = False

    def _release(self) -> None:
        self._engaged = False
        if not self.failure:
            self._device.release()

    def exchange(self) -> None:
        """Exchange once; only the thread itself calls it, once it has started."""
        goals = self._goals.advance() if self._engaged else None
        for sentence in self._goals.remarks():
            self._logger.warning("%s", sentence)
        self._merge(self._device.exchange(goals))
        self.exchanges += 1
        if (self._missed_in_a_row >= self._max_missed).any():
            self._fail(self._describe_missing(self._missed_in_a_row >= self._max_missed))
        elif self._alarmed >= self._max_missed:
            self._fail("; ".join(self.latest.alarms))
        elif self._missed_in_a_row.any() and self._reminder.permits():
            self._logger.warning(
                "%s; the last good values are kept",
                self._describe_missing(self._missed_in_a_row > 0),
            )
        if goals is not None:
            self._watch_for_push(goals)

    def _merge(self, reading: ArmReading) -> None:
        latest = self.latest
        now_s = self._goals.now_s()
        # Damage that no checksum shows is a jump that no joint can make in the time.
        reach = self._device.max_speed * (now_s - self._reported_s) + JUMP_RAD
        far = np.abs(reading.positions - latest.positions) > reach
        reported = ~np.isnan(reading.positions) & ~far
        self._reported_s = np.where(reported, now_s, self._reported_s)
        self._missed_in_a_row = np.where(reported, 0, self._missed_in_a_row + 1)
        self.missed = self.missed + ~reported
        self._alarmed = self._alarmed + 1 if reading.alarms else 0
        # One object replaces the other, so that readers need no lock.
        self.latest = ArmReading(
            np.where(reported, reading.positions, latest.positions),
            np.where(reported, reading.velocities, latest.velocities),
            np.where(reported, reading.efforts, latest.efforts),
            reading.alarms,
        )

    def _fail(self, sentence: str) -> None:
        if self._engaged:
            try:
                self._device.exchange(self.latest.positions)
            except DriverError:
                # The port has gone: the arm holds its last goal, at most one exchange away.
                self._logger.debug("the arm could not be told to hold")
        self._engaged = False
        self.failure = sentence

    def _watch_for_push(self, goals: NDArray[np.float64]) -> None:
        off = np.abs(goals - self.latest.positions)
        place = int(np.argmax(off))
        name = self._device.names[place] if self._goals.rests and off[place] > PUSHED_RAD else ""
        if name and name != self._pushed:
            self._logger.warning(
                "%s is %.2f rad from where it is held: it is pushed, blocked or too weak",
                name,
                off[place],
            )
        self._pushed = name

    def _describe_missing(self, missing: NDArray[np.bool_]) -> str:
        places = np.flatnonzero(missing).tolist()
        names = ", ".join(self._device.names[place] for place in places)
        names = "the arm" if len(places) == len(missing) else names
        counts = int(self.missed[missing].sum())
        return f"{names} did not answer ({counts} replies missed of {self.exchanges + 1} exchanges)"
