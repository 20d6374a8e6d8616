"""The parameters of the simulation node, read and checked once."""

from dataclasses import dataclass

from rclpy.node import Node

from arm_gazebo.rendering.backend_selection import PREFERENCES
from arm_gazebo.ros.parameter_values import ParameterValues
from arm_gazebo.ros.robot_settings import RobotSettings, read_robots


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """What the user chooses about one simulation.

    Attributes:
        robots: at least one.
        world: a shipped world's name or the path of a MuJoCo XML or SDF file.
        real_time_factor: simulated over wall time; 0 is as fast as possible.
        physics_step_s: None lets the step follow from the control rate.
        hold_joints: whether joints that no controller claims hold their position.
        self_collide: whether a robot's links touch each other.
        strict: whether a missing mesh is an error instead of a box.
        render_backend: of the cameras.
        seed: of the sensors' noise.
        headless: False for a window on the simulation.
    """

    robots: tuple[RobotSettings, ...]
    world: str
    real_time_factor: float
    physics_step_s: float | None
    hold_joints: bool
    self_collide: bool
    strict: bool
    render_backend: str
    seed: int
    headless: bool


def read_settings(node: Node) -> SimulationSettings:
    """Declare the node's parameters and return their values.

    Raises:
        SettingsError: a value makes no sense; the message names it and what would.
    """
    values = ParameterValues(node)
    return SimulationSettings(
        robots=read_robots(values),
        world=values.text("world", "empty", "a shipped world's name, or a file: MuJoCo XML, SDF"),
        real_time_factor=values.number(
            "real_time_factor", 1.0, "simulated over wall time; 0 is as fast as possible"
        ),
        physics_step_s=values.number(
            "physics_step", 0.0, "in seconds; 0 chooses one of at most 2 ms"
        )
        or None,
        hold_joints=values.flag("hold_joints", True, "joints that nobody claims hold"),
        self_collide=values.flag("self_collide", False, "links of a robot touch each other"),
        strict=values.flag("strict", False, "a missing mesh is an error"),
        render_backend=values.choice("render_backend", "auto", PREFERENCES, "of the cameras"),
        seed=values.whole("seed", 0, "of the sensors' noise"),
        headless=values.flag("headless", True, "false opens a window on the simulation"),
    )
