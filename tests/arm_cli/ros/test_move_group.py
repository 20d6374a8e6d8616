"""What `arm move` says where a part of the robot is silent; no node runs."""

from types import SimpleNamespace

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from arm_cli.errors import UnansweredError
from arm_cli.ros.move_group import MoveGroupClient


class SilentSession:
    """A session in whose graph these topics, and no others, have sent one message."""

    def __init__(self, messages):
        self.messages = messages
        self.node = SimpleNamespace(create_subscription=self.subscribe)

    def subscribe(self, _type, topic, take, _qos):
        if topic in self.messages:
            take(self.messages[topic])

    def full_name(self, name):
        return name

    def wait_until(self, condition, _notice=None, timeout_s=None):
        return condition()


def test_a_robot_whose_description_alone_is_missing_has_no_state_publisher():
    session = SilentSession({"/robot_description_semantic": String(data="<robot/>")})
    with pytest.raises(UnansweredError) as silent:
        MoveGroupClient(session, "").model()
    assert str(silent.value) == (
        "nobody publishes /robot_description: does robot_state_publisher run?"
    )


def test_silent_joint_states_are_not_said_to_lack_a_joint():
    with pytest.raises(UnansweredError, match=r"^no message arrived on /joint_states$"):
        MoveGroupClient(SilentSession({}), "").positions(["j1"])


def test_a_joint_that_is_missing_in_the_joint_states_is_named():
    session = SilentSession({"/joint_states": JointState(name=["j1"], position=[0.5])})
    with pytest.raises(UnansweredError, match=r"^/joint_states has no position of j2$"):
        MoveGroupClient(session, "").positions(["j1", "j2"])
    assert MoveGroupClient(session, "").positions(["j1"]) == {"j1": 0.5}
