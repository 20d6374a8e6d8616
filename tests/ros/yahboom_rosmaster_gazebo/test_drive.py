"""`arm launch yahboom_rosmaster_gazebo`: a robot that drives sideways."""

import pytest
from control_msgs.msg import MecanumDriveControllerState
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

DRIVE = "/mecanum_drive_controller"


def test_it_drives_sideways_and_tells_where_it_is(launch, client):
    launch("yahboom_rosmaster_gazebo", "yahboom_rosmaster.gazebo.launch.py").wait_until_ready()
    odometry = client.subscribe(Odometry, f"{DRIVE}/odometry")
    frames = client.subscribe(TFMessage, "/tf")
    states = client.subscribe(MecanumDriveControllerState, f"{DRIVE}/controller_state")
    references = client.publisher(TwistStamped, f"{DRIVE}/reference")
    reference = TwistStamped()
    reference.twist.linear.y = 0.2

    def driven_far() -> bool:
        references.publish(reference)
        is_heard = bool(odometry.messages and states.messages)
        return is_heard and odometry.messages[-1].pose.pose.position.y > 0.1

    client.wait_until(driven_far, "10 cm are driven to the left")
    last = odometry.messages[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_footprint")
    assert last.pose.pose.position.x == pytest.approx(0.0, abs=0.01)
    assert any(state.front_left_wheel_velocity < -1 for state in states.messages)
    assert any(state.back_left_wheel_velocity > 1 for state in states.messages)

    def has_frame(messages: list) -> bool:
        children = {frame.child_frame_id for message in messages for frame in message.transforms}
        return "base_footprint" in children

    frames.wait_until(has_frame, "the frame of the odometry on /tf")
    odometry.clear()
    odometry.wait_until(
        lambda m: bool(m) and abs(m[-1].twist.twist.linear.y) < 1e-3,
        "the robot stands, for nobody commands it any more",
    )
