"""`arm launch yahboom_rosmaster_description robot_state_publisher.launch.py`: its wheels turn."""

import pytest

pytestmark = pytest.mark.ros

WHEELS = {f"{end}_{side}_wheel_link" for end in ("front", "back") for side in ("left", "right")}


def test_the_wheels_are_where_the_joint_states_say(launch, client):
    from sensor_msgs.msg import JointState
    from tf2_msgs.msg import TFMessage

    launch(
        "yahboom_rosmaster_description",
        "robot_state_publisher.launch.py",
        "jsp_gui:=false",
        "use_rviz:=false",
    ).wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    frames = client.subscribe(TFMessage, "/tf")

    names = states.wait_for(1)[-1].name
    assert sorted(f"{name.removesuffix('joint')}link" for name in names) == sorted(WHEELS)
    frames.wait_until(
        lambda m: {frame.child_frame_id for message in m for frame in message.transforms} >= WHEELS,
        "a frame for each wheel",
    )
