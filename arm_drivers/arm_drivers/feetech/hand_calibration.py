"""Calibrates the joints of Feetech servos while the arm is moved by hand. No output."""

from collections.abc import Mapping

from arm_drivers.calibration import JointCalibration
from arm_drivers.errors import CalibrationError
from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.feetech.registers import MOTION_COUNT, OFFSET, POSITION, STEPS, TORQUE

LEAST_RANGE = 100
"""Steps, 9 degrees. A joint that was moved by less was not moved to its ends."""


class HandCalibration:
    """Notes where the joints stand and how far they are moved. One thread.

    Attributes:
        lowest: lowest position of each joint so far, in steps.
        highest: highest position of each joint so far.
    """

    def __init__(self, bus: FeetechBus, joints: Mapping[str, int]) -> None:
        """Calibrate these joints.

        Args:
            bus: their servos' bus.
            joints: the id of each joint's servo.
        """
        self._bus = bus
        self._joints = dict(joints)
        self._middles: dict[str, int] = {}
        self._last: dict[str, int] = {}
        self.lowest: dict[str, int] = {}
        self.highest: dict[str, int] = {}

    def release(self) -> None:
        """Switch the power of the joints off.

        Raises:
            DriverError: a servo does not answer, or does not obey.
        """
        for servo in self._joints.values():
            self._bus.write(servo, TORQUE, 0)

    def take_middle(self) -> None:
        """Note where each joint stands at 0 rad.

        Raises:
            DriverError: a servo does not answer.
        """
        for joint, servo in self._joints.items():
            data = self._bus.read(servo, POSITION.address, MOTION_COUNT).data
            self._middles[joint] = POSITION.decode(data, POSITION.address)
        self.lowest, self.highest = dict(self._middles), dict(self._middles)
        self._last = dict(self._middles)

    def take_positions(self) -> None:
        """Read the joints once, and widen their ranges; one that does not answer keeps its own.

        Raises:
            CalibrationError: a joint goes past the end of its servo's turn.
        """
        replies = self._bus.read_all(tuple(self._joints.values()), POSITION.address, MOTION_COUNT)
        for joint, servo in self._joints.items():
            if servo not in replies:
                continue
            position = POSITION.decode(replies[servo].data, POSITION.address)
            if abs(position - self._last[joint]) > STEPS // 2:
                raise CalibrationError(
                    f"joint '{joint}' goes past the end of its servo's turn, between "
                    f"{self._last[joint]} and {position}: mount the servo so that 2048 lies "
                    "within the joint's range"
                )
            self._last[joint] = position
            self.lowest[joint] = min(position, self.lowest[joint])
            self.highest[joint] = max(position, self.highest[joint])

    def result(self) -> dict[str, JointCalibration]:
        """Return the calibration.

        Raises:
            CalibrationError: a joint was not moved to its ends.
            DriverError: a servo does not answer.
        """
        still = [j for j in self._joints if self.highest[j] - self.lowest[j] < LEAST_RANGE]
        if still:
            raise CalibrationError(
                f"joint {', '.join(still)} was not moved to both of its ends: nothing is written"
            )
        return {
            joint: JointCalibration(
                servo,
                0,
                OFFSET.decode(
                    self._bus.read(servo, OFFSET.address, OFFSET.size).data, OFFSET.address
                ),
                self.lowest[joint],
                self.highest[joint],
                self._middles[joint],
            )
            for joint, servo in self._joints.items()
        }
