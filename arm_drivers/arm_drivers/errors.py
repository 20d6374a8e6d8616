"""Errors of arm_drivers.

DriverError
├── PortError         a port that cannot be opened, or that has gone
├── ReplyError        no sound reply in time
├── DeviceError       a device that is not the one that was asked for, or refuses
└── CalibrationError  a calibration file that cannot be used
"""


class DriverError(Exception):
    """Root of every error that this package raises; the message is for the user."""


class PortError(DriverError):
    """The port does not exist, may not be opened, is in use, or was unplugged."""


class ReplyError(DriverError):
    """No sound reply came in time.

    Attributes:
        heard: whether any bytes came.
    """

    def __init__(self, message: str, heard: bool) -> None:
        super().__init__(message)
        self.heard = heard


class DeviceError(DriverError):
    """The device is another one, holds other settings, or does not do what it was told."""


class CalibrationError(DriverError):
    """The file does not exist, is not a calibration, or is that of another arm."""
