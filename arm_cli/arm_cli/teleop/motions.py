"""What the keys of a terminal and the sticks of a gamepad ask a jog for."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

Three = tuple[float, float, float]
ZERO: Three = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class TipMotion:
    """A velocity of the tip along and about the axes of a frame, -1 to 1 of the largest."""

    linear: Three = ZERO
    angular: Three = ZERO

    def scaled(self, factor: float) -> "TipMotion":
        """Return it with another speed."""
        x, y, z = self.linear
        roll, pitch, yaw = self.angular
        return TipMotion(
            (x * factor, y * factor, z * factor), (roll * factor, pitch * factor, yaw * factor)
        )


@dataclass(frozen=True, slots=True)
class JointMotion:
    """A speed of one joint, a fraction of the largest, -1 to 1."""

    joint: str
    speed: float


Motion = TipMotion | JointMotion

HELP = """\
arrows       the tip along x and y          1 to 9   a joint; r reverses its direction
. and ;      the tip down and up            + and -  faster and slower
x y z        turn about an axis; X Y Z back w and e  axes of the world, of the end effector
space        emergency stop                 q        quit"""

TIP_KEYS = {
    "up": TipMotion((1.0, 0.0, 0.0)),
    "down": TipMotion((-1.0, 0.0, 0.0)),
    "left": TipMotion((0.0, 1.0, 0.0)),
    "right": TipMotion((0.0, -1.0, 0.0)),
    ";": TipMotion((0.0, 0.0, 1.0)),
    ".": TipMotion((0.0, 0.0, -1.0)),
    "x": TipMotion(angular=(1.0, 0.0, 0.0)),
    "X": TipMotion(angular=(-1.0, 0.0, 0.0)),
    "y": TipMotion(angular=(0.0, 1.0, 0.0)),
    "Y": TipMotion(angular=(0.0, -1.0, 0.0)),
    "z": TipMotion(angular=(0.0, 0.0, 1.0)),
    "Z": TipMotion(angular=(0.0, 0.0, -1.0)),
}
SPEED_KEYS = {"+": 0.1, "=": 0.1, "-": -0.1}
ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
ESCAPE = "\x1b"


def keys_of(typed: str) -> list[str]:
    """Return the keys in what a terminal sends; arrows by name, and no other escape sequence."""
    keys: list[str] = []
    position = 0
    while position < len(typed):
        # ESC [ A, or ESC O A in a terminal's application mode, with parameters before the letter.
        if typed[position] == ESCAPE and typed[position + 1 : position + 2] in ("[", "O"):
            position += 2
            while position < len(typed) and not "@" <= typed[position] <= "~":
                position += 1
            if (final := typed[position : position + 1]) in ARROWS:
                keys.append(ARROWS[final])
        else:
            keys.append(typed[position])
        position += 1
    return keys


class Keyboard:
    """Turns keys into motions.

    Attributes:
        speed: 0.1 to 1, of the largest speed.
        in_tip_frame: whether axes are those of the end effector.
    """

    def __init__(self, joints: Sequence[str]) -> None:
        """Jog these joints with the keys 1 to 9."""
        self.speed = 0.5
        self.in_tip_frame = False
        self._joints = joints[:9]
        self._direction = 1.0

    def press(self, key: str) -> Motion | None:
        """Return the motion that a key asks for; None if it asks for none, or changes a setting."""
        if key in TIP_KEYS:
            return TIP_KEYS[key].scaled(self.speed)
        if key.isascii() and key.isdigit() and 0 < int(key) <= len(self._joints):
            return JointMotion(self._joints[int(key) - 1], self._direction * self.speed)
        if key in SPEED_KEYS:
            self.speed = round(min(1.0, max(0.1, self.speed + SPEED_KEYS[key])), 1)
        elif key == "r":
            self._direction = -self._direction
        elif key in ("w", "e"):
            self.in_tip_frame = key == "e"
        return None

    def describe(self) -> str:
        """Return the settings in a line."""
        direction = "" if self._direction > 0 else ", joints reversed"
        axes = "end effector" if self.in_tip_frame else "world"
        return f"speed {self.speed:.0%}, axes of the {axes}{direction}"


ENABLE = 4
"""The left shoulder button, in the order of joy_node."""
AXES, BUTTONS = 8, 5
STILL = 0.05
"""Sticks do not come back to zero exactly."""


def gamepad_motion(axes: Sequence[float], buttons: Sequence[int]) -> TipMotion | None:
    """Return what a gamepad asks for, None while its left shoulder button is not held.

    The left stick moves along x and y, the right one up and down and turns about z, the pad of
    four turns about x and y. Triggers are not read: until one is touched, its rest reads as half
    pressed.

    Args:
        axes: of sensor_msgs/Joy, in the order of joy_node: left x, y, trigger, right x, y,
            trigger, pad x, y; left and up are positive.
        buttons: likewise.

    Raises:
        ValueError: it has fewer axes or buttons, or a value that is not finite.
    """
    if len(axes) < AXES or len(buttons) < BUTTONS:
        raise ValueError(
            f"the gamepad has {len(axes)} axes and {len(buttons)} buttons; {AXES} and {BUTTONS} "
            "are read, in the order of joy_node"
        )
    if not all(map(math.isfinite, axes)):
        raise ValueError("an axis of the gamepad is not finite")
    if not buttons[ENABLE]:
        return None
    left_x, left_y, _, right_x, right_y, _, pad_x, pad_y = (_stick(axis) for axis in axes[:AXES])
    return TipMotion((left_y, left_x, right_y), (-pad_x, pad_y, right_x))


def _stick(value: float) -> float:
    return 0.0 if abs(value) < STILL else min(1.0, max(-1.0, value))
