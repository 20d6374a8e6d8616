"""One robot of the simulation: its hardware, and the controller manager that drives it."""

import logging
from collections.abc import Sequence
from dataclasses import replace

from rclpy.executors import Executor

from arm_control.clock import Clock
from arm_control.control_loop import ControlLoop
from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.hardware_info import parse_hardware_info
from arm_control.ros.configured_manager import bring_up, configured_manager
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_control.ros.controller_manager_server import ControllerManagerServer
from arm_description.urdf import parse_urdf
from arm_gazebo.errors import SettingsError
from arm_gazebo.hardware.instrument import Instrument
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import RobotInWorld
from arm_gazebo.ros.robot_settings import RobotSettings
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_gazebo.sensors.reader import parse_link_sensors

logger = logging.getLogger(__name__)


class ManagedRobot:
    """Made in the order of its methods: node, model, hardware and manager, services.

    Args:
        settings: of the robot.
        arguments: ROS arguments of the process.
        clock: simulation time.

    Raises:
        SettingsError, DescriptionError, ArmControlError: nothing says what is commanded, or not
            in a way that makes sense.
    """

    def __init__(self, settings: RobotSettings, arguments: Sequence[str], clock: Clock) -> None:
        self._settings = settings
        self._server: ControllerManagerServer | None = None
        self._hardware_info = parse_hardware_info(settings.robot_description)
        if not self._hardware_info:
            raise SettingsError(
                "the robot description has no <ros2_control> block, so nothing says which joints "
                "are commanded; add one with a <joint> and its interfaces for each"
            )
        self.cameras = tuple(
            _in_namespace(camera, settings.namespace)
            for camera in parse_cameras(settings.robot_description)
        )
        self._robot = parse_urdf(settings.robot_description)
        self._sensors = tuple(
            replace(sensor, topic=_below(settings.namespace, sensor.topic))
            for sensor in parse_link_sensors(settings.robot_description, self._robot)
        )
        self.node = ControllerManagerNode(arguments, namespace=settings.namespace, clock=clock)

    def in_world(self, options: BuildOptions) -> RobotInWorld:
        """Return the robot as the model's builder takes it.

        Args:
            options: what the user chose for all robots.
        """
        settings = self._settings
        return RobotInWorld(
            self._robot,
            self._hardware_info,
            self.cameras,
            replace(
                options,
                base="free" if settings.base == "free" else "fixed",
                spawn=settings.pose,
                package_path=settings.package_path,
            ),
            parse_gazebo_tags(settings.robot_description),
            self._sensors,
        )

    def drive(self, simulation: Simulation, seed: int) -> None:
        """Make hardware, sensors and manager, before the loop runs.

        Args:
            simulation: has the robot.
            seed: of the sensors' noise.
        """
        self.instruments = [Instrument(simulation, sensor, seed) for sensor in self._sensors]
        self.hardware = [
            SimulatedHardware(simulation, info, self.instruments) for info in self._hardware_info
        ]
        description = self._settings.robot_description
        self.manager = configured_manager(self.hardware, self.node, description)
        bring_up(self.manager, self.node.settings)

    def serve(self, loop: ControlLoop, executor: Executor) -> None:
        """Offer the manager's services, and start the controllers that are asked for.

        Raises:
            ArmControlError: one that is required cannot be started.
        """
        self._server = ControllerManagerServer(
            self.node,
            self.manager,
            loop,
            executor,
            robot_description=self._settings.robot_description,
        )
        for name in self._settings.spawn:
            try:
                self._server.start_controllers((name,))
            except LoopStoppedError:
                raise
            except ArmControlError as error:
                if self._settings.spawn_required:
                    raise
                # Nobody named it: a file is often of the real robot, which has more.
                reason = " ".join(str(error).split())
                logger.warning("%s does not start: %s", name, reason)

    def shutdown(self) -> None:
        """Serve no more; the loop still runs."""
        if self._server is not None:
            self._server.shutdown()

    def destroy_nodes(self) -> None:
        """Destroy every node of the robot; the loop has ended."""
        if self._server is None:
            self.node.destroy_node()
        else:
            self._server.destroy_nodes()


def _in_namespace(camera: CameraSensor, namespace: str) -> CameraSensor:
    """Return a camera whose name and relative topics are told from those of other robots."""
    if not namespace:
        return camera

    def below(topics: Sequence[str]) -> tuple[str, ...]:
        return tuple(_below(namespace, topic) for topic in topics)

    return replace(
        camera,
        name=f"{namespace}_{camera.name}",
        image_topics=below(camera.image_topics),
        info_topics=below(camera.info_topics),
        depth_topics=below(camera.depth_topics),
        points_topics=below(camera.points_topics),
    )


def _below(namespace: str, topic: str) -> str:
    return topic if topic.startswith("/") or not namespace else f"{namespace}/{topic}"
