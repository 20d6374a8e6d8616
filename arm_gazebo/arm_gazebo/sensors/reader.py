"""The sensors of a URDF that MuJoCo reads: IMUs, force-torque and contact sensors."""

from dataclasses import replace

from arm_description.robot import Robot
from arm_description.xml_document import parse_xml
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.force_torque import ForceTorqueSensor
from arm_gazebo.sensors.imu import ImuSensor
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.tags import SensorTags, sensor_elements, sensor_type, told_apart

LINK_SENSOR_TYPES = ("imu", "force_torque", "contact")


def parse_link_sensors(
    urdf_xml: str, robot: Robot, source: str = "robot_description"
) -> tuple[LinkSensor, ...]:
    """Return the sensors of a description, in document order; cameras are read elsewhere.

    Args:
        urdf_xml: the description.
        robot: the same, parsed.
        source: what the text is called in messages.

    Raises:
        SensorError: a value is nonsense; the message names sensor, element and line.
        XmlError: the text is not XML.
    """
    sensors: list[LinkSensor] = []
    for reference, element in sensor_elements(parse_xml(urdf_xml, source)):
        kind = sensor_type(element)
        if kind not in LINK_SENSOR_TYPES:
            continue
        tags = SensorTags(element, reference, kind)
        sensor = _read(tags, robot)
        for other in sensors:
            if other.key == sensor.key:
                raise tags.error(
                    "sensor",
                    f"a second sensor of this name on link {sensor.link!r}; each needs its own",
                )
            if other.topic == sensor.topic:
                raise tags.topic_error(sensor.topic, "sensor", other)
        sensors.append(sensor)
    names = told_apart(sensors)
    return tuple(replace(s, name=name) for s, name in zip(sensors, names, strict=True))


def _read(tags: SensorTags, robot: Robot) -> LinkSensor:
    if tags.type == "force_torque":
        joints = {joint.name: joint for joint in robot.joints}
        tags.check_reference("joint", joints)
        return ForceTorqueSensor.read(tags, joints[tags.reference])
    tags.check_reference("link", [link.name for link in robot.links])
    return ImuSensor.read(tags) if tags.type == "imu" else ContactSensor.read(tags)
