"""`arm launch arm_control arm_mock.launch.py`: the arm's controllers without physics."""

import pytest

pytestmark = pytest.mark.ros


def test_the_mock_arm_does_at_once_what_it_is_told(launch, client):
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float64MultiArray

    launched = launch("arm_control", "arm_mock.launch.py")
    launched.wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    commands.publish(Float64MultiArray(data=[0.1, 0.2, 0.3, 0.4]))
    states.wait_until(
        lambda m: bool(m) and list(m[-1].position) == [0.1, 0.2, 0.3, 0.4], "the pose"
    )
    assert states.messages[-1].name == ["j0", "j1", "j2", "j3"]
    assert launched.stop() == 0
