"""The settings of the drivers: the `<param>`s of `<hardware>`, each declared once."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo
from arm_node.parameter_values import (
    IntegerReader,
    NumberReader,
    ParameterValueError,
    read_nonempty_text,
    read_text,
)
from arm_node.setting import given_values, read_settings, setting, settings_of

_POSITIVE = NumberReader("a number above 0", least=0.0, above=True)
_COUNT = IntegerReader("a whole number of at least 1", least=1)

SettingsT = TypeVar("SettingsT", bound="SerialArmSettings")


def _file(text: str) -> Path | None:
    return Path(os.path.expanduser(text)) if text else None


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialArmSettings:
    """The settings of every arm on a serial port."""

    port: str = setting("/dev/ttyUSB0", "the serial port", read_nonempty_text)
    reply_timeout_s: float = setting(
        0.02,
        "how long a reply may take beside the time on the wire",
        _POSITIVE,
        unit="s",
        name="reply_timeout",
    )
    max_velocity: float = setting(
        3.0, "how fast a goal moves towards a command", _POSITIVE, unit="rad/s"
    )
    max_missed: int = setting(
        5, "replies in a row that a joint may miss before the arm is taken out of use", _COUNT
    )
    watchdog_s: float = setting(
        0.5,
        "after this long without commands the arm stops where it is",
        _POSITIVE,
        unit="s",
        name="watchdog",
    )
    at_end: str = setting(
        "hold",
        "what the arm does when the program ends; release lets it fall",
        choices=("hold", "release"),
    )
    passive: bool = setting(
        False, "never power the arm: it is moved by hand and only read; commands have no effect"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FeetechSettings(SerialArmSettings):
    """The settings of an arm of Feetech servos."""

    calibration: Path | None = setting(
        "", "calibration file; empty for joints whose middle is 0 rad", read_text, adapt=_file
    )
    baud: int = setting(1_000_000, "bits per second of the bus", _COUNT)
    stall_torque: float = setting(
        1.9, "torque of a servo at full load, to estimate efforts", _POSITIVE, unit="N m"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MyCobotSettings(SerialArmSettings):
    """The settings of a myCobot 280."""

    reply_timeout_s: float = setting(
        0.05,
        "how long a reply may take beside the time on the wire",
        _POSITIVE,
        unit="s",
        name="reply_timeout",
    )
    baud: int = setting(115_200, "bits per second; 1000000 for the Pi", _COUNT)
    speed: int = setting(
        80,
        "speed of the arm's own motion, from 1 to 100",
        IntegerReader("a whole number from 1 to 100", 1, 100),
    )


def read_hardware_settings(cls: type[SettingsT], info: HardwareInfo) -> SettingsT:
    """Return the settings of a hardware component.

    Raises:
        HardwareInfoError: a parameter is unknown or invalid.
    """
    declared = {each.name: each for each in settings_of(cls)}
    unknown = sorted(info.parameters.keys() - declared)
    if unknown:
        raise HardwareInfoError(
            f"hardware component '{info.name}': no parameter '{unknown[0]}'; "
            f"'{info.plugin}' has {', '.join(declared)}"
        )
    values = {
        name: as_number(text, declared[name].default) for name, text in info.parameters.items()
    }
    try:
        return read_settings(cls, given_values(values))
    except ParameterValueError as error:
        raise HardwareInfoError(f"hardware component '{info.name}': {error}") from error


def joint_numbers(info: HardwareInfo, joints: Mapping[str, str]) -> dict[str, int]:
    """Return a number for each joint by its name: its `id`, or its place from 1 on.

    Args:
        info: the component, for messages.
        joints: the text of the parameter `id` by the joint's name; "" where it is not given.

    Raises:
        HardwareInfoError: an id is not a number from 0 to 252, or two joints have the same.
    """
    numbers: dict[str, int] = {}
    for place, (joint, text) in enumerate(joints.items(), 1):
        number = as_number(text, 0) if text else place
        if not isinstance(number, int) or not 0 <= number <= 252:
            raise HardwareInfoError(
                f"hardware component '{info.name}': the id of joint '{joint}' must be a whole "
                f"number from 0 to 252, not '{text}'"
            )
        if number in numbers.values():
            raise HardwareInfoError(
                f"hardware component '{info.name}': two joints have the id {number}"
            )
        numbers[joint] = number
    return numbers


def as_number(text: str, default: object) -> object:
    """Return a text as a number if the default is one and the text is one, too."""
    kind = type(default)
    if kind is bool:
        return {"true": True, "false": False}.get(text.lower(), text)
    if kind not in (int, float):
        return text
    try:
        return kind(text)
    except ValueError:
        return text
