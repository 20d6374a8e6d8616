"""Read the sensors of a URDF that MuJoCo computes: IMUs, force-torque and contact sensors."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from arm_description.urdf.description import Description, as_description
from arm_description.urdf.element import UrdfElement
from arm_description.urdf.robot import Robot
from arm_gazebo.build_report import Finding
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.force_torque import ForceTorqueSensor
from arm_gazebo.sensors.imu import ImuSensor
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.tags import SensorTags, unique_names

SENSORS: Mapping[str, type[LinkSensor]] = {
    sensor.type: sensor for sensor in (ImuSensor, ForceTorqueSensor, ContactSensor)
}
"""The sensors that MuJoCo computes, by Gazebo's name of their type."""

TYPES: Mapping[str, str] = {
    "camera": "camera",
    "depth": "depth_camera",
    "depth_camera": "depth_camera",
    "rgbd": "rgbd_camera",
    "rgbd_camera": "rgbd_camera",
    **{name: name for name in SENSORS},
}
"""The simulated types by Gazebo's names, older names included."""


def sensor_type(element: UrdfElement) -> str | None:
    """Return the type of a `<sensor>` element; None if it is not simulated."""
    return TYPES.get(element.text("type"))


def parse_link_sensors(
    description: Description,
    robot: Robot,
    note: Callable[[Finding], None] = lambda _finding: None,
) -> tuple[LinkSensor, ...]:
    """Return the sensors of a description except cameras, in document order.

    `note` receives what is doubtful or not read.

    Raises:
        SensorError: a value is invalid; the message names sensor, element and line.
        XmlError: the text is not XML.
    """
    sensors: list[LinkSensor] = []
    for reference, element in as_description(description).sensors:
        kind = sensor_type(element) or ""
        sensor_class = SENSORS.get(kind)
        if sensor_class is None:
            continue
        tags = SensorTags(element, reference, kind)
        known = robot.joints if sensor_class.reference == "joint" else robot.links
        tags.check_reference(sensor_class.reference, [part.name for part in known])
        sensor = sensor_class.read(tags, robot)
        for other in sensors:
            if other.key == sensor.key:
                raise tags.error(
                    "sensor",
                    f"a second sensor of this name on link {sensor.link!r}; each needs its own",
                )
            if other.topic == sensor.topic:
                raise tags.topic_error(sensor.topic, "sensor", other)
        sensors.append(sensor)
        for finding in tags.findings():
            note(finding)
    names = unique_names(sensors)
    return tuple(replace(s, name=name) for s, name in zip(sensors, names, strict=True))
