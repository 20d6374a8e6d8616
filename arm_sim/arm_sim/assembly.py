"""One robot in its world with its controllers, put together as the node does it."""

import logging
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from arm_control.errors import ArmControlError
from arm_control.manager.controller_creation import MANAGER, ControllerStarter, manager_settings
from arm_control.manager.settings import ManagerSettings
from arm_gazebo.physics.tick import SilentClock, SimulationTick
from arm_gazebo.state.complete_state import CompleteState
from arm_sim.controllers import Controllers
from arm_sim.joints import Joints
from arm_sim.robots import AnyPath
from arm_sim.user_traceback import warn_caller

if TYPE_CHECKING:
    from arm_gazebo.run.robot import AssembledRobot
    from arm_gazebo.run.settings import SimulationSettings
    from arm_gazebo.run.world import AssembledWorld
    from arm_gazebo.world.changes import WorldChanges
    from arm_sim.cameras import RobotCameras
    from arm_sim.things import Things

logger = logging.getLogger("arm_sim")


class SimulationParts:
    """The parts of a simulation; those that take long to load are made when they are first used.

    Attributes:
        settings: its settings.
        manager_settings: the settings of the controller manager.
        robot: the robot with its manager.
        physics: the physics.
        joints: the states of the joints.
        controllers: the loaded controllers.
        tick: advances everything by one control period.
        state: the state of the run, which may be saved, restored and reset.
    """

    def __init__(
        self,
        settings: "SimulationSettings",
        manager_settings: ManagerSettings,
        robot: "AssembledRobot",
        world: "AssembledWorld",
        controllers: Controllers,
    ) -> None:
        self.settings = settings
        self.manager_settings = manager_settings
        self.robot = robot
        self.physics = world.simulation
        self.joints = Joints(self.physics)
        self.controllers = controllers
        self.tick = SimulationTick(
            [robot.manager], self.physics, SilentClock(), [], self.physics.timing.period_s
        )
        self.state = CompleteState(self.physics, [robot.manager])
        self._world = world

    @cached_property
    def things(self) -> "Things":
        """The things in the world."""
        from arm_sim.things import Things

        source = self._world.model_source(self.settings.spawn_limit)
        return Things(self.physics, [*self.robot.hardware, self.joints], source)

    @cached_property
    def cameras(self) -> "RobotCameras":
        """The cameras of the robot."""
        from arm_sim.cameras import RobotCameras

        settings = self.settings
        return RobotCameras(
            self.physics, self.robot.cameras, settings.render_backend, settings.seed
        )

    @property
    def world_name(self) -> str:
        """The name of the world."""
        return self._world.named.name

    @property
    def world_changes(self) -> "WorldChanges | None":
        """The changes to the world since it was built; None before anything could change it."""
        return self.things.changes if "things" in self.__dict__ else None

    def change_world(self, changes: "WorldChanges | None") -> None:
        """Restore the world's changes of an earlier time; the caller restores the states."""
        if changes is not self.world_changes:
            self.things.change_to(changes)

    def reseed(self, seed: int) -> None:
        """Give sensors and cameras the noise of another run."""
        for sensor in self.robot.sensors:
            sensor.reseed(seed)
        for component in self.robot.hardware:
            # The states still contain readings with the old noise.
            component.read(self.physics.time_s, self.physics.timing.period_s)
        self.cameras.reseed(seed)

    def close(self) -> None:
        """Deactivate and finalize controllers and components, and free the renderer."""
        self.robot.manager.shutdown()
        if "cameras" in self.__dict__:
            self.cameras.close()

    def start_controllers(self) -> None:
        """Start the controllers that the settings name.

        Raises:
            ArmControlError: one that the user named cannot start.
        """
        robot = self.settings.robots[0]
        for name in robot.spawn:
            try:
                self.controllers.start(name)
            except ArmControlError as error:
                if robot.spawn_required:
                    raise
                # The user did not name it; files for the real robot often have more controllers.
                logger.warning("%s does not start: %s", name, " ".join(str(error).split()))

    def log_findings(self) -> None:
        """Log what a tick itself must not log, as the node does."""
        for component in self.robot.hardware:
            for warning in component.take_warnings():
                logger.warning("%s", warning)
        for failure in self.physics.take_failures():
            logger.error("%s", failure)


def assemble(
    description: AnyPath,
    controllers: AnyPath | Mapping[str, Any] | None,
    arguments: Mapping[str, object],
    spawn: Iterable[str] | None,
    package_path: Iterable[AnyPath],
    settings: Mapping[str, object],
) -> SimulationParts:
    """Build a robot in its world, with its hardware in its initial state; see `set_up`.

    Raises:
        DescriptionError, GazeboError, ArmControlError, ParameterValueError: it cannot be built.
    """
    # Imported here, because it takes long, and a program may never build a simulation.
    from arm_gazebo.run.robot import AssembledRobot
    from arm_gazebo.run.world import assemble_world
    from arm_sim.set_up import set_up

    setup = set_up(description, controllers, arguments, spawn, package_path, settings)
    for remark in setup.remarks:
        logger.info("%s", remark)
    if setup.left_out:
        warn_caller(setup.left_out)
    chosen, name = setup.settings, f"/{MANAGER}"
    manager = manager_settings(setup.parameters)
    robot = AssembledRobot(chosen.robots[0])
    world = assemble_world([robot], chosen, {name: manager.update_rate})
    robot.drive(world.simulation, chosen.seed, manager, name)
    starter = ControllerStarter(robot.manager, setup.parameters, robot.document)
    return SimulationParts(chosen, manager, robot, world, Controllers(robot.manager, starter))
