"""The tutorials' programs against `arm launch mycobot_moveit_config demo.launch.py`."""

import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest
from moveit_msgs.action import ExecuteTrajectory
from moveit_msgs.msg import CollisionObject
from moveit_msgs.srv import GetPositionFK
from programs import Program
from rclpy.node import Node
from shape_msgs.msg import SolidPrimitive
from trajectory_msgs.msg import JointTrajectoryPoint

from arm_planning.mtc_demo_node import CONFIGURATION
from arm_planning.ros.task_robot import TaskRobot

TIMEOUT_S = 100.0


@pytest.fixture(scope="module")
def launched(launch_for_file) -> Program:
    program = launch_for_file("mycobot_moveit_config", "demo.launch.py", "viewer:=false")
    program.wait_until_ready()
    return program


def run(package: str, name: str, *arguments: str) -> tuple[int, list[str]]:
    """Run a program to its end; return its exit code, and what its node has logged."""
    command = [sys.executable, "-m", "arm_cli", "run", package, name, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert "Traceback" not in done.stderr, done.stderr
    lines = (done.stdout + done.stderr).splitlines()
    return done.returncode, [line.rpartition("]: ")[2] for line in lines if "]: " in line]


def test_hello_moveit_brings_the_gripper_to_its_pose(planning):
    code, said = run("mycobot_moveit_demos", "hello_moveit")
    assert code == 0
    assert said == [
        "Planning pipeline: ompl",
        "Planner ID: RRTConnectkConfigDefault",
        "Planning time: 1.00",
    ]
    position = tip(planning).position
    assert [position.x, position.y, position.z] == pytest.approx([0.061, -0.176, 0.168], abs=2e-3)


def test_plan_around_objects_adds_a_box_and_then_says_that_one_is_in_the_way(planning):
    code, said = run("mycobot_moveit_demos", "plan_around_objects")
    assert code == 0
    assert said == [
        "Planning frame: world",
        "Created collision object: box1",
        "Box dimensions: 0.20 x 0.05 x 0.50",
        "Box position: (0.25, 0.00, 0.25)",
    ]
    (box,) = planning.scene().world.collision_objects
    assert box.id == "box1"
    # The box where hello_moveit wants to be.
    box.pose.position.x, box.pose.position.y, box.pose.position.z = 0.061, -0.2, 0.1
    assert planning.apply_object(box)
    code, said = run("mycobot_moveit_demos", "hello_moveit")
    assert code == 1
    assert said[3] == "Planning failed!"
    assert "box1" in said[4]


def tip(planning):
    """Where the gripper's base is."""
    request = GetPositionFK.Request(fk_link_names=["gripper_base"])
    request.robot_state = planning.scene().robot_state
    return planning.call("/compute_fk", request).pose_stamped[0].pose


def test_a_task_is_planned_and_executed_and_one_without_a_solution_says_why(planning):
    code, said = run("mycobot_mtc_demos", "cartesian", "--ros-args", "-p", "execute:=true")
    assert code == 0, said
    assert said[0] == "Task planning succeeded"
    assert said[-2:] == ["Published solution for visualization", "Task executed successfully"]
    moved = planning.stands_still()
    assert moved["link3_to_link4"] == pytest.approx(1.5708, abs=2e-3)
    # The box where the arm is.
    assert planning.apply_object(box_at(tip(planning)))
    code, said = run("mycobot_mtc_demos", "cartesian")
    assert code == 1
    assert said[0] == "Task planning failed"
    assert any("blocker" in line for line in said[1:-1])
    assert "stage 'current state' has no solution" in said[-1]


def test_a_task_destroys_nothing_while_the_executor_may_collect_what_to_wait_for(
    planning, monkeypatch
):
    client, threads = planning.client, []
    destroy = Node.destroy_subscription

    def noted(node, subscription):
        threads.append(threading.current_thread())
        return destroy(node, subscription)

    monkeypatch.setattr(Node, "destroy_subscription", noted)
    process = SimpleNamespace(executor=client.executor, wait=threading.Event().wait)
    assert TaskRobot(client.node, process, CONFIGURATION).planner.model.groups
    client.wait_until(lambda: len(threads) == 2, "the end of both subscriptions")
    assert threading.current_thread() not in threads


def test_a_gripper_moves_from_wherever_it_is(planning):
    goal = ExecuteTrajectory.Goal()
    motion = goal.trajectory.joint_trajectory
    motion.joint_names = ["gripper_controller"]
    motion.points = [JointTrajectoryPoint(positions=[q]) for q in (-0.5, -0.3)]
    motion.points[1].time_from_start.sec = 1
    assert abs(planning.positions()["gripper_controller"] + 0.5) > 0.1
    ended = planning.send(ExecuteTrajectory, "/execute_trajectory", goal).end()
    assert ended.result.error_code.val == 1, ended.result.error_code.message
    planning.client.wait_until(
        lambda: abs(planning.positions()["gripper_controller"] + 0.3) < 0.02, "the gripper at -0.3"
    )


def box_at(pose):
    """A box of 5 cm."""
    box = CollisionObject(id="blocker", operation=CollisionObject.ADD)
    box.header.frame_id = "world"
    box.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.05, 0.05, 0.05])]
    box.primitive_poses = [pose]
    return box
