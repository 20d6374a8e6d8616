"""Motions planned on the page in a real browser, for the simulated myCobot with move_group."""

import math

import pytest
from moveit_msgs.msg import DisplayTrajectory, RobotTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

pytestmark = pytest.mark.timeout(600)

ELBOW = "link3_to_link4"
READY_RAD = 1.5708
HOME_M = "0.06 0.08 0.41"
"""Where the gripper is at the pose "home"."""


@pytest.fixture(scope="module")
def simulation(launch_for_file):
    """Return the running robot with its move_group."""
    launched = launch_for_file("mycobot", "planning:=true")
    launched.wait_until_ready()
    return launched


@pytest.fixture
def elbow(client):
    """Return the elbow's newest position on /joint_states, by a function."""
    states = client.subscribe(JointState, "/joint_states")

    def newest() -> float:
        message = states.wait_for()[-1]
        return dict(zip(message.name, message.position, strict=True))[ELBOW]

    return newest


@pytest.fixture
def planner(visitor):
    """Return the visitor, with the tab of planning open."""
    visitor.page.get_by_role("tab", name="Planning").wait_for(state="attached")
    visitor.open_tab("Planning")
    return visitor


def choose(visitor, label: str, option: str) -> None:
    """Choose an option of a drop-down list."""
    visitor.page.locator(f"xpath=//label[.='{label}']/following::input[1]").click()
    visitor.page.get_by_role("option", name=option, exact=True).click()


def enter(visitor, label: str, text: str) -> None:
    """Type into the field beside a label."""
    fields = visitor.page.locator(f"xpath=//label[.='{label}']/following::input[1]")
    field = fields.locator("visible=true")
    field.fill(text)
    field.press("Enter")


def press(visitor, label: str) -> None:
    """Press a button once it can be pressed."""
    visitor.wait_until(visitor.button(label).is_enabled, f"{label} can be pressed")
    visitor.button(label).click()


def says(visitor, text: str) -> None:
    """Wait until the page says something."""
    visitor.page.get_by_text(text).first.wait_for()


def test_a_named_pose_is_planned_shown_and_executed(planner, elbow):
    assert abs(elbow()) < 0.1
    choose(planner, "Pose", "ready")
    press(planner, "Plan")
    says(planner, "gripper_base moves 0.")
    assert abs(elbow()) < 0.1
    press(planner, "Execute")
    says(planner, "The robot has arrived.")
    planner.wait_until(lambda: abs(elbow() - READY_RAD) < 0.05, "the elbow is where it was planned")


def test_a_typed_pose_of_the_tip_is_not_cut(planner):
    planner.page.get_by_text("Tip by numbers", exact=True).click()
    fields = planner.page.locator("xpath=//label[.='Tip at']/following::input[1]")
    field = fields.locator("visible=true")
    field.fill("0.1534 0.1362 0.2315")
    assert field.evaluate("field => field.scrollWidth <= field.clientWidth")
    planner.page.get_by_text("Tip by numbers", exact=True).click()


def test_a_box_in_the_way_is_named_and_fails_the_plan(planner):
    planner.page.get_by_text("Planning scene", exact=True).click()
    enter(planner, "Size", "0.1 0.1 0.1")
    enter(planner, "Position", HOME_M)
    press(planner, "Add")
    choose(planner, "Pose", "home")
    says(planner, "The goal is in collision: ")
    assert "box1" in planner.page.get_by_text("The goal is in collision: ").first.inner_text()
    press(planner, "Plan")
    says(planner, "(GOAL_IN_COLLISION)")
    press(planner, "Remove")
    planner.page.get_by_text("The goal is in collision: ").first.wait_for(state="hidden")
    says(planner, "The planning scene has no objects.")


def test_a_plan_of_another_program_is_shown(planner, client):
    motion = RobotTrajectory()
    motion.joint_trajectory.joint_names = [ELBOW]
    ends = [JointTrajectoryPoint(positions=[READY_RAD]), JointTrajectoryPoint(positions=[0.5])]
    ends[1].time_from_start.sec = 2
    motion.joint_trajectory.points = ends
    publisher = client.publisher(DisplayTrajectory, "/display_planned_path")
    publisher.publish(DisplayTrajectory(trajectory=[motion]))
    says(planner, "Plan of another program: 2.00 s, 2 points")
    assert planner.button("Execute").is_disabled()
    assert math.isfinite(planner.slider_value("Along path"))
