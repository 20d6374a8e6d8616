"""The hardware plugin of an arm on a serial port, whatever its protocol.

A thread of its own talks to the arm; `read` takes its latest reading and `write` leaves commands
for it, so the control loop never waits for bytes.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Generic

import numpy as np

from arm_control.errors import HardwareInfoError
from arm_control.hardware.driver import HardwareHealth, HardwareReturn, SystemInterface
from arm_control.hardware.info import HardwareInfo, JointInfo
from arm_drivers.arm_device import ArmDevice
from arm_drivers.errors import DriverError
from arm_drivers.exchange_thread import ExchangeThread
from arm_drivers.goals import GoalTracker
from arm_drivers.serial_line import SerialLine
from arm_drivers.settings import SettingsT, read_hardware_settings

UNTRIED = (
    "this driver was tested on emulated devices only, never on a real arm: "
    "keep a hand on the power switch"
)
IGNORED_COMMANDS = ("max_effort",)
"""Command interfaces that may be claimed and have no effect here."""
KINDS = ("position", "velocity", "effort")


class SerialArm(SystemInterface, Generic[SettingsT]):
    """An arm on a serial port; a protocol derives from it and opens the device.

    Attributes:
        settings: the component's parameters.
        driven: the joints that the arm drives, in the order of the description.
        thread: talks to the arm; None while the component is unconfigured.
    """

    settings_type: type[SettingsT]

    def __init__(self, info: HardwareInfo) -> None:
        """Read the settings.

        Raises:
            HardwareInfoError: a parameter is invalid, or no joint can be driven.
        """
        super().__init__(info)
        self.settings = read_hardware_settings(self.settings_type, info)
        self.driven = tuple(
            joint
            for joint in info.joints
            if joint.mimic is None and "position" in {c.name for c in joint.command_interfaces}
        )
        if not self.driven:
            raise HardwareInfoError(
                f"hardware component '{info.name}' has no joint with a position command"
            )
        self.thread: ExchangeThread | None = None
        self._goals: GoalTracker | None = None
        self._state_sources = self._place_states()
        names = [f"{joint.name}/position" for joint in self.driven]
        self._command_places = np.array([self.command_interfaces.index(name) for name in names])
        self._is_active = False
        self._problem = ""

    @abstractmethod
    def open_device(self) -> ArmDevice:
        """Open the port; each of `driven` is a joint of the device.

        Raises:
            DriverError: it cannot be opened.
        """

    def on_configure(self) -> bool:
        """Open the port, check the arm and read it once; it does not move."""
        device: ArmDevice | None = None
        self.logger.warning("%s", UNTRIED)
        settings = self.settings
        try:
            device = self.open_device()
            device.start()
            self._goals = GoalTracker(
                device.names, device.lower, device.upper, settings.max_velocity, SerialLine.now_s
            )
            self.thread = ExchangeThread(
                device,
                self._goals,
                self.logger,
                max_missed=settings.max_missed,
                watchdog_s=settings.watchdog_s,
            )
        except DriverError as error:
            self._report(str(error))
            if device is not None:
                device.close()
            return False
        self._problem = ""
        self.thread.start()
        self._take_reading(self.thread)
        return True

    def on_activate(self) -> bool:
        """Hold the measured positions with the power on; a passive arm is let go."""
        thread = self.thread
        if thread is None:
            return False
        passive = self.settings.passive
        if not self._tried((lambda: thread.disengage(release=True)) if passive else thread.engage):
            return False
        self._is_active = True
        self._take_reading(thread)
        return True

    def on_deactivate(self) -> bool:
        """Stay powered and hold where the arm is."""
        self._is_active = False
        thread = self.thread
        return thread is None or self._tried(lambda: thread.disengage(release=False))

    def on_cleanup(self) -> bool:
        """Close the port; the arm holds where it is, also after a failure."""
        self._is_active = False
        if self.thread is not None:
            self.thread.stop()
            self.thread = self._goals = None
        return True

    def on_shutdown(self) -> bool:
        """Hold or release the arm, as `at_end` says, and close the port."""
        thread = self.thread
        release = self.settings.at_end == "release"
        done = thread is None or self._tried(lambda: thread.disengage(release=release))
        return self.on_cleanup() and done

    def set_emergency_stop(self, engaged: bool) -> None:
        """Hold the measured positions; or obey again, from where the arm is."""
        if self.thread is None or self._goals is None:
            return
        positions = self.thread.latest.positions
        self._goals.set_stopped(engaged, positions)
        if not engaged:
            self.commands[self._command_places] = positions

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Refuse commands of velocity and effort, which these arms do not take."""
        refused = [
            name for name in start if name.rpartition("/")[2] not in ("position", *IGNORED_COMMANDS)
        ]
        if refused:
            self.logger.error("%s cannot be commanded; this arm takes positions", refused[0])
        return not refused

    def health(self) -> HardwareHealth:
        """Return why the arm failed, or what its servos report now; see `SelfDiagnosing`."""
        thread = self.thread
        if thread is None:
            return HardwareHealth(self._problem)
        missed = dict(zip((joint.name for joint in self.driven), thread.missed, strict=True))
        counts = {f"{name}.missed_replies": str(count) for name, count in missed.items()}
        return HardwareHealth(
            self._problem or "; ".join(thread.latest.alarms),
            {"exchanges": str(thread.exchanges), **counts},
        )

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Take the latest reading; ERROR once the arm has failed."""
        thread = self.thread
        if thread is None:
            return HardwareReturn.ERROR
        if thread.failure:
            self._report(thread.failure)
            return HardwareReturn.ERROR
        self._take_reading(thread)
        if not self._is_active:
            thread.ask()
        return HardwareReturn.OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Leave the commands for the thread."""
        if self.thread is None or self._goals is None:
            return HardwareReturn.ERROR
        self._goals.command(self.commands[self._command_places])
        self.thread.ask()
        return HardwareReturn.OK

    def _take_reading(self, thread: ExchangeThread) -> None:
        reading = thread.latest
        values = np.concatenate((reading.positions, reading.velocities, reading.efforts))
        for place, (source, multiplier, offset) in enumerate(self._state_sources):
            self.states[place] = np.nan if source < 0 else values[source] * multiplier + offset

    def _place_states(self) -> list[tuple[int, float, float]]:
        """Return for each state its place among the device's values, a multiplier and an offset.

        A joint that mimics another is computed from it. A place of -1 is a state without a value.
        """
        places = {joint.name: place for place, joint in enumerate(self.driven)}
        sources: list[tuple[int, float, float]] = []
        for joint in (*self.info.joints, *self.info.sensors, *self.info.gpios):
            for state in joint.state_interfaces:
                sources.append(_source(joint, state.name, places))
        return sources

    def _tried(self, action: Callable[[], None]) -> bool:
        try:
            action()
        except DriverError as error:
            self._report(str(error))
            return False
        self._problem = ""
        return True

    def _report(self, problem: str) -> None:
        """Log why the arm cannot be used; `health` tells it until the arm obeys again."""
        self._problem = problem
        self.logger.error("%s", problem)


def _source(joint: JointInfo, kind: str, places: Mapping[str, int]) -> tuple[int, float, float]:
    leader = joint.name if joint.mimic is None else joint.mimic.joint
    if kind not in KINDS or leader not in places:
        return -1, 0.0, 0.0
    place = KINDS.index(kind) * len(places) + places[leader]
    if joint.mimic is None:
        return place, 1.0, 0.0
    offset = joint.mimic.offset if kind == "position" else 0.0
    return place, joint.mimic.multiplier, offset
