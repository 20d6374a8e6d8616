"""Converts a program's arguments to the settings of the simulation."""

import shlex
from collections.abc import Mapping
from os import fspath, pathsep
from typing import Any

from arm_control.manager.controller_creation import MANAGER, ControllerStarter, manager_settings
from arm_control.manager.parameter_file import ParametersByNode
from arm_gazebo.launching.controllers_file import read_controllers
from arm_gazebo.launching.robot_setup import SPAWN_AUTO, RobotSetup, set_up_robot
from arm_gazebo.run.robot import ManagedRobot
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.run.settings import SimulationSettings, simulation_settings
from arm_node.frozen import frozen
from arm_node.setting import given_values
from arm_sim.arguments import SimulationArguments
from arm_sim.robots import NAMED_ROBOTS, AnyPath, NamedRobot


@frozen
class SimulationSetup:
    """A robot and a simulation, ready to be built.

    Attributes:
        settings: the settings of the simulation with its one robot.
        parameters: the parameters of the controller manager and its controllers.
        remarks: one sentence for each default that was added.
        left_out: names the controllers of types that the suite does not have; empty for none.
        moveit_config: URI of the robot's MoveIt configuration, "" if it has none.
    """

    settings: SimulationSettings
    parameters: ParametersByNode
    remarks: tuple[str, ...]
    left_out: str
    moveit_config: str

    def build(self) -> tuple[SimulationRun, ControllerStarter]:
        """Return the run, and what starts its controllers.

        Raises:
            DescriptionError, GazeboError, ArmControlError: it cannot be built.
        """
        manager = manager_settings(self.parameters)
        run = SimulationRun.of(
            self.settings, [ManagedRobot(self.settings.robots[0], manager, f"/{MANAGER}")]
        )
        starter = ControllerStarter(run.robot.manager, self.parameters, run.robot.document)
        return run, starter


def set_up(given: SimulationArguments) -> SimulationSetup:
    """Read the robot, and add the defaults that the launch files add.

    Raises:
        SimSettingsError, DescriptionError, ParameterError, ParameterValueError: an argument is
            invalid.
    """
    named = NAMED_ROBOTS.get(fspath(given.description))
    robot = named or NamedRobot(fspath(given.description), "", ())
    own_spawn = robot.spawn if named and given.controllers is None else None
    names = own_spawn if given.spawn is None else given.spawn
    setup = set_up_robot(
        robot.model,
        assignments({**robot.arguments, **(given.arguments or {})}),
        _controllers(robot, given.controllers),
        SPAWN_AUTO if names is None else ",".join(names),
        pathsep.join(fspath(folder) for folder in given.package_path),
    )
    return SimulationSetup(
        simulation_settings(given_values(_values(setup, robot, given))),
        ParametersByNode(read_controllers(setup.controllers), _source(setup)),
        setup.remarks,
        setup.left_out,
        robot.moveit_config,
    )


def _controllers(
    robot: NamedRobot, given: AnyPath | Mapping[str, Any] | None
) -> str | Mapping[str, Any]:
    if given is None:
        return robot.controllers
    return given if isinstance(given, Mapping) else fspath(given)


def _values(
    setup: RobotSetup, robot: NamedRobot, arguments: SimulationArguments
) -> dict[str, object]:
    """Return the values of the simulation node's parameters."""
    given = {name: value for name, value in arguments.parameters().items() if value is not None}
    return {"world": robot.world, "pose": robot.pose, **given, **setup.parameters()}


def assignments(arguments: Mapping[str, object]) -> str:
    """Return xacro arguments as one text, "a:=1 b:=2"."""
    return shlex.join(f"{name}:={_word(value)}" for name, value in arguments.items())


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _source(setup: RobotSetup) -> str:
    is_file = not isinstance(setup.controllers, Mapping)
    return f"parameter file '{setup.controllers}'" if is_file else "the controllers' parameters"
