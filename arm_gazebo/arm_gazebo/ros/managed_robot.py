"""One robot of the simulation with the ROS half of its controller manager."""

import logging
from collections.abc import Sequence

from rclpy.executors import Executor

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_manager_server import ControllerManagerServer
from arm_gazebo.physics.physics import Physics
from arm_gazebo.run.robot import AssembledRobot
from arm_gazebo.run.robot_settings import RobotSettings
from arm_node.workarounds.clocks import ProcessClock

logger = logging.getLogger("controller_manager")


class ManagedRobot:
    """One robot with its controller manager; call its methods in the order below.

    Attributes:
        robot: the robot itself.
        node: the manager's node.

    Args:
        settings: settings of the robot.
        arguments: ROS arguments of the process.
        clock: simulation time.

    Raises:
        SimSettingsError, DescriptionError, ArmControlError: the description has no hardware, or is
            invalid.
    """

    def __init__(
        self, settings: RobotSettings, arguments: Sequence[str], clock: ProcessClock
    ) -> None:
        self._settings = settings
        self._server: ControllerManagerServer | None = None
        self.robot = AssembledRobot(settings)
        self.node = ControllerManagerNode(arguments, namespace=settings.namespace, clock=clock)

    def drive(self, simulation: Physics, seed: int) -> None:
        """Create hardware, sensors and manager before the loop runs.

        Args:
            simulation: the simulation that contains the robot.
            seed: seed of the sensors' noise.
        """
        node = self.node
        self.robot.drive(simulation, seed, node.settings, node.get_fully_qualified_name())

    def serve(self, loop: ControlLoop, executor: Executor) -> None:
        """Create the manager's services and start the requested controllers.

        Raises:
            ArmControlError: a required controller cannot start.
        """
        self._server = ControllerManagerServer(
            self.node,
            self.robot.manager,
            loop,
            executor,
            robot_description=self.robot.document,
        )
        for name in self._settings.spawn:
            try:
                self._server.start_controllers((name,))
            except LoopStoppedError:
                raise
            except ArmControlError as error:
                if self._settings.spawn_required:
                    raise
                # The user did not name it; files for the real robot often have more controllers.
                reason = " ".join(str(error).split())
                logger.warning("%s does not start: %s", name, reason)

    def shutdown(self) -> None:
        """Stop the services; the loop still runs."""
        if self._server is not None:
            self._server.shutdown()

    def destroy_nodes(self) -> None:
        """Destroy every node of the robot after the loop has ended."""
        if self._server is None:
            self.node.destroy_node()
        else:
            self._server.destroy_nodes()
