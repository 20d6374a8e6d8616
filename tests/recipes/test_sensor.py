"""The recipe for a sensor: `magnetometer`, MuJoCo's own."""

import pytest
from checkout import Checkout

SENSOR = '''\
"""A magnetometer: the magnetic field in the sensor's axes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Robot
from arm_gazebo.sensors.link_sensor import LinkSensor, Measurement, SensorTopic
from arm_gazebo.sensors.tags import SensorTags


@dataclass(frozen=True, slots=True)
class Magnetometer(LinkSensor):
    """A magnetometer; a reading is the field along x, y, z, in T."""

    type: ClassVar[str] = "magnetometer"
    channels: ClassVar[tuple[str, ...]] = ("field.x", "field.y", "field.z")

    @classmethod
    def read(cls, tags: SensorTags, robot: Robot) -> "Magnetometer":
        """Return the sensor that the tags describe."""
        pose = tags.pose()
        return cls(
            name=tags.name,
            link=tags.reference,
            frame_id=tags.frame(tags.reference),
            topic=tags.own_topics()[0],
            rate_hz=tags.rate_hz(),
            rpy=(pose[3], pose[4], pose[5]),
        )

    def topics(self) -> Sequence[SensorTopic]:
        """Return the topic of the field."""
        return (SensorTopic("sensor_msgs/msg/MagneticField", ("magnetic_field",)),)

    def measurements(self) -> Sequence[Measurement]:
        """Return the measurement of the field."""
        sensor, site = mujoco.mjtSensor.mjSENS_MAGNETOMETER, mujoco.mjtObj.mjOBJ_SITE
        return [Measurement("field", sensor, site, self.key)]

    def reading(
        self, measured: NDArray[np.float64], state: mujoco.MjData
    ) -> NDArray[np.float64]:
        """Return the channels."""
        return measured
'''

URDF = """\
<robot name="box">
  <link name="box">
    <inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <gazebo reference="box">
    <sensor name="compass" type="magnetometer">
      <update_rate>10</update_rate><topic>field</topic><pose>0 0 0 0 0 1.5707963267948966</pose>
    </sensor>
  </gazebo>
</robot>
"""

READ = """\
from arm_description import parse_urdf
from arm_gazebo.hardware.simulated_sensors import SimulatedSensor
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.sensors.reader import parse_link_sensors
from arm_gazebo.physics_timing import physics_timing

text = open(sys.argv[1]).read()
robot = parse_urdf(text)
sensors = parse_link_sensors(text, robot)
timing = physics_timing(100.0)
options = BuildOptions(step_s=timing.step_s)
built = build_model(robot, (), (), "empty", options, sensors=sensors)
sensor = SimulatedSensor(Physics(built, timing, True), sensors[0])
reading = sensor.read()
"""

# MuJoCo's field points to -y, half a tesla strong; the sensor's x points to y.
PRINT = """\
assert "rclpy" not in sys.modules
print(sensor.description.rate_hz, *(round(float(value), 6) + 0.0 for value in reading))
"""

PUBLISH = """\
import rclpy
from sensor_msgs.msg import MagneticField
from arm_gazebo.ros.sensor_publisher import SensorPublisher

rclpy.init()
node = rclpy.create_node("recipe")
heard = []
node.create_subscription(MagneticField, "field", heard.append, 10)
sink = SensorPublisher(node, sensor.description)
while not heard:
    if sink.wanted():
        sink.publish(1.5, reading)
    rclpy.spin_once(node, timeout_sec=0.1)
header, field = heard[0].header, heard[0].magnetic_field
print(header.frame_id, header.stamp.sec, header.stamp.nanosec, round(field.x, 6))
node.destroy_node()
rclpy.shutdown()
"""


@pytest.fixture
def checkout(tmp_path):
    checkout = Checkout(tmp_path, "A sensor", NAME="magnetometer")
    folder = "arm_gazebo/arm_gazebo/sensors"
    checkout.write(f"{folder}/magnetometer.py", SENSOR)
    checkout.insert(
        f"{folder}/reader.py",
        (
            "from arm_gazebo.sensors.link_sensor import LinkSensor\n",
            "from arm_gazebo.sensors.link_sensor import LinkSensor\n"
            "from arm_gazebo.sensors.magnetometer import Magnetometer\n",
        ),
        ("ForceTorqueSensor, ContactSensor)", "ForceTorqueSensor, ContactSensor, Magnetometer)"),
    )
    return checkout


@pytest.fixture
def urdf(tmp_path):
    file = tmp_path / "box.urdf"
    file.write_text(URDF)
    return str(file)


def test_a_sensor_is_added_through_the_files_of_its_recipe(checkout, urdf):
    assert checkout.run(READ + PRINT, urdf) == "10.0 -0.5 0.0 0.0\n"


@pytest.mark.ros
def test_its_readings_are_published_as_its_message(checkout, urdf):
    assert checkout.run(READ + PUBLISH, urdf) == "box 1 500000000 -0.5\n"
