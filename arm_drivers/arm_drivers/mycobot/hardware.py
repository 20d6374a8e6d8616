"""arm_drivers/MyCobot280: a myCobot 280 behind its serial protocol, which has no checksum.

So each reply must have the right command and length, and each angle must be one that the arm can
have; the driver also drops jumps. No relative move is ever sent: one whose reply is lost would be
sent twice.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo
from arm_drivers.arm_device import ArmReading
from arm_drivers.errors import DeviceError, ReplyError
from arm_drivers.mycobot.frames import (
    AROUND_DATA,
    JOINTS,
    REPLY_SIZES,
    MyCobotCommand,
    angles_of,
    angles_request,
    reply_data,
    request,
)
from arm_drivers.serial_arm import SerialArm
from arm_drivers.serial_line import SerialLine
from arm_drivers.settings import MyCobotSettings

LIMITS = np.radians([(-168, 168), (-140, 140), (-150, 150), (-150, 150), (-155, 160), (-180, 180)])
"""What the arm itself accepts, in rad, shape (6, 2)."""
BEYOND_LIMITS = math.radians(3.0)
"""How far outside its limits a joint may be read."""
MAX_SPEED = math.radians(250.0)
"""rad/s that no joint exceeds; the maker names 160 degrees per second."""
READS = 3
GRIPPER_EVERY = 5
ERROR_EVERY = 10
"""The gripper and the error are read once in so many exchanges."""
GRIPPER_SPEED = 80
COLLISIONS = range(16, 20)


class MyCobotArm:
    """See `arm_drivers.arm_device.ArmDevice`."""

    def __init__(
        self,
        line: SerialLine,
        names: Sequence[str],
        gripper: tuple[float, float] | None,
        reply_timeout_s: float,
        speed: int,
    ) -> None:
        """Use an open line.

        Args:
            line: the serial line.
            names: of the six joints, and of the gripper if there is one.
            gripper: closed and open position of the gripper's joint; None for no gripper.
            reply_timeout_s: how long a reply may take beside the time on the wire.
            speed: of the arm's own motion, from 1 to 100.
        """
        self._line = line
        self._gripper = gripper
        self._reply_timeout_s = reply_timeout_s
        self._speed = speed
        self._missed_last = False
        self._exchanges = 0
        self._gripper_position = self._gripper_goal = math.nan
        self._error = 0
        self._last: tuple[float, NDArray[np.float64]] | None = None
        limits = LIMITS if gripper is None else np.vstack((LIMITS, sorted(gripper)))
        self.names: Sequence[str] = tuple(names)
        self.lower = limits[:, 0]
        self.upper = limits[:, 1]
        self.max_speed = MAX_SPEED

    def start(self) -> None:
        """Check that a myCobot answers with angles that it can have; see `ArmDevice`."""
        try:
            data = self._read(MyCobotCommand.READ_ANGLES)
        except ReplyError as error:
            raise DeviceError(
                f"no myCobot answers on {self._line.port} at {self._line.baud} baud: check its "
                "power, the port, and the baud rate, 115200 for the M5 and 1000000 for the Pi"
            ) from error
        angles = np.array(angles_of(data))
        for place in np.flatnonzero(self._impossible(angles)).tolist():
            low, high = np.degrees(LIMITS[place])
            raise DeviceError(
                f"{self.names[place]} is read at {math.degrees(angles[place]):.1f} degrees; a "
                f"myCobot 280 turns from {low:.0f} to {high:.0f}: is it another arm?"
            )
        if self._gripper is not None:
            self._read_gripper(self._gripper)

    def engage(self, positions: NDArray[np.float64]) -> None:
        """Power on and make the measured positions the goals; see `ArmDevice`."""
        # The newest goal counts, instead of a queue of all.
        self._line.send(request(MyCobotCommand.SET_FRESH_MODE, b"\x01"))
        self._send(positions)
        if self._read(MyCobotCommand.IS_POWERED) != b"\x01":
            self._line.send(request(MyCobotCommand.POWER_ON))
            if self._read(MyCobotCommand.IS_POWERED) != b"\x01":
                raise DeviceError("the myCobot does not power on: is its emergency stop pressed?")
        self._send(positions)

    def release(self) -> None:
        """Let go of all joints; see `ArmDevice`."""
        self._line.send(request(MyCobotCommand.RELEASE))

    def exchange(self, goals: NDArray[np.float64] | None) -> ArmReading:
        """Send goals and read; see `ArmDevice`."""
        self._exchanges += 1
        if goals is not None:
            self._send(goals)
        data = self._ask(MyCobotCommand.READ_ANGLES)
        unknown = np.full(len(self.names), np.nan)
        if data is None:
            return ArmReading(unknown, unknown, unknown, self._alarms())
        positions = unknown.copy()
        angles = np.array(angles_of(data))
        positions[:JOINTS] = np.where(self._impossible(angles), np.nan, angles)
        if self._exchanges % ERROR_EVERY == 0:
            error = self._ask(MyCobotCommand.READ_ERROR)
            self._error = self._error if error is None else error[0]
        if self._gripper is not None:
            if self._exchanges % GRIPPER_EVERY == 0:
                self._read_gripper(self._gripper)
            positions[JOINTS] = self._gripper_position
        return ArmReading(positions, self._velocities(positions), unknown, self._alarms())

    def close(self) -> None:
        """Close the port; see `ArmDevice`."""
        self._line.close()

    def _impossible(self, angles: NDArray[np.float64]) -> NDArray[np.bool_]:
        low, high = LIMITS[:, 0] - BEYOND_LIMITS, LIMITS[:, 1] + BEYOND_LIMITS
        return (angles < low) | (angles > high)

    def _velocities(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        now_s = self._line.now_s()
        last, self._last = self._last, (now_s, positions)
        if last is None or now_s <= last[0]:
            return np.zeros(len(positions))
        return (positions - last[1]) / (now_s - last[0])

    def _alarms(self) -> tuple[str, ...]:
        if self._error not in COLLISIONS:
            return ()
        return (f"the myCobot reports a collision, error {self._error}",)

    def _send(self, goals: NDArray[np.float64]) -> None:
        """Send goals; the arm's acknowledgement is not waited for, the next request drops it."""
        self._line.send(angles_request(goals[:JOINTS].tolist(), self._speed))
        if self._gripper is None or goals[JOINTS] == self._gripper_goal:
            return
        self._gripper_goal = float(goals[JOINTS])
        closed, opened = self._gripper
        value = round(100.0 * (self._gripper_goal - closed) / (opened - closed))
        data = bytes((min(max(value, 0), 100), GRIPPER_SPEED))
        self._line.send(request(MyCobotCommand.SEND_GRIPPER, data))

    def _read_gripper(self, gripper: tuple[float, float]) -> None:
        data = self._ask(MyCobotCommand.READ_GRIPPER)
        if data is not None and data[0] <= 100:
            closed, opened = gripper
            self._gripper_position = closed + data[0] / 100.0 * (opened - closed)

    def _read(self, command: MyCobotCommand) -> bytes:
        """Return a reply's data.

        Raises:
            ReplyError: there was none to any of three requests.
            PortError: the port has gone.
        """
        for _ in range(READS):
            data = self._ask(command)
            if data is not None:
                return data
        raise ReplyError("the myCobot does not answer", heard=False)

    def _ask(self, command: MyCobotCommand) -> bytes | None:
        """Return a reply's data; None if none came in time.

        After a miss it waits until the line is silent. Otherwise each reply of an arm that has
        become slow would be taken for that to the next request.
        """
        if self._missed_last:
            self._line.wait_for_silence(self._reply_timeout_s)
        self._line.send(request(command))
        wire_s = self._line.wire_s(REPLY_SIZES[command] + 2 * AROUND_DATA)
        deadline_s = self._line.now_s() + wire_s + self._reply_timeout_s
        received, data = b"", None
        while data is None:
            new = self._line.receive(deadline_s)
            if not new:
                break
            received += new
            data = reply_data(received, command)
        self._missed_last = data is None
        return data


class MyCobotHardware(SerialArm[MyCobotSettings]):
    """Six joints in the order of the description; a seventh is the gripper.

    The gripper's position command has `min`, where it is closed, and `max`, where it is open.
    """

    settings_type = MyCobotSettings

    def __init__(self, info: HardwareInfo) -> None:
        """Read the settings; see `SerialArm`.

        Raises:
            HardwareInfoError: a parameter is invalid, or the joints are not those of a myCobot.
        """
        super().__init__(info)
        count = len(self.driven)
        if count not in (JOINTS, JOINTS + 1):
            raise HardwareInfoError(
                f"hardware component '{info.name}': a myCobot 280 has {JOINTS} joints and perhaps "
                f"a gripper; the description has {count}"
            )
        self._gripper: tuple[float, float] | None = None
        for joint in self.driven[JOINTS:]:
            command = next(each for each in joint.command_interfaces if each.name == "position")
            if command.minimum is None or command.maximum is None:
                raise HardwareInfoError(
                    f"hardware component '{info.name}': the position command of '{joint.name}' "
                    "needs min, where the gripper is closed, and max, where it is open"
                )
            self._gripper = command.minimum, command.maximum

    def open_device(self) -> MyCobotArm:
        """Open the port; see `SerialArm`."""
        settings = self.settings
        return MyCobotArm(
            SerialLine(settings.port, settings.baud),
            [joint.name for joint in self.driven],
            self._gripper,
            settings.reply_timeout_s,
            settings.speed,
        )
