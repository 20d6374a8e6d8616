"""A calibration: where the joints of one arm stand at 0 rad, and how far they may turn.

The file is LeRobot's, JSON by joint: id, drive_mode, homing_offset, range_min and range_max, all in
the servo's steps. `arm calibrate` adds `middle`, the position of the joint at 0 rad; LeRobot's own
files have it at 2047 by their homing offset.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from arm_drivers.errors import CalibrationError

LEROBOT_MIDDLE = 2047
"""Where LeRobot's homing puts the middle of a joint."""


@dataclass(frozen=True, slots=True)
class JointCalibration:
    """The calibration of one joint, in steps of its servo.

    Attributes:
        id: of its servo.
        drive_mode: 1 if the joint turns against the servo, otherwise 0.
        homing_offset: what the servo's register of the offset holds.
        range_min: lowest position.
        range_max: highest position.
        middle: position at 0 rad.
    """

    id: int
    drive_mode: int
    homing_offset: int
    range_min: int
    range_max: int
    middle: int = LEROBOT_MIDDLE

    @property
    def direction(self) -> int:
        """1, or -1 if the joint turns against the servo."""
        return -1 if self.drive_mode else 1


def read_calibration(file: Path) -> dict[str, JointCalibration]:
    """Return the calibration of each joint by its name.

    Raises:
        CalibrationError: the file cannot be read, or is not a calibration.
    """
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise CalibrationError(
            f"calibration file {file} cannot be read: {error.strerror}"
        ) from error
    except ValueError as error:
        raise CalibrationError(f"calibration file {file} is not JSON: {error}") from error
    if not isinstance(content, dict) or not content:
        raise CalibrationError(f"calibration file {file} has no joints")
    joints = {str(name): _joint(file, name, value) for name, value in content.items()}
    owners: dict[int, str] = {}
    for name, joint in joints.items():
        if joint.id in owners:
            raise CalibrationError(
                f"calibration file {file}: '{owners[joint.id]}' and '{name}' both have "
                f"id {joint.id}"
            )
        owners[joint.id] = name
    return joints


def write_calibration(file: Path, joints: Mapping[str, JointCalibration]) -> None:
    """Write a calibration.

    Raises:
        CalibrationError: the file cannot be written.
    """
    text = json.dumps({name: asdict(joint) for name, joint in joints.items()}, indent=4)
    try:
        file.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise CalibrationError(
            f"calibration file {file} cannot be written: {error.strerror}"
        ) from error


def _joint(file: Path, name: object, value: Any) -> JointCalibration:
    names = [field.name for field in fields(JointCalibration)]
    given: dict[str, Any] = {"middle": LEROBOT_MIDDLE}
    given |= value if isinstance(value, dict) else {}
    wrong = [each for each in names if type(given.get(each)) is not int]
    if wrong:
        raise CalibrationError(
            f"calibration file {file}: joint '{name}' needs whole numbers {', '.join(wrong)}"
        )
    joint = JointCalibration(**{each: given[each] for each in names})
    if not joint.range_min < joint.range_max:
        raise CalibrationError(
            f"calibration file {file}: the range of joint '{name}' is empty, "
            f"{joint.range_min} to {joint.range_max}"
        )
    return joint
