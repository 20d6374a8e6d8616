"""The settings of a simulation, each declared once; see `arm_node.setting`."""

import os
from array import array
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from arm_gazebo.mjcf.memory_limit import SPAWN_LIMIT, WORLD_LIMIT, MemoryLimit
from arm_node.frozen import frozen
from arm_node.parameter_values import (
    NumberReader,
    ParameterValueError,
    read_integer,
    read_non_negative,
    read_numbers,
    read_text,
    read_words,
)
from arm_node.setting import Parameters, read_settings, setting

if TYPE_CHECKING:
    from arm_description.urdf.robot import Pose


def _read_description(value: object) -> str:
    text = read_text(value)
    if not text.strip():
        raise ParameterValueError("is empty; set it to the robot's URDF, as sim.launch.py does")
    return text


def _read_pose(value: object) -> "Pose | None":
    numbers = read_numbers([] if isinstance(value, str) and not value else value)
    if not numbers:
        return None
    if len(numbers) != 6:
        raise ParameterValueError(
            f"takes six numbers, x y z roll pitch yaw, or none; it has {len(numbers)}"
        )
    # Imported here, because launch files read the declarations, and need no robot for that.
    from arm_description.urdf.robot import Pose

    x, y, z, roll, pitch, yaw = numbers
    return Pose((x, y, z), (roll, pitch, yaw))


def _read_folders(value: object) -> tuple[Path, ...]:
    return tuple(
        Path(folder).expanduser() for folder in read_text(value).split(os.pathsep) if folder
    )


@frozen(kw_only=True)
class RobotSettings:
    """The user's settings for one robot.

    Attributes:
        namespace: namespace of its controller manager, "" for the process's own.
    """

    namespace: str
    robot_description: str = setting("", "the URDF", _read_description, launches=False)
    spawn: tuple[str, ...] = setting(
        (), "controllers to start with the simulation, in this order", read_words, launches=False
    )
    spawn_required: bool = setting(
        True,
        "a controller that cannot start ends the simulation, instead of a warning",
        launches=False,
    )
    base: str = setting(
        "fixed",
        "how a root link other than 'world' is attached: bolted down, or standing free on its foot",
        choices=("fixed", "free"),
    )
    pose: "Pose | None" = setting(
        array("d"),
        'pose of the root in the world, in m and rad: "[x, y, z, roll, pitch, yaw]"',
        _read_pose,
    )
    on_floor: bool = setting(
        False, "a free robot stands on the floor at its pose, whatever its z", launches=False
    )
    package_path: tuple[Path, ...] = setting(
        "",
        "folders for package:// and $(find ...), separated by colons; searched after the model's "
        "own package and before its neighbours and the installed packages",
        _read_folders,
    )


@frozen(kw_only=True)
class _Namespaces:
    robots: tuple[str, ...] = setting(
        (), "namespaces of several robots; none for a single one", read_words
    )


def read_robots(parameters: Parameters) -> tuple[RobotSettings, ...]:
    """Return the single robot, or the robots that the parameter `robots` names.

    The name of a robot is the prefix of its parameters, and its namespace.

    Raises:
        ParameterValueError: a value is invalid, or a name occurs twice.
    """
    names = read_settings(_Namespaces, parameters).robots
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ParameterValueError(f"robots names '{twice}' twice; each needs its own namespace")
    prefixes = {name: f"{name}." for name in names} or {"": ""}
    return tuple(
        read_settings(RobotSettings, parameters, prefix, namespace=name)
        for name, prefix in prefixes.items()
    )


_read_above_zero = NumberReader("a finite number above 0", least=0.0, above=True)
_read_gain = NumberReader("a number from 0 to 1", least=0.0, most=1.0)
_SWITCH = ("true", "false")


@frozen(kw_only=True)
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


@frozen(kw_only=True)
class SimulationSettings(PhysicsSettings):
    """The user's settings for one simulation.

    Attributes:
        robots: the robots, at least one.
    """

    robots: tuple[RobotSettings, ...]
    world: str = setting(
        "empty",
        "empty, objects, shapes, pick, pick_and_place_demo, pick_demonstrations, house, or a "
        "MuJoCo XML or SDF file",
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
