"""arm_drivers/Feetech: the hardware plugin of an arm of Feetech's STS servos."""

from pathlib import Path

from arm_control.hardware.info import HardwareInfo
from arm_drivers.calibration import read_calibration
from arm_drivers.errors import CalibrationError
from arm_drivers.feetech.arm import FeetechArm, JointServo
from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.serial_arm import SerialArm
from arm_drivers.serial_line import SerialLine
from arm_drivers.settings import FeetechSettings, joint_numbers


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
