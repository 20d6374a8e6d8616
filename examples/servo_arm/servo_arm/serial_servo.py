"""servo_arm/SerialServo: a driver for servos on a serial port; the README has the protocol."""

import math

from arm_control import HardwareInfo, HardwareReturn, SystemInterface
from servo_arm.serial_line import SerialLine, SerialLineError


class SerialServo(SystemInterface):
    """Reads position and velocity of each joint, and writes its effort.

    `<param>`s of `<hardware>`: `device`, the port, and `timeout`, how long an answer may take [s].
    """

    def __init__(self, info: HardwareInfo) -> None:
        super().__init__(info)
        self._device = info.parameters.get("device", "/dev/ttyUSB0")
        self._timeout_s = float(info.parameters.get("timeout", "0.05"))
        self._line: SerialLine | None = None

    def on_configure(self) -> bool:
        """Open the port and read the joints once."""
        try:
            self._line = SerialLine(self._device, self._timeout_s)
        except SerialLineError as error:
            self.logger.error("%s", error)
            return False
        if self.read(0.0, 0.0) is HardwareReturn.OK:
            return True
        self.on_cleanup()
        return False

    def on_activate(self) -> bool:
        """Switch the motors on."""
        return self._request("on") == "ok"

    def on_deactivate(self) -> bool:
        """Switch the motors off."""
        return self._line is None or self._request("off") == "ok"

    def on_cleanup(self) -> bool:
        """Close the port."""
        if self._line is not None:
            self._line.close()
            self._line = None
        return True

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read positions and velocities."""
        answer = self._request("get")
        if answer is None:
            return HardwareReturn.ERROR
        try:
            values = [float(word) for word in answer.split()]
        except ValueError:
            values = []
        if len(values) != len(self.states):
            self.logger.error("%d numbers expected, '%s' received", len(self.states), answer)
            return HardwareReturn.ERROR
        self.states[:] = values
        return HardwareReturn.OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Send the efforts; 0 for joints that are not commanded."""
        efforts = [0.0 if math.isnan(effort) else effort for effort in self.commands.tolist()]
        answer = self._request("set " + " ".join(f"{effort:.6f}" for effort in efforts))
        return HardwareReturn.OK if answer == "ok" else HardwareReturn.ERROR

    def _request(self, line: str) -> str | None:
        """Return the answer; log the reason and return None if there is none."""
        if self._line is None:
            return None
        try:
            return self._line.request(line)
        except SerialLineError as error:
            self.logger.error("%s", error)
            return None
