"""Where a message's parts stand, and where it ends, judged by rosbags' own serialisation."""

import importlib

import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.typesys import Stores, get_typestore
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_node.workarounds.cdr_layout import CdrLayout
from arm_node.workarounds.message_template import MessageTemplate

PACKAGES = ("geometry_msgs", "sensor_msgs", "std_msgs", "trajectory_msgs", "shape_msgs")
STORE = get_typestore(Stores.ROS2_JAZZY)


def name_of(kind: type) -> str:
    return f"{kind.__module__.partition('.')[0]}/msg/{kind.__name__}"


def defaults():
    for package in PACKAGES:
        module = importlib.import_module(f"{package}.msg")
        yield from (getattr(module, name)() for name in dir(module) if name[0].isupper())


POINT = JointTrajectoryPoint(positions=[1.0, 2.0], velocities=[3.0, 4.0])
FILLED = [
    JointState(name=["a", "è"], position=[1.0, 2.0]),
    JointTrajectory(joint_names=["a", "b"], points=[POINT, POINT]),
    PointCloud2(fields=[PointField(name="x")], data=bytes(range(7))),
]


def test_it_ends_where_rosbags_ends():
    for message in [*defaults(), *FILLED]:
        name = name_of(type(message))
        end = CdrLayout(message).end
        data = serialize_message(message)[:end]
        assert deserialize_message(data, type(message)) == message
        assert len(STORE.serialize_cdr(STORE.deserialize_cdr(data, name), name)) == end, name


def test_numbers_stand_where_it_says():
    message = JointState(name=["a", "b"], position=[1.5, 2.5], effort=[3.5, 4.5])
    message.header.stamp.nanosec = 7
    data, begins = serialize_message(message), CdrLayout(message).begins
    for field, values in (("position", [1.5, 2.5]), ("velocity", []), ("effort", [3.5, 4.5])):
        at = begins[id(message), field]
        assert np.frombuffer(data[at:], "<f8", len(values)).tolist() == values
    at = begins[id(message.header.stamp), "nanosec"]
    assert int.from_bytes(data[at : at + 4], "little") == 7


@pytest.mark.parametrize(
    "message", [JointState(name=["a"], position=[1.0]), Float64MultiArray(), FILLED[1], TFMessage()]
)
def test_what_is_published_has_nothing_behind_its_end(message):
    """A bag of such messages is read by rosbags, too."""
    data = MessageTemplate(message).to_bytes()
    assert len(data) == CdrLayout(message).end
    STORE.deserialize_cdr(data, name_of(type(message)))
