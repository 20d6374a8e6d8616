"""MoveIt's rules for what satisfies a constraint."""

import math

import numpy as np
import pytest
from robots import joint, link, robot
from scipy.spatial.transform import Rotation

from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Box, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    OrientationError,
    PositionConstraint,
    snap_to_limits,
)
from arm_planning.constraints.evaluation import ConstraintEvaluator, euler_error, rotation_vector
from arm_planning.robot.model import JointGroup, PlanningLimits, PlanningModel
from arm_planning.scene.objects import PlacedShape

URDF = robot(
    *(link(name) for name in ("base", "a", "b", "left", "right")),
    joint("turn", "base", "a", kind="continuous", limits=None),
    joint("bend", "a", "b", limits=(-1.0, 1.0)),
    joint("left_finger", "b", "left", kind="prismatic", limits=(0.0, 0.05)),
    joint(
        "right_finger", "b", "right", "<mimic joint='left_finger' multiplier='-2' offset='0.1'/>"
    ),
)
ENDLESS = PlanningLimits(-math.inf, math.inf, 1.0, 1.0)
GROUP = JointGroup(
    "arm",
    ("turn", "bend"),
    (True, False),
    (ENDLESS, PlanningLimits(-1.0, 1.0, 1.0, 1.0)),
    ("a", "b"),
)
MODEL = PlanningModel(parse_urdf(URDF), "base", ("turn", "bend", "left_finger"), {"arm": GROUP})


def pose(q: np.ndarray, link: str) -> np.ndarray:
    """Link `a` turns about z at (1, 0, 0); link `b` rolls about a's x."""
    result = np.eye(4)
    result[:3, :3] = Rotation.from_euler("z", q[0]).as_matrix()
    if link == "b":
        result[:3, :3] = result[:3, :3] @ Rotation.from_euler("x", q[1]).as_matrix()
    result[:3, 3] = (1.0, 0.0, 0.0)
    return result


def evaluator(*parts) -> ConstraintEvaluator:
    constraints = MotionConstraints(
        tuple(each for each in parts if isinstance(each, JointConstraint)),
        tuple(each for each in parts if isinstance(each, PositionConstraint)),
        tuple(each for each in parts if isinstance(each, OrientationConstraint)),
    )
    return ConstraintEvaluator(constraints, MODEL, GROUP, {"left_finger": 0.03}, pose)


def q(turn: float, bend: float = 0.0) -> np.ndarray:
    return np.array([turn, bend])


def test_a_joint_may_be_up_to_its_tolerances_away():
    bend = evaluator(JointConstraint("bend", 0.5, above=0.1, below=0.2))
    assert [bend.satisfied(q(0.0, at)) for at in (0.29, 0.3, 0.6, 0.61)] == [
        *(False, True, True, False)
    ]


def test_a_violated_joint_says_by_how_much():
    bend = evaluator(JointConstraint("bend", 0.5, above=0.1, below=0.2, weight=2.0))
    assert bend.violation(q(0.0, 0.8)) == (
        "joint 'bend' is at 0.8 rad, 0.2 rad outside of 0.3 to 0.6 rad"
    )
    assert bend.distance(q(0.0, 0.8)) == pytest.approx(0.6)


def test_a_continuous_joint_takes_the_shortest_angle():
    turn = evaluator(JointConstraint("turn", 3.1, above=0.1, below=0.1))
    assert turn.satisfied(q(-3.1))
    assert not evaluator(JointConstraint("bend", 3.1, 0.1, 0.1)).satisfied(q(0.0, -3.1))


def test_joints_outside_of_the_group_count_and_mimic_joints_follow():
    assert evaluator(JointConstraint("left_finger", 0.03, 0.001, 0.001)).satisfied(q(0.0))
    right = evaluator(JointConstraint("right_finger", 0.0, 0.001, 0.001))
    assert "joint 'right_finger' is at 0.04" in right.violation(q(0.0))


def test_a_point_is_in_any_of_its_regions():
    regions = (
        PlacedShape(Sphere(0.1), RigidTransform((1.0, 2.0, 0.0))),
        PlacedShape(Box((0.2, 0.2, 0.2)), RigidTransform((3.0, 0.0, 0.0))),
    )
    tip = evaluator(PositionConstraint("a", (2.0, 0.0, 0.0), regions))
    assert tip.satisfied(q(0.0))
    assert tip.satisfied(q(math.pi / 2.0))
    assert tip.violation(q(0.1)) == (
        "link 'a' is 99.7 mm outside of its region, a box of 200 mm x 200 mm x 200 mm"
    )


def test_a_region_moves_with_the_link_that_it_is_in():
    ahead = PlacedShape(Sphere(0.01), RigidTransform((0.5, 0.0, 0.0)))
    tip = evaluator(PositionConstraint("b", (0.5, 0.0, 0.0), (ahead,), frame="a"))
    assert tip.satisfied(q(2.0))
    assert tip.satisfied(q(2.0, 0.7))


def test_a_position_without_a_region_is_ignored():
    assert evaluator(PositionConstraint("a", (0.0, 0.0, 0.0), ())).satisfied(q(0.0))


@pytest.mark.parametrize("error", OrientationError)
def test_each_axis_of_an_orientation_has_its_tolerance(error):
    constraint = OrientationConstraint("b", (0.0, 0.0, 0.0, 1.0), (0.3, 0.1, 0.2), error)
    upright = evaluator(constraint)
    assert upright.satisfied(q(0.0, 0.29))
    assert upright.satisfied(q(0.19))
    assert upright.violation(q(0.3)) == (
        "link 'b' is turned by 0.3 rad about z from its orientation, 0.2 rad are allowed"
    )
    assert upright.distance(q(0.3)) == pytest.approx(0.3)


def test_a_rotation_vector_is_about_the_axes_of_the_frame_and_euler_angles_of_the_wanted_link():
    quarter = tuple(Rotation.from_euler("z", math.pi / 2.0).as_quat().tolist())
    tolerances = (0.01, 0.5, 0.01)
    # The link rolls about its x axis, which is the frame's y axis after a quarter of a turn.
    for error, satisfied in ((OrientationError.ROTATION_VECTOR, True), (0, False)):
        rolled = OrientationConstraint("b", quarter, tolerances, OrientationError(error))
        assert evaluator(rolled).satisfied(q(math.pi / 2.0, 0.4)) is satisfied


def test_the_axes_of_a_rotation_vectors_tolerances_may_be_turned():
    quarter = tuple(Rotation.from_euler("z", math.pi / 2.0).as_quat().tolist())
    # The link rolls about the y axis, which is the turned x axis.
    for tolerances, satisfied in (((0.5, 0.01, 0.01), True), ((0.01, 0.5, 0.01), False)):
        rolled = OrientationConstraint(
            "b", quarter, tolerances, OrientationError.ROTATION_VECTOR, axes=quarter
        )
        assert evaluator(rolled).satisfied(q(math.pi / 2.0, 0.4)) is satisfied


def test_an_orientation_in_the_frame_of_a_link_moves_with_it():
    level = OrientationConstraint("b", (0.0, 0.0, 0.0, 1.0), (0.1, 0.1, 0.1), frame="a")
    assert evaluator(level).satisfied(q(2.0, 0.05))
    assert not evaluator(level).satisfied(q(2.0, 0.2))


def test_the_residual_is_zero_exactly_where_constraints_hold():
    level = OrientationConstraint("b", (0.0, 0.0, 0.0, 1.0), (0.1, 0.1, 0.1), frame="a")
    both = evaluator(level, JointConstraint("turn", 1.0, 0.5, 0.5))
    assert not both.residual(q(1.2, 0.05)).any()
    assert both.residual(q(2.0, -0.3)) == pytest.approx([0.5, -0.2, 0.0, 0.0])


def test_results_come_in_the_order_joints_positions_orientations():
    region = PlacedShape(Sphere(0.1))
    parts = (
        OrientationConstraint("b", (0.0, 0.0, 0.0, 1.0), (4.0, 4.0, 4.0)),
        PositionConstraint("a", (0.0, 0.0, 0.0), (region,)),
        JointConstraint("bend", 0.0, 1.0, 1.0),
    )
    assert [each.satisfied for each in evaluator(*parts).results(q(0.0))] == [True, False, True]


@pytest.mark.parametrize("angle", [1e-9, 1e-3, 1.0, 3.0, math.pi - 1e-8, math.pi])
def test_a_rotation_vector_is_found_at_any_angle(angle):
    axis = np.array([0.6, -0.48, 0.64])
    found = rotation_vector(Rotation.from_rotvec(angle * axis).as_matrix())
    assert abs(found @ axis) == pytest.approx(angle, abs=1e-7)
    assert np.linalg.norm(found) == pytest.approx(angle, abs=1e-7)


def test_euler_angles_are_intrinsic_x_y_z():
    rotation = Rotation.from_euler("XYZ", [0.3, -0.4, 2.0]).as_matrix()
    assert euler_error(rotation, (1.0, 1.0, 1.0)) == pytest.approx([0.3, -0.4, 2.0])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_in_gimbal_lock_the_tolerances_decide_how_the_angle_is_shared(sign):
    rotation = Rotation.from_euler("XYZ", [0.2, sign * math.pi / 2.0, 0.3]).as_matrix()
    angles = euler_error(rotation, (0.1, 2.0, 1.0))
    assert abs(angles[0]) <= 0.1
    again = Rotation.from_euler("XYZ", angles).as_matrix()
    assert again == pytest.approx(rotation, abs=1e-6)


def test_a_goal_beyond_a_limit_becomes_the_limit_and_is_said():
    said = []
    goal = MotionConstraints(
        (JointConstraint("bend", 1.2, 0.1, 0.1), JointConstraint("turn", 9.0, 0, 0))
    )
    snapped = snap_to_limits(goal, GROUP, said.append).joints
    assert [each.position for each in snapped] == [1.0, 9.0]
    assert said == ["the goal of joint 'bend', 1.2, is beyond its limit; 1 is used"]


def test_a_goal_whose_tolerance_reaches_inside_stays():
    goal = MotionConstraints((JointConstraint("bend", 1.05, 0.1, 0.1),))
    assert snap_to_limits(goal, GROUP, pytest.fail) == goal
