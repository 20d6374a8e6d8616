"""One robot of the simulation: its description, its hardware and its controller manager."""

import logging
from collections.abc import Callable, Sequence
from dataclasses import replace

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.hardware.info import parse_hardware_info
from arm_control.manager.controller_manager import ControllerManager, bring_up, configured_manager
from arm_control.manager.settings import ManagerSettings
from arm_description.resources import ResourceFinder
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.hardware.simulated_sensors import SimulatedSensor
from arm_gazebo.physics.physics import Physics
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions, RobotInWorld
from arm_gazebo.run.settings import RobotSettings
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_gazebo.sensors.reader import parse_link_sensors
from arm_node.frozen import frozen


@frozen
class ManagedRobot:
    """A robot and its controller manager, as their user wants them.

    Attributes:
        settings: the robot's settings, its URDF among them.
        manager: the settings of its controller manager.
        manager_name: fully qualified name of the manager's node, for messages.
    """

    settings: RobotSettings
    manager: ManagerSettings
    manager_name: str


class SimulatedRobot:
    """One robot; call `in_world` to build the world, then `drive` with its physics.

    Attributes:
        managed: its settings and those of its manager.
        document: the parsed description.
        cameras: its cameras, with names and topics that are unique among all robots.
        sensors: its running sensors, from `drive` on.
        hardware: its hardware components, from `drive` on.
        manager: its controller manager, from `drive` on.
    """

    sensors: Sequence[SimulatedSensor]
    hardware: Sequence[SimulatedHardware]
    manager: ControllerManager

    def __init__(self, managed: ManagedRobot) -> None:
        """Read the description.

        Raises:
            SimSettingsError, DescriptionError, ArmControlError, GazeboError: it has no hardware,
                or is invalid.
        """
        self.managed, settings = managed, managed.settings
        self.document = RobotDescription(settings.robot_description)
        self._hardware_info = parse_hardware_info(self.document)
        if not self._hardware_info:
            raise SimSettingsError(
                "the robot description has no <ros2_control> block, so no joint can be commanded; "
                "add one with a <joint> and its interfaces for each joint"
            )
        self.cameras = tuple(
            _in_namespace(camera, settings.namespace) for camera in parse_cameras(self.document)
        )
        self._robot = parse_urdf(self.document)
        self._sensors = tuple(
            replace(sensor, topic=_below(settings.namespace, sensor.topic))
            for sensor in parse_link_sensors(self.document, self._robot)
        )

    def in_world(self, options: BuildOptions) -> RobotInWorld:
        """Return the robot for the model builder, with the user's choices for all robots."""
        settings = self.managed.settings
        return RobotInWorld(
            self._robot,
            self._hardware_info,
            self.cameras,
            replace(
                options,
                base="free" if settings.base == "free" else "fixed",
                spawn=settings.pose,
                on_floor=settings.on_floor,
                resources=ResourceFinder.of_description(
                    settings.robot_description, settings.package_path
                ),
            ),
            parse_gazebo_tags(self.document),
            self._sensors,
        )

    def drive(self, physics: Physics, seed: int) -> None:
        """Create hardware, sensors and manager before the first tick.

        Raises:
            ArmControlError: a component does not reach its initial state.
        """
        managed = self.managed
        self.sensors = [SimulatedSensor(physics, sensor, seed) for sensor in self._sensors]
        self.hardware = [
            SimulatedHardware(physics, info, self.sensors) for info in self._hardware_info
        ]
        self.manager = configured_manager(
            self.hardware, managed.manager, self.document, managed.manager_name
        )
        bring_up(self.manager, managed.manager)

    def start_controllers(self, start: Callable[[str], object], logger: logging.Logger) -> None:
        """Start the controllers that the settings name.

        The log has those that cannot start and that the user did not name.

        Raises:
            ArmControlError: one that the user named cannot start.
        """
        for name in self.managed.settings.spawn:
            try:
                start(name)
            except LoopStoppedError:
                raise
            except ArmControlError as error:
                if self.managed.settings.spawn_required:
                    raise
                # Files for the real robot often have more controllers.
                logger.warning("%s does not start: %s", name, " ".join(str(error).split()))


def _in_namespace(camera: CameraSensor, namespace: str) -> CameraSensor:
    """Return a camera whose name and relative topics are unique among all robots."""
    if not namespace:
        return camera
    topics = {
        kind: tuple(_below(namespace, topic) for topic in getattr(camera, kind))
        for kind in ("image_topics", "info_topics", "depth_topics", "points_topics")
    }
    return replace(camera, name=f"{namespace}_{camera.name}", **topics)


def _below(namespace: str, topic: str) -> str:
    return topic if topic.startswith("/") or not namespace else f"{namespace}/{topic}"
