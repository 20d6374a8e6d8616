"""The parameters of the simulation node, read and checked once."""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arm_description.robot import Pose
from arm_gazebo.errors import SettingsError
from arm_gazebo.rendering.backend_selection import PREFERENCES

BASES = ("fixed", "free")


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """What the user chooses about one simulation.

    Attributes:
        robot_description: the URDF.
        world: a shipped world's name or the path of a MuJoCo XML file.
        real_time_factor: simulated over wall time; 0 is as fast as possible.
        physics_step_s: None lets the step follow from the control rate.
        hold_joints: whether joints that no controller claims hold their position.
        spawn: controllers to start with the simulation, in this order.
        base: what becomes of a root link that hangs on no world link.
        pose: of the robot's root in the world; None for where it stands by itself.
        self_collide: whether the robot's links touch each other.
        strict: whether a missing mesh is an error instead of a box.
        package_path: folders searched for package:// and model:// besides the installed ones.
        render_backend: of the cameras.
        seed: of the cameras' noise.
        headless: False for a window on the simulation.
    """

    robot_description: str
    world: str
    real_time_factor: float
    physics_step_s: float | None
    hold_joints: bool
    spawn: tuple[str, ...]
    base: str
    pose: Pose | None
    self_collide: bool
    strict: bool
    package_path: tuple[Path, ...]
    render_backend: str
    seed: int
    headless: bool


def read_settings(node: Node) -> SimulationSettings:
    """Declare the node's parameters and return their values.

    Raises:
        SettingsError: a value makes no sense; the message names it and what would.
    """
    values = _Values(node)
    return SimulationSettings(
        robot_description=_description(values),
        world=values.text("world", "empty", "a shipped world's name, or a MuJoCo XML file"),
        real_time_factor=values.number(
            "real_time_factor", 1.0, "simulated over wall time; 0 is as fast as possible"
        ),
        physics_step_s=values.number(
            "physics_step", 0.0, "in seconds; 0 chooses one of at most 2 ms"
        )
        or None,
        hold_joints=values.flag("hold_joints", True, "joints that nobody claims hold"),
        spawn=tuple(values.texts("spawn", "controllers to start with the simulation")),
        base=values.choice("base", "fixed", BASES, "what a root without world link does"),
        pose=_pose(values),
        self_collide=values.flag("self_collide", False, "links of the robot touch each other"),
        strict=values.flag("strict", False, "a missing mesh is an error"),
        package_path=values.folders("package_path", "for package:// and model://, with colons"),
        render_backend=values.choice("render_backend", "auto", PREFERENCES, "of the cameras"),
        seed=values.whole("seed", 0, "of the cameras' noise"),
        headless=values.flag("headless", True, "false opens a window on the simulation"),
    )


def _description(values: "_Values") -> str:
    text = values.text("robot_description", "", "the URDF")
    if not text.strip():
        raise SettingsError(
            "the parameter robot_description is empty; give it the URDF of the robot, "
            "as arm_gazebo.launch.py does"
        )
    return text


def _pose(values: "_Values") -> Pose | None:
    numbers = values.numbers("pose", "x y z roll pitch yaw of the robot's root, in m and rad")
    if not numbers:
        return None
    if len(numbers) != 6:
        raise SettingsError(
            f"pose takes six numbers, x y z roll pitch yaw, or none; it has {len(numbers)}"
        )
    x, y, z, roll, pitch, yaw = numbers
    return Pose((x, y, z), (roll, pitch, yaw))


class _Values:
    """Declares parameters with forgiving types: an integer is a fine number."""

    def __init__(self, node: Node) -> None:
        self._node = node

    def text(self, name: str, default: str, description: str) -> str:
        value = self._declare(name, default, description)
        if not isinstance(value, str):
            raise SettingsError(f"{name} must be a text, not {value!r}")
        return value

    def choice(self, name: str, default: str, choices: tuple[str, ...], description: str) -> str:
        value = self._declare(name, default, f"{description}: {', '.join(choices)}")
        if value not in choices:
            raise SettingsError(f"{name} must be one of {', '.join(choices)}, not {value!r}")
        return value

    def flag(self, name: str, default: bool, description: str) -> bool:
        value = self._declare(name, default, description)
        if not isinstance(value, bool):
            raise SettingsError(f"{name} must be true or false, not {value!r}")
        return value

    def whole(self, name: str, default: int, description: str) -> int:
        value = self._declare(name, default, description)
        if isinstance(value, bool) or not isinstance(value, int):
            raise SettingsError(f"{name} must be a whole number, not {value!r}")
        return value

    def number(self, name: str, default: float, description: str) -> float:
        value = self._declare(name, default, description)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SettingsError(f"{name} must be a number, not {value!r}")
        if not math.isfinite(value) or value < 0:
            raise SettingsError(f"{name} must be finite and not negative, not {value!r}")
        return float(value)

    def numbers(self, name: str, description: str) -> list[float]:
        value = self._declare(name, None, description)
        if value is None or value == "" or value == []:
            return []
        try:
            numbers = [float(v) for v in value]
        except (TypeError, ValueError):
            numbers = [math.nan]
        if not all(map(math.isfinite, numbers)):
            raise SettingsError(f"{name} must be a list of finite numbers, not {value!r}")
        return numbers

    def texts(self, name: str, description: str) -> list[str]:
        value = self._declare(name, None, description)
        if value is None or value == "" or value == []:
            return []
        if isinstance(value, str):
            return value.replace(",", " ").split()
        if not all(isinstance(v, str) for v in value):
            raise SettingsError(f"{name} must be a list of texts, not {value!r}")
        return list(value)

    def folders(self, name: str, description: str) -> tuple[Path, ...]:
        return tuple(
            Path(folder).expanduser()
            for folder in self.text(name, "", f"folders {description}").split(os.pathsep)
            if folder
        )

    def _declare(self, name: str, default: object, description: str) -> Any:
        descriptor = ParameterDescriptor(
            description=description, read_only=True, dynamic_typing=True
        )
        return self._node.declare_parameter(name, default, descriptor).value
