"""The lines that the tutorials of the myCobot print, with `arm` for `ros2`, letter by letter."""

import re

import pytest
from sensor_msgs.msg import JointState

pytestmark = [pytest.mark.ros, pytest.mark.usefixtures("mycobot")]

TOPIC = (
    "arm topic pub --once /arm_controller/joint_trajectory trajectory_msgs/msg/JointTrajectory "
    "\"{joint_names: ['link1_to_link2', 'link2_to_link3', 'link3_to_link4', 'link4_to_link5', "
    "'link5_to_link6', 'link6_to_link6_flange'], points: [{positions: [1.345, -1.23, 0.264, "
    '-0.296, 0.389, -1.5], time_from_start: {sec: 3.0, nanosec: 0}}]}"'
)
HOME = (
    "arm action send_goal /arm_controller/follow_joint_trajectory "
    "control_msgs/action/FollowJointTrajectory "
    "\"{trajectory: {joint_names: ['link1_to_link2', 'link2_to_link3', 'link3_to_link4', "
    "'link4_to_link5', 'link5_to_link6', 'link6_to_link6_flange'], points: [{positions: [0.0, "
    '0.0, 0.0, 0.0, 0.0, 0.0], time_from_start: {sec: 1, nanosec: 500000000}}]}}"'
)
GRIP = (
    "arm action send_goal /gripper_action_controller/gripper_cmd "
    'control_msgs/action/GripperCommand "{command: {position: %s, max_effort: 5.0}}"'
)
TARGET = {
    "link1_to_link2": 1.345,
    "link2_to_link3": -1.23,
    "link3_to_link4": 0.264,
    "link4_to_link5": -0.296,
    "link5_to_link6": 0.389,
    "link6_to_link6_flange": -1.5,
}


@pytest.fixture(scope="module")
def mycobot(launch_for_file):
    """The robot in its world, ready."""
    launch_for_file("mycobot").wait_until_ready()


@pytest.fixture
def arrives(client):
    """Return a function that waits until joints are where they should be."""
    states = client.subscribe(JointState, "/joint_states")

    def wait(pose: dict[str, float], within_rad: float = 0.02) -> None:
        def there(messages) -> bool:
            at = (
                dict(zip(messages[-1].name, messages[-1].position, strict=True)) if messages else {}
            )
            return bool(at) and all(abs(at[name] - q) < within_rad for name, q in pose.items())

        states.wait_until(there, f"the joints at {pose}")

    return wait


def test_what_there_is(run_until):
    controllers = (
        r"^arm_controller +joint_trajectory_controller/JointTrajectoryController +active\n",
        r"^gripper_action_controller +position_controllers/GripperActionController +active\n",
        r"^joint_state_broadcaster +joint_state_broadcaster/JointStateBroadcaster +active\n",
    )
    run_until(
        "arm control list_controllers",
        lambda text: all(re.search(line, text, re.MULTILINE) for line in controllers),
    )
    run_until(
        "arm action find control_msgs/action/GripperCommand",
        lambda text: text == "/gripper_action_controller/gripper_cmd\n",
    )


def test_the_arm_goes_there_by_topic_and_home_by_action(run, arrives):
    sent = run(TOPIC)
    assert "publishing #1: trajectory_msgs.msg.JointTrajectory(" in sent
    assert "Duration(sec=3, nanosec=0)" in sent
    arrives(TARGET)
    text = run(HOME)
    assert "\nResult:\n    error_code: 0\nerror_string: Goal successfully reached!\n" in text
    assert text.endswith("Goal finished with status: SUCCEEDED\n")
    arrives(dict.fromkeys(TARGET, 0.0))


def test_the_gripper_closes_but_not_while_it_is_inactive(run, arrives):
    text = run(GRIP % -0.7)
    assert re.search(r"^Result:\n    position: -0.[67]\d*\neffort: 5.0\nstalled: ", text, re.M)
    assert text.endswith("reached_goal: true\n\nGoal finished with status: SUCCEEDED\n")
    arrives({"gripper_controller": -0.7})
    deactivated = run("arm control set_controller_state gripper_action_controller inactive")
    assert deactivated == "Successfully deactivated gripper_action_controller\n"
    assert run(GRIP % 0.0).endswith("\nGoal was rejected.\n")
