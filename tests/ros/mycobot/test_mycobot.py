"""The myCobot in the simulation, as a stranger's program uses it: topics, actions, launch files."""

import time
from collections.abc import Callable
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory, GripperCommand
from control_msgs.srv import QueryTrajectoryState
from controller_manager_msgs.srv import ListControllers, SwitchController, UnloadController
from robots import MYCOBOT_ARM
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

TARGET = (1.345, -1.23, 0.264, -0.296, 0.389, -1.5)
HOME = (0.0,) * 6
FOLLOWERS = {
    "gripper_base_to_gripper_left2": 1.0,
    "gripper_left3_to_gripper_left1": -1.0,
    "gripper_base_to_gripper_right3": -1.0,
    "gripper_base_to_gripper_right2": -1.0,
    "gripper_right3_to_gripper_right1": 1.0,
}


@pytest.fixture
def result_of(client) -> Callable[..., Any]:
    """Send a goal to an action; return the result's envelope, with `status` and `result`."""

    def carry_out(action_type: Any, name: str, goal: Any) -> Any:
        ended = client.send_goal(client.action(action_type, name), goal)
        assert ended is not None, f"{name} rejects the goal"
        return client.result_of(ended, name)

    return carry_out


def prefixed(joint: str, prefix: str) -> str:
    """Return the name of a joint with the prefix before the names of both links."""
    return prefix + joint.replace("_to_", f"_to_{prefix}")


def trajectory(positions: tuple[float, ...], seconds: int, prefix: str) -> Any:
    point = JointTrajectoryPoint(positions=positions)
    point.time_from_start.sec = seconds
    return JointTrajectory(
        joint_names=[prefixed(name, prefix) for name in MYCOBOT_ARM], points=[point]
    )


def positions_of(message: Any) -> dict[str, float]:
    return dict(zip(message.name, message.position, strict=True))


def wait_for_pose(states: Any, pose: dict[str, float], within_rad: float = 0.005) -> None:
    def there(messages: list) -> bool:
        at = positions_of(messages[-1]) if messages else {}
        return bool(at) and all(abs(at[name] - q) < within_rad for name, q in pose.items())

    states.wait_until(there, f"the joints are at {pose}")


def test_arm_and_gripper_move_by_topic_and_by_actions(launch, client, result_of):
    launch("mycobot", "prefix:=left_").wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    publisher = client.publisher(JointTrajectory, "/arm_controller/joint_trajectory")

    publisher.publish(trajectory(TARGET, 1, "left_"))
    wait_for_pose(
        states, {prefixed(n, "left_"): q for n, q in zip(MYCOBOT_ARM, TARGET, strict=True)}
    )

    follow = "/arm_controller/follow_joint_trajectory"
    goal = FollowJointTrajectory.Goal(trajectory=trajectory(HOME, 1, "left_"))
    followed = result_of(FollowJointTrajectory, follow, goal)
    assert followed.status == GoalStatus.STATUS_SUCCEEDED
    assert followed.result.error_code == FollowJointTrajectory.Result.SUCCESSFUL
    wait_for_pose(states, {prefixed(name, "left_"): 0.0 for name in MYCOBOT_ARM})

    close = GripperCommand.Goal()
    close.command.position, close.command.max_effort = -0.7, 5.0
    gripped = result_of(GripperCommand, "/gripper_action_controller/gripper_cmd", close)
    assert gripped.status == GoalStatus.STATUS_SUCCEEDED
    assert gripped.result.reached_goal
    assert gripped.result.position == pytest.approx(-0.7, abs=0.011)
    wait_for_pose(states, {prefixed(name, "left_"): -0.7 * k for name, k in FOLLOWERS.items()})


@pytest.fixture(scope="class")
def copies(launch_for_class):
    """Two robots; the last test of the class ends them."""
    launched = launch_for_class("mycobot", "copies:=2")
    launched.wait_until_ready()
    return launched


class TestTwoCopies:
    def test_copies_serve_goals_and_queries_without_a_busy_thread(self, copies, client, result_of):
        (simulation,) = copies.processes("arm_gazebo_node")
        controller = "/mycobot_280_1/arm_controller"

        def positions():
            request = QueryTrajectoryState.Request()
            return client.call(QueryTrajectoryState, f"{controller}/query_state", request)

        start = positions()
        assert start.name[0] == "mycobot_280_1_link1_to_link2"
        target = [0.3, *start.position[1:]]
        way = trajectory(target, 3, "")
        way.joint_names = start.name
        before, began_s = simulation.cpu_times(), time.monotonic()
        answer = result_of(
            FollowJointTrajectory,
            f"{controller}/follow_joint_trajectory",
            FollowJointTrajectory.Goal(trajectory=way),
        )
        spent, lasted_s = simulation.cpu_times(), time.monotonic() - began_s
        assert answer.result.error_string == "Goal successfully reached!"
        assert positions().position == pytest.approx(target, abs=0.02)
        # Two arms at 100 Hz take less than a tenth of a core; a thread that polls takes one.
        assert spent.user + spent.system - before.user - before.system < 0.5 * lasted_s

    def test_a_copy_has_actions_and_controllers_of_its_own(self, copies, client, result_of):
        own, other = "mycobot_280_1", "mycobot_280_0"
        states = {
            name: client.subscribe(JointState, f"/{name}/joint_states") for name in (own, other)
        }
        target = trajectory(TARGET, 1, "")
        target.joint_names = [f"{own}_{name}" for name in MYCOBOT_ARM]
        follow = f"/{own}/arm_controller/follow_joint_trajectory"
        followed = result_of(
            FollowJointTrajectory, follow, FollowJointTrajectory.Goal(trajectory=target)
        )
        assert followed.status == GoalStatus.STATUS_SUCCEEDED
        wait_for_pose(states[own], dict(zip(target.joint_names, TARGET, strict=True)))

        close = GripperCommand.Goal()
        close.command.position, close.command.max_effort = -0.5, 5.0
        gripped = result_of(GripperCommand, f"/{own}/gripper_action_controller/gripper_cmd", close)
        assert gripped.status == GoalStatus.STATUS_SUCCEEDED
        states[other].clear()
        assert max(map(abs, states[other].wait_for()[-1].position)) < 0.005

        manager = f"/{own}/controller_manager"
        stop = SwitchController.Request(deactivate_controllers=["arm_controller"], strictness=2)
        assert client.call(SwitchController, f"{manager}/switch_controller", stop).ok
        unload = UnloadController.Request(name="arm_controller")
        assert client.call(UnloadController, f"{manager}/unload_controller", unload).ok
        for name, count in ((own, 2), (other, 3)):
            service = f"/{name}/controller_manager/list_controllers"
            listed = client.call(ListControllers, service, ListControllers.Request()).controller
            assert [controller.state for controller in listed] == ["active"] * count
        assert copies.stop() == 0
        assert "Traceback" not in copies.output


def test_the_description_alone_shows_the_robot_without_gripper(launch, client):
    launch(
        "mycobot_description",
        "robot_state_publisher.launch.py",
        *("use_gripper:=false", "prefix:=left_", "jsp_gui:=false", "use_rviz:=false"),
    ).wait_until_ready()
    states = client.subscribe(JointState, "/joint_states").wait_for(1)
    frames = client.subscribe(TFMessage, "/tf").wait_for(1)

    joints = {prefixed(name, "left_") for name in MYCOBOT_ARM}
    assert set(states[0].name) == joints
    children = {transform.child_frame_id for transform in frames[0].transforms}
    assert children == {*(f"left_link{n}" for n in range(2, 7)), "left_link6_flange"}


LOOP = """
from launch_py import LaunchDescription
from launch_py.ros import Node


def generate_launch_description():
    return LaunchDescription([Node(
        package="arm_controller",
        executable="arm_gripper_loop_controller",
        parameters=[{"trajectory_time": 0.5}],
    )])
"""


def test_the_loop_tells_what_was_reached_and_stops_what_is_under_way(launch, client, tmp_path):
    file = tmp_path / "loop.launch.py"
    file.write_text(LOOP)
    loop = launch(str(file))
    loop.wait_for_line("Waiting for action servers...")
    simulation = launch("mycobot")
    simulation.wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")

    loop.wait_for_line("Action servers connected!")
    loop.wait_for_line("Reached target position - Pausing")
    wait_for_pose(states, dict(zip(MYCOBOT_ARM, TARGET, strict=True)), within_rad=0.05)
    loop.wait_for_line("Closing gripper")
    wait_for_pose(states, {"gripper_controller": -0.7}, within_rad=0.02)
    loop.wait_for_line("Reached home position - Pausing")
    loop.wait_for_line("Opening gripper")
    wait_for_pose(states, {"gripper_controller": 0.0}, within_rad=0.02)
    assert loop.stop() == 0
    assert "Shutting down arm gripper controller..." in loop.output
    assert "Traceback" not in loop.output
