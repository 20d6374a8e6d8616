"""The plan of a pick, on the myCobot's own description: where the fingers go, and how smoothly."""

import math

import numpy as np
import pytest

from arm_controller.pick_plan import (
    GRASP_CENTRE,
    HOME,
    JOINTS,
    PathPoint,
    PickPlan,
    PickTask,
    PlanError,
    path_to,
    plan_pick,
    reversed_path,
    straight_path,
)
from arm_description.kinematics.forward import forward_kinematics
from arm_description.resources import resolve_uri
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Robot
from arm_description.xacro.expansion import expand_xacro
from arm_planning.kinematics.inverse import InverseKinematics

XACRO = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"


@pytest.fixture(scope="module")
def description() -> str:
    return expand_xacro(resolve_uri(XACRO))


@pytest.fixture(scope="module")
def robot(description) -> Robot:
    return parse_urdf(description)


@pytest.fixture(scope="module")
def plan(description) -> PickPlan:
    return plan_pick(description, PickTask())


def centres(robot: Robot, positions: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return where the middle between the pads is, and the hand's rotation."""
    hand = forward_kinematics(robot, dict(zip(JOINTS, positions, strict=True)))["gripper_base"]
    return (hand @ (*GRASP_CENTRE, 1.0))[:3], hand[:3, :3]


def test_the_fingers_close_level_around_the_object(robot, plan):
    centre, rotation = centres(robot, plan.approach[-1].positions)
    assert centre == pytest.approx((0.22, 0.12, 0.18), abs=1e-4)
    assert rotation[:, 2] == pytest.approx((0.0, 0.0, 1.0), abs=1e-3)


def test_the_pads_are_where_the_plan_says(robot):
    """The middle of the pad boxes of the facts, with 30 mm between them."""
    poses = forward_kinematics(robot, {"gripper_controller": -0.24})
    hand = np.linalg.inv(poses["gripper_base"])
    pads = [
        hand @ poses[f"gripper_{side}1"] @ (sign * 0.013, 0.042, -0.01, 1.0)
        for side, sign in (("left", 1.0), ("right", -1.0))
    ]
    assert (pads[0] + pads[1])[:3] / 2 == pytest.approx(GRASP_CENTRE, abs=1e-3)


def test_the_path_up_is_straight_and_the_path_down_is_the_same(robot, plan):
    places = np.array([centres(robot, point.positions)[0] for point in plan.up])
    assert places[:, :2] == pytest.approx(np.full((len(places), 2), (0.22, 0.12)), abs=1e-4)
    assert (np.diff(places[:, 2]) > 0).all()
    assert places[-1, 2] == pytest.approx(0.28, abs=1e-4)
    down = [centres(robot, point.positions)[0][2] for point in plan.down]
    assert down[-1] == pytest.approx(0.18, abs=1e-4)
    assert down[:-1] == pytest.approx(places[-2::-1, 2])


def test_the_fingers_come_and_go_along_themselves(robot, plan):
    grasp, rotation = centres(robot, plan.approach[-1].positions)
    ahead = rotation[:, 1]
    for way in (plan.approach, plan.away):
        for point in way:
            off = centres(robot, point.positions)[0] - grasp
            assert np.linalg.norm(off - (off @ ahead) * ahead) < 1e-4
    start, _ = centres(robot, plan.to_object[-1].positions)
    assert np.linalg.norm(start - grasp) == pytest.approx(0.07, abs=1e-4)


def test_every_joint_stays_slower_than_it_may(robot, plan):
    fastest = min(robot.joint(name).limit.velocity for name in JOINTS)
    for way in (plan.approach, plan.up, plan.down, plan.away):
        assert max(abs(v) for point in way for v in point.velocities) < 0.5 * fastest
        assert way[-1].velocities == pytest.approx((0.0,) * 6)
    assert plan.home[-1].positions == HOME


@pytest.mark.parametrize("distance", [0.2, 0.25])
@pytest.mark.parametrize("direction_deg", [-90.0, 0.0, 150.0])
def test_the_object_may_stand_elsewhere(description, robot, distance, direction_deg):
    direction = math.radians(direction_deg)
    place = (distance * math.cos(direction), distance * math.sin(direction))
    plan = plan_pick(description, PickTask(*place))
    centre, _ = centres(robot, plan.approach[-1].positions)
    assert centre[:2] == pytest.approx(place, abs=1e-4)


def test_names_may_have_a_prefix():
    description = expand_xacro(resolve_uri(XACRO), {"prefix": "left_"})
    assert plan_pick(description, PickTask(), "left_").approach


def test_an_object_too_far_away_is_refused_with_the_reason(description):
    with pytest.raises(PlanError, match=r"at \(0\.600, 0\.000\) m cannot be gripped .* is off by"):
        plan_pick(description, PickTask(0.6, 0.0))


def test_another_robot_is_refused(description):
    with pytest.raises(PlanError, match="no link 'left_gripper_base'"):
        plan_pick(description, PickTask(), "left_")


def test_what_is_not_a_robot_is_refused():
    with pytest.raises(PlanError, match="robot_description"):
        plan_pick("<robot", PickTask())


def test_a_straight_line_past_a_singularity_is_refused(robot):
    kinematics = InverseKinematics.for_link(robot, "gripper_base", JOINTS)
    start = kinematics.solve(_ahead_at(robot, 0.22), (-0.09, -2.37, 1.92, 0.36, -1.48, 0.09))
    with pytest.raises(PlanError, match="singularity"):
        straight_path(kinematics, start.tolist(), _ahead_at(robot, 0.15), 2.0)


def _ahead_at(robot: Robot, x: float) -> np.ndarray:
    """Return a pose of the hand that looks along x."""
    pose = np.eye(4)
    pose[:3, :3] = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    pose[:3, 3] = np.array([x, 0.12, 0.2]) - pose[:3, :3] @ GRASP_CENTRE
    return pose


def test_a_path_to_a_pose_ends_at_rest():
    assert path_to([1.0, 2.0], 3.0) == (PathPoint(3.0, (1.0, 2.0), (0.0, 0.0)),)


def test_the_reversed_path_starts_at_the_end():
    way = (
        PathPoint(0.5, (1.0,), (3.0,)),
        PathPoint(2.0, (2.0,), (1.0,)),
        PathPoint(3.0, (4.0,), (0.0,)),
    )
    assert reversed_path(way, (0.0,)) == (
        PathPoint(1.0, (2.0,), (-1.0,)),
        PathPoint(2.5, (1.0,), (-3.0,)),
        PathPoint(3.0, (0.0,), (0.0,)),
    )
