"""arm_drivers/MyCobot280: the hardware plugin of the myCobot 280."""

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo
from arm_drivers.mycobot.arm import MyCobotArm
from arm_drivers.mycobot.frames import JOINTS
from arm_drivers.serial_arm import SerialArm
from arm_drivers.serial_line import SerialLine
from arm_drivers.settings import MyCobotSettings


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
