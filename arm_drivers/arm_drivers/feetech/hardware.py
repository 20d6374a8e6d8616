"""arm_drivers/Feetech: an arm of Feetech's STS servos, in rad; their bus counts in steps."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.info import HardwareInfo
from arm_drivers.arm_device import ArmReading
from arm_drivers.calibration import read_calibration
from arm_drivers.errors import CalibrationError, DeviceError, ReplyError
from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.feetech.frames import Alarm, Reply
from arm_drivers.feetech.registers import (
    GOAL,
    LOAD,
    MAX_POSITION,
    MAX_VOLTAGE,
    MIDDLE,
    MIN_POSITION,
    MIN_VOLTAGE,
    MODE,
    MODEL,
    MODEL_NUMBER,
    MOTION_COUNT,
    OFFSET,
    POSITION,
    SETUP_COUNT,
    SPEED,
    STEPS,
    TORQUE,
    VOLTAGE,
)
from arm_drivers.serial_arm import SerialArm
from arm_drivers.serial_line import SerialLine
from arm_drivers.settings import FeetechSettings, joint_numbers

RAD_PER_STEP = 2.0 * math.pi / STEPS
OUTSIDE_RANGE = 100
"""Steps that a joint may stand outside the calibrated range, as one that rests on its stop does."""
MAX_SPEED = 20.0
"""rad/s: three times what a servo without load reaches, for an arm that is moved by hand."""
WORDS = {
    Alarm.VOLTAGE: "its voltage is outside its limits",
    Alarm.ENCODER: "its encoder has failed",
    Alarm.TEMPERATURE: "it is too hot",
    Alarm.CURRENT: "its current is too high",
    Alarm.OVERLOAD: "it is overloaded and lets go",
}


@dataclass(frozen=True, slots=True)
class JointServo:
    """The servo of a joint.

    Attributes:
        joint: the joint's name.
        id: on the bus.
        middle: its position at 0 rad, in steps.
        direction: 1, or -1 if the joint turns against it.
        range: lowest and highest calibrated position, in steps.
        offset: what its register of the offset must hold; None if that does not matter.
    """

    joint: str
    id: int
    middle: int = MIDDLE
    direction: int = 1
    range: tuple[int, int] = (0, STEPS - 1)
    offset: int | None = None

    def __str__(self) -> str:
        return f"servo {self.id} ({self.joint})"


class FeetechArm:
    """See `arm_drivers.arm_device.ArmDevice`."""

    def __init__(self, bus: FeetechBus, servos: Sequence[JointServo], stall_torque: float) -> None:
        """Use a bus.

        Args:
            bus: the servos' bus.
            servos: one for each joint.
            stall_torque: of a servo in N m; its load, a fraction, is reported as part of it.
        """
        self._bus = bus
        self._servos = tuple(servos)
        self._ids = tuple(servo.id for servo in servos)
        self._stall_torque = stall_torque
        self._middles = np.array([servo.middle for servo in servos], float)
        self._scales = np.array([servo.direction * RAD_PER_STEP for servo in servos])
        self._lowest = np.array([servo.range[0] for servo in servos])
        self._highest = np.array([servo.range[1] for servo in servos])
        self._servo_limits = np.array([(0, STEPS - 1) for _ in servos])
        self.max_speed = MAX_SPEED
        self._voltages: dict[int, tuple[int, int]] = {}
        self.names: Sequence[str] = tuple(map(str, servos))
        self.lower = self.upper = np.empty(0)
        self._note_limits()

    def start(self) -> None:
        """Check each servo; see `ArmDevice`."""
        silent: list[str] = []
        for place, servo in enumerate(self._servos):
            try:
                setup = self._bus.read(servo.id, 0, SETUP_COUNT)
            except ReplyError as error:
                if error.heard:
                    raise
                silent.append(str(servo))
                continue
            self._take_setup(place, servo, setup.data)
        if len(silent) == len(self._servos):
            raise DeviceError(
                f"no Feetech servo answers on {self._bus.line.port} at {self._bus.line.baud} baud: "
                "check the power of the servos, the port and the baud rate"
            )
        if silent:
            raise DeviceError(f"{', '.join(silent)} does not answer; the other servos do")
        self._note_limits()
        self._check_range()

    def engage(self, positions: NDArray[np.float64]) -> None:
        """Make the measured positions the goals, then power on; see `ArmDevice`."""
        goals = self._goals(positions)
        for servo in self._servos:
            # Read back: a servo that missed its goal would jump to an old one.
            self._bus.write(servo.id, GOAL, goals[servo.id])
        for servo in self._servos:
            if Alarm.OVERLOAD in self._bus.read(servo.id, TORQUE.address, TORQUE.size).alarm:
                # Only this ends a servo's overload state.
                self._bus.write(servo.id, TORQUE, 0)
            self._bus.write(servo.id, TORQUE, 1)

    def release(self) -> None:
        """Power off; see `ArmDevice`."""
        for servo in self._servos:
            self._bus.write(servo.id, TORQUE, 0)

    def exchange(self, goals: NDArray[np.float64] | None) -> ArmReading:
        """Send goals and read; see `ArmDevice`."""
        if goals is not None:
            self._bus.write_all(GOAL, self._goals(goals))
        replies = self._bus.read_all(self._ids, POSITION.address, MOTION_COUNT)
        raw = np.full((3, len(self._servos)), np.nan)
        alarms: list[str] = []
        for place, servo in enumerate(self._servos):
            reply = replies.get(servo.id)
            if reply is None:
                continue
            raw[:, place] = [
                register.decode(reply.data, POSITION.address)
                for register in (POSITION, SPEED, LOAD)
            ]
            alarms += self._alarms(servo, reply)
        direction = np.sign(self._scales)
        return ArmReading(
            (raw[0] - self._middles) * self._scales,
            raw[1] * self._scales,
            raw[2] * direction * 1e-3 * self._stall_torque,
            tuple(alarms),
        )

    def close(self) -> None:
        """Close the port; see `ArmDevice`."""
        self._bus.line.close()

    def _take_setup(self, place: int, servo: JointServo, setup: bytes) -> None:
        model, mode = MODEL_NUMBER.decode(setup), MODE.decode(setup)
        if model != MODEL:
            raise DeviceError(f"{servo} is of model {model}; the driver knows the STS3215, {MODEL}")
        if mode != 0:
            raise DeviceError(f"{servo} is in mode {mode}; the driver needs position mode, 0")
        offset = OFFSET.decode(setup)
        if servo.offset is not None and offset != servo.offset:
            raise CalibrationError(
                f"the calibration is of another arm: {servo} holds the offset {offset}, "
                f"the file has {servo.offset}"
            )
        self._voltages[servo.id] = (MIN_VOLTAGE.decode(setup), MAX_VOLTAGE.decode(setup))
        lowest, highest = MIN_POSITION.decode(setup), MAX_POSITION.decode(setup)
        if lowest < highest:  # 0 and 0 mean no limits.
            self._servo_limits[place] = lowest, highest
            self._lowest[place] = max(servo.range[0], lowest)
            self._highest[place] = min(servo.range[1], highest)
        if self._lowest[place] >= self._highest[place]:
            raise CalibrationError(
                f"the calibration is of another arm: {servo} may turn from {lowest} to {highest}, "
                f"the file has {servo.range[0]} to {servo.range[1]}"
            )

    def _check_range(self) -> None:
        """Refuse an arm that stands where the calibration says it cannot, or has low voltage."""
        for place, servo in enumerate(self._servos):
            reply = self._bus.read(servo.id, POSITION.address, MOTION_COUNT)
            position = POSITION.decode(reply.data, POSITION.address)
            lowest, highest = self._lowest[place], self._highest[place]
            if not lowest - OUTSIDE_RANGE <= position <= highest + OUTSIDE_RANGE:
                raise CalibrationError(
                    f"{servo} stands at {position}, outside its range, {lowest} to {highest}: "
                    "move it there by hand, or calibrate this arm"
                )
            # An overload ends when the servo is powered on again.
            fit = replace(reply, alarm=reply.alarm & ~Alarm.OVERLOAD)
            for alarm in self._alarms(servo, fit):
                raise DeviceError(alarm)

    def _alarms(self, servo: JointServo, reply: Reply) -> Iterable[str]:
        tenths = VOLTAGE.decode(reply.data, POSITION.address)
        low, high = self._voltages.get(servo.id, (0, 255))
        if not low <= tenths <= high:
            yield f"{servo} has {tenths / 10:g} V; it needs {low / 10:g} to {high / 10:g} V"
        # The figure says more than the bit, but the servo may have seen it fall between readings.
        told = reply.alarm if low <= tenths <= high else reply.alarm & ~Alarm.VOLTAGE
        for alarm in told:
            yield f"{servo} reports an alarm: {WORDS[alarm]}"

    def _goals(self, positions: NDArray[np.float64]) -> dict[int, int]:
        """Return steps that each servo accepts; a joint outside its calibrated range stays there.

        The driver brings such a joint back no faster than its goals may move.
        """
        steps = np.rint(positions / self._scales + self._middles)
        within = np.clip(steps, *self._servo_limits.T).astype(int)
        return dict(zip(self._ids, within.tolist(), strict=True))

    def _note_limits(self) -> None:
        ends = (np.array((self._lowest, self._highest)) - self._middles) * self._scales
        self.lower, self.upper = ends.min(axis=0), ends.max(axis=0)


class FeetechHardware(SerialArm[FeetechSettings]):
    """Servos on one bus.

    The `<param name="id">` of a joint is the id of its servo, by default its place from 1 on.
    """

    settings_type = FeetechSettings

    def __init__(self, info: HardwareInfo) -> None:
        """Read the settings; see `SerialArm`."""
        super().__init__(info)
        texts = {joint.name: joint.parameters.get("id", "") for joint in self.driven}
        self._ids = joint_numbers(info, texts)

    def open_device(self) -> FeetechArm:
        """Open the bus; see `SerialArm`."""
        settings = self.settings
        servos = self._servos(settings.calibration)
        line = SerialLine(settings.port, settings.baud)
        return FeetechArm(FeetechBus(line, settings.reply_timeout_s), servos, settings.stall_torque)

    def _servos(self, file: Path | None) -> list[JointServo]:
        if file is None:
            self.logger.warning(
                "no calibration: each servo's middle is taken for 0 rad; `arm calibrate` makes one"
            )
            return [JointServo(joint, number) for joint, number in self._ids.items()]
        calibration = read_calibration(file)
        missing = [joint for joint in self._ids if joint not in calibration]
        if missing:
            raise CalibrationError(
                f"calibration file {file} has no joint '{missing[0]}'; it has "
                f"{', '.join(calibration)}"
            )
        return [
            JointServo(
                joint,
                calibration[joint].id,
                calibration[joint].middle,
                calibration[joint].direction,
                (calibration[joint].range_min, calibration[joint].range_max),
                calibration[joint].homing_offset,
            )
            for joint in self._ids
        ]
