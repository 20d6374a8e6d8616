"""`arm launch gz_ros2_control_demos diff_drive_example.launch.py`: a robot that is driven."""

import sys
from math import atan2, cos, sin

import pytest
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from programs import Program
from tf2_msgs.msg import TFMessage

DRIVE = "/diff_drive_base_controller"
EXAMPLE = (sys.executable, "-m", "arm_cli", "run", "gz_ros2_control_demos")
EXAMPLE_TIMEOUT_S = 90.0
"""Its start takes half a minute where 50 others want the processor."""


@pytest.fixture(scope="module")
def robot(launch_for_file):
    """One start for all tests of the file."""
    launched = launch_for_file("gz_ros2_control_demos", "diff_drive_example.launch.py")
    launched.wait_until_ready()
    return launched


def heading(rotation) -> float:
    return 2 * atan2(rotation.z, rotation.w)


def stamp(message) -> tuple[int, int]:
    return message.header.stamp.sec, message.header.stamp.nanosec


def goes_as_the_example_says(twist) -> bool:
    speeds = (twist.linear.x, twist.angular.z)
    return speeds == pytest.approx((0.1, 0.1), rel=0.05)


def test_it_drives_on_a_circle_and_tells_where_it_is(robot, client):
    odometry = client.subscribe(Odometry, f"{DRIVE}/odom")
    frames = client.subscribe(TFMessage, "/tf")
    commands = client.publisher(TwistStamped, f"{DRIVE}/cmd_vel")
    command = TwistStamped()
    command.twist.linear.x, command.twist.angular.z = 0.4, 0.8

    def driven_far() -> bool:
        commands.publish(command)
        return bool(odometry.messages) and heading(odometry.messages[-1].pose.pose.orientation) > 1

    client.wait_until(driven_far, "a radian is driven")
    (last, *_) = reversed(odometry.wait_for(1))
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_link")
    # A circle of 0.5 m from the start: both speeds grow within the same time.
    angle = heading(last.pose.pose.orientation)
    assert last.pose.pose.position.x == pytest.approx(0.5 * sin(angle), abs=0.03)
    assert last.pose.pose.position.y == pytest.approx(0.5 * (1 - cos(angle)), abs=0.03)

    def of_both(messages: list) -> dict:
        told = {stamp(message): message.pose.pose for message in odometry.messages}
        return {
            stamp(frame): (frame, told[stamp(frame)])
            for message in messages
            for frame in message.transforms
            if frame.child_frame_id == "base_link" and stamp(frame) in told
        }

    pairs = of_both(frames.wait_until(of_both, "a frame and the odometry of the same time"))
    for frame, pose in pairs.values():
        assert frame.header.frame_id == "odom"
        assert frame.transform.translation.x == pose.position.x
        assert frame.transform.translation.y == pose.position.y
        assert frame.transform.rotation == pose.orientation
    odometry.clear()
    odometry.wait_until(
        lambda m: bool(m) and abs(m[-1].twist.twist.linear.x) < 1e-3,
        "the robot stands, for nobody commands it any more",
    )


def test_the_example_drives_it_until_it_is_stopped(robot, client):
    odometry = client.subscribe(Odometry, f"{DRIVE}/odom")
    driver = Program([*EXAMPLE, "example_diff_drive"])
    try:
        odometry.wait_until(
            lambda m: any(goes_as_the_example_says(message.twist.twist) for message in m),
            "the robot goes as the example says",
            EXAMPLE_TIMEOUT_S,
        )
        assert driver.stop(timeout_s=EXAMPLE_TIMEOUT_S) == 0
    finally:
        driver.close()
    odometry.clear()
    odometry.wait_until(
        lambda m: bool(m) and abs(m[-1].twist.twist.linear.x) < 1e-3, "the robot stands"
    )
