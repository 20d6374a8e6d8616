"""The settings of a simulation, read and checked once."""

from dataclasses import dataclass, replace

from arm_gazebo.mjcf.size import SPAWN_LIMIT, WORLD_LIMIT, MemoryLimit
from arm_gazebo.rendering.backend_selection import PREFERENCES
from arm_gazebo.run.robot_settings import Parameters, RobotSettings, read_robots
from arm_node.parameter_values import (
    NumberReader,
    one_of,
    read_flag,
    read_integer,
    read_non_negative,
    read_text,
    read_words,
)

PARTNERS = "stamped topics, or nodes by their ~/tick_done, that answer each control period first"
read_above_zero = NumberReader("a finite number above 0", least=0.0, above=True)
_read_gain = NumberReader("a number from 0 to 1", least=0.0, most=1.0)
LONGEST_SILENCE = "seconds of wall time without an answer after which the simulation is paused"


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """The user's settings for one simulation.

    Attributes:
        robots: the robots, at least one.
        world: a shipped world's name, or the path of a MuJoCo XML or SDF file.
        real_time_factor: ratio of simulation time to wall time; 0 is as fast as possible.
        physics_step_s: physics step; None to derive it from the control rate.
        paused: whether the simulation starts paused.
        lockstep: topics or nodes that answer each control period before the next one begins.
        lockstep_timeout_s: longest wait for such an answer, in wall time.
        hold_joints: whether joints that no controller claims hold their position.
        position_proportional_gain: fraction of the distance to a position command that a joint's
            set-point moves in a control period; 0 to move as fast as the joint can.
        self_collide: whether a robot's links collide with each other.
        strict: whether a missing mesh is an error instead of a box.
        render_backend: render backend of the cameras.
        seed: seed of the sensors' noise.
        world_limit: limit on the memory of a world's MJCF.
        spawn_limit: limit on the memory of a spawned MJCF.
        headless: False to open a window.
        reset_clock: whether a reset sets the clock to zero.
        record_run: file to record the run to, from its start; "" for none.
    """

    robots: tuple[RobotSettings, ...]
    world: str
    real_time_factor: float
    physics_step_s: float | None
    paused: bool
    lockstep: tuple[str, ...]
    lockstep_timeout_s: float
    hold_joints: bool
    position_proportional_gain: float
    self_collide: bool
    strict: bool
    render_backend: str
    seed: int
    headless: bool
    reset_clock: bool
    record_run: str
    world_limit: MemoryLimit
    spawn_limit: MemoryLimit


def read_settings(value: Parameters) -> SimulationSettings:
    """Return the settings from the values of parameters.

    Raises:
        ParameterValueError: a value is invalid; the message names it and the valid values.
    """
    return SimulationSettings(
        robots=read_robots(value),
        world=value(
            "world", "empty", read_text, "a shipped world's name, or a file: MuJoCo XML, SDF"
        ),
        real_time_factor=value(
            "real_time_factor",
            1.0,
            read_non_negative,
            "ratio of simulation time to wall time; 0 is as fast as possible",
            read_only=False,
        ),
        physics_step_s=value(
            "physics_step", 0.0, read_non_negative, "step in seconds; 0 chooses one up to 2 ms"
        )
        or None,
        paused=value("paused", False, read_flag, "start paused"),
        lockstep=value("lockstep", (), read_words, PARTNERS),
        lockstep_timeout_s=value(
            "lockstep_timeout", 10.0, read_above_zero, LONGEST_SILENCE, read_only=False
        ),
        hold_joints=value("hold_joints", True, read_flag, "unclaimed joints hold their position"),
        position_proportional_gain=value(
            "position_proportional_gain",
            0.0,
            _read_gain,
            "from 0 to 1, as gz_ros2_control's; 0 moves joints as fast as they can",
        ),
        self_collide=value("self_collide", False, read_flag, "links of a robot collide"),
        strict=value("strict", False, read_flag, "a missing mesh is an error"),
        render_backend=value(
            "render_backend",
            "auto",
            one_of(PREFERENCES),
            f"render backend of the cameras: {', '.join(PREFERENCES)}; OpenGL (egl, osmesa) draws "
            "round shapes with flat faces, 0.5 mm too deep in the median for a ball of 60 mm "
            "radius, raycast draws them exactly",
        ),
        seed=value("seed", 0, read_integer, "seed of the sensors' noise"),
        world_limit=_limit(value, WORLD_LIMIT, "a world's"),
        spawn_limit=_limit(value, SPAWN_LIMIT, "a spawned"),
        headless=value("headless", True, read_flag, "false opens a window"),
        reset_clock=value(
            "reset_clock", True, read_flag, "a reset sets the clock to zero", read_only=False
        ),
        record_run=value(
            "record_run",
            "",
            read_text,
            "file to record the run to from now on; '' ends it",
            read_only=False,
        ),
    )


def _limit(value: Parameters, default: MemoryLimit, whose: str) -> MemoryLimit:
    description = f"limit on the memory of {whose} MJCF in MB"
    mb = value(default.parameter, default.mb, read_non_negative, description)
    return replace(default, mb=mb)
