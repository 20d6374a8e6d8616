"""What rebuilds a run: its robots, its model, its settings, and what it was made with."""

from dataclasses import dataclass

from arm_control.manager.settings import ManagerSettings
from arm_gazebo.errors import RecordingError
from arm_gazebo.model.saved_model import SavedModel
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.recording.run_file import RunFile
from arm_gazebo.run.robot import AssembledRobot
from arm_gazebo.run.robot_settings import RobotSettings


@dataclass(frozen=True, slots=True)
class RecordedRobot:
    """A robot of a recorded run.

    Attributes:
        settings: the robot's settings, its URDF among them.
        manager: the settings of its controller manager.
        manager_name: fully qualified name of the manager's node.
    """

    settings: RobotSettings
    manager: ManagerSettings
    manager_name: str


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """What rebuilds a run at its beginning.

    Attributes:
        model: the model of the world with its robots, before a simulation changed it.
        timing: control period and physics step.
        hold_joints: see `Physics`.
        proportional_gain: see `Physics`.
        seed: seed of the sensors' noise.
        robots: the robots.
    """

    model: SavedModel
    timing: PhysicsTiming
    hold_joints: bool
    proportional_gain: float
    seed: int
    robots: tuple[RecordedRobot, ...]


def run_of(file: RunFile) -> RecordedRun:
    """Return what rebuilds the run of a file.

    Raises:
        RecordingError: the file does not say that.
    """
    run = file.header.get("run")
    if not isinstance(run, RecordedRun):
        raise RecordingError(f"{file.path} does not say how to build its run")
    return run


def rebuild(run: RecordedRun) -> tuple[Physics, list[AssembledRobot]]:
    """Build a run again, as the simulation node does, without ROS.

    Raises:
        GazeboError, ArmControlError, DescriptionError: it cannot be built with what is here.
    """
    simulation = Physics(run.model.load(), run.timing, run.hold_joints, run.proportional_gain)
    robots = [AssembledRobot(robot.settings) for robot in run.robots]
    for robot, recorded in zip(robots, run.robots, strict=True):
        robot.drive(simulation, run.seed, recorded.manager, recorded.manager_name)
    return simulation, robots
