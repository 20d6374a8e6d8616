"""The settings of a simulation, each declared once; see `arm_node.setting`."""

from dataclasses import dataclass, replace

from arm_gazebo.mjcf.memory_limit import SPAWN_LIMIT, WORLD_LIMIT, MemoryLimit
from arm_gazebo.run.robot_settings import RobotSettings, read_robots
from arm_node.parameter_values import (
    NumberReader,
    read_integer,
    read_non_negative,
    read_text,
    read_words,
)
from arm_node.setting import Parameters, read_settings, setting

_read_above_zero = NumberReader("a finite number above 0", least=0.0, above=True)
_read_gain = NumberReader("a number from 0 to 1", least=0.0, most=1.0)
_SWITCH = ("true", "false")


@dataclass(frozen=True, slots=True, kw_only=True)
class PhysicsSettings:
    """What is simulated, and how; with ROS or without."""

    physics_step_s: float | None = setting(
        0.0,
        "physics step; 0 chooses one up to 2 ms that divides the control period",
        read_non_negative,
        unit="s",
        name="physics_step",
        adapt=lambda step_s: step_s or None,
    )
    hold_joints: bool = setting(True, "joints that no controller claims hold their position")
    position_proportional_gain: float = setting(
        0.0,
        "as gz_ros2_control's, from 0 to 1: a position command is approached at this fraction of "
        "the distance in each control period; 0 moves joints as fast as they can",
        _read_gain,
    )
    self_collide: bool = setting(False, "links of the robot collide with each other")
    strict: bool = setting(False, "a missing mesh is an error instead of a box and a warning")
    render_backend: str = setting(
        "auto",
        "render backend of the cameras; OpenGL (egl, osmesa) draws round shapes with flat faces, "
        "0.5 mm too deep in the median for a ball of 60 mm radius, raycast draws them exactly",
        choices=("auto", "egl", "osmesa", "raycast"),
    )
    seed: int = setting(0, "seed of the noise of sensors and cameras", read_integer, launches=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationSettings(PhysicsSettings):
    """The user's settings for one simulation.

    Attributes:
        robots: the robots, at least one.
    """

    robots: tuple[RobotSettings, ...]
    world: str = setting(
        "empty",
        "empty, objects, shapes, pick_and_place_demo, house, or a MuJoCo XML or SDF file",
        read_text,
    )
    real_time_factor: float = setting(
        1.0,
        "ratio of simulation time to wall time; 0 is as fast as possible",
        read_non_negative,
        changes=True,
    )
    paused: bool = setting(False, "start paused; `arm sim play` continues", choices=_SWITCH)
    lockstep: tuple[str, ...] = setting(
        (),
        "stamped topics, or nodes by their ~/tick_done, that answer each control period before the "
        "next one begins",
        read_words,
    )
    lockstep_timeout_s: float = setting(
        10.0,
        "wall time without an answer that pauses the simulation",
        _read_above_zero,
        unit="s",
        name="lockstep_timeout",
        changes=True,
    )
    headless: bool = setting(True, "false opens a window", choices=_SWITCH)
    reset_clock: bool = setting(
        True, "a reset sets the clock to zero", choices=_SWITCH, changes=True
    )
    record_run: str = setting(
        "",
        "file to record the run to from now on, for `arm sim replay`; '' ends it",
        changes=True,
    )
    world_limit: MemoryLimit = setting(
        WORLD_LIMIT.mb,
        "limit on the memory of a world's MJCF",
        read_non_negative,
        unit="MB",
        name=WORLD_LIMIT.parameter,
        launches=False,
        adapt=lambda mb: replace(WORLD_LIMIT, mb=mb),
    )
    spawn_limit: MemoryLimit = setting(
        SPAWN_LIMIT.mb,
        "limit on the memory of a spawned MJCF",
        read_non_negative,
        unit="MB",
        name=SPAWN_LIMIT.parameter,
        launches=False,
        adapt=lambda mb: replace(SPAWN_LIMIT, mb=mb),
    )


def simulation_settings(parameters: Parameters) -> SimulationSettings:
    """Return the settings from the values of parameters.

    Raises:
        ParameterValueError: a value is invalid; the message names it and the valid values.
    """
    return read_settings(SimulationSettings, parameters, robots=read_robots(parameters))
