"""Constraints and requests from messages, with their frames."""

import math

import pytest
from geometry_msgs.msg import Pose
from moveit_msgs.msg import (
    Constraints,
    JointConstraint,
    MotionPlanRequest,
    OrientationConstraint,
    PositionConstraint,
    VisibilityConstraint,
)
from planar_robot import planar_model
from shape_msgs.msg import SolidPrimitive

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.ros.convert_constraints import ConstraintFrames, constraints_of, plan_request
from arm_planning.ros.goal_messages import joint_goal, plan_message, pose_goal
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.scene import PlanningScene

HALF = math.sqrt(0.5)
CAN = CollisionObject(
    "can", RigidTransform((0.0, 0.0, 0.1)), (), {"lid": RigidTransform((0.0, 0.0, 0.05))}
)


def frames(**poses: RigidTransform) -> ConstraintFrames:
    scene = PlanningScene({}, attached={"can": AttachedBody(CAN, "tip")})

    def pose(name: str) -> RigidTransform:
        if name not in poses:
            raise PlanningError(MoveItErrorCode.FRAME_TRANSFORM_FAILURE, f"Unknown frame: {name}")
        return poses[name]

    return ConstraintFrames(planar_model(), scene, pose)


def converted(message: Constraints, warnings: list[str] | None = None, **poses: RigidTransform):
    warn = (lambda _: None) if warnings is None else warnings.append
    return constraints_of(message, frames(**poses), warn)


def test_a_joint_goal_of_a_client_becomes_a_constraint_for_each_joint():
    goal = converted(joint_goal({"shoulder": 0.5, "elbow": -1.0}))
    assert [(each.joint, each.position) for each in goal.joints] == [
        ("shoulder", 0.5),
        ("elbow", -1.0),
    ]


def test_a_pose_in_a_fixed_frame_is_moved_to_the_planning_frame():
    quarter = RigidTransform((1.0, 0.0, 0.0), (0.0, 0.0, HALF, HALF))
    goal = converted(
        pose_goal("tip", (0.1, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), "table"), table=quarter
    )
    (position,), (orientation,) = goal.positions, goal.orientations
    assert position.frame == orientation.frame == ""
    assert position.regions[0].pose.position == pytest.approx((1.0, 0.1, 0.0))
    assert orientation.orientation == pytest.approx((0.0, 0.0, HALF, HALF))


def test_a_region_in_a_links_frame_moves_with_the_link():
    goal = converted(pose_goal("tip", (0.1, 0.0, 0.0), frame="upper"))
    assert goal.positions[0].frame == "upper"
    assert goal.positions[0].regions[0].pose.position == (0.1, 0.0, 0.0)


def test_a_goal_for_an_object_on_the_robot_is_one_for_its_link():
    goal = converted(pose_goal("can/lid", (0.5, 0.0, 0.0)))
    (position,) = goal.positions
    assert position.link == "tip"
    assert position.offset == pytest.approx((0.0, 0.0, 0.15))


def refused(message: Constraints) -> PlanningError:
    with pytest.raises(PlanningError) as error:
        converted(message)
    return error.value


def test_what_does_not_exist_is_named_with_what_does():
    assert str(refused(pose_goal("tpi", (0.0, 0.0, 0.0)))) == "no link 'tpi'; did you mean 'tip'?"
    unknown = refused(joint_goal({"elbwo": 0.0}))
    assert str(unknown) == "a constraint names the joint 'elbwo'; did you mean 'elbow'?"
    lost = refused(pose_goal("tip", (0.0, 0.0, 0.0), frame="nowhere"))
    assert (lost.code, str(lost)) == (
        MoveItErrorCode.FRAME_TRANSFORM_FAILURE,
        "Unknown frame: nowhere",
    )


def oriented(**fields: float | int) -> Constraints:
    return Constraints(orientation_constraints=[OrientationConstraint(link_name="tip", **fields)])


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        (joint_goal({"elbow": math.nan}), "the constraint on joint 'elbow' is not finite"),
        (pose_goal("tip", (math.nan, 0.0, 0.0)), "nan"),
        (pose_goal("tip", (math.inf, 0.0, 0.0)), "inf"),
        (
            Constraints(
                joint_constraints=[JointConstraint(joint_name="elbow", tolerance_above=-1.0)]
            ),
            "the constraint on joint 'elbow' has a negative tolerance",
        ),
        (oriented(absolute_x_axis_tolerance=-0.1), "has tolerances that are not positive"),
        (oriented(absolute_x_axis_tolerance=math.nan), "has tolerances that are not positive"),
        (oriented(parameterization=7), "there are 0 \\(XYZ_EULER_ANGLES\\) and 1"),
        (Constraints(visibility_constraints=[VisibilityConstraint()]), "are not supported; joint"),
    ],
)
def test_constraints_that_mean_nothing_are_refused(message, problem):
    with pytest.raises(PlanningError, match=problem) as error:
        converted(message)
    assert error.value.code is MoveItErrorCode.INVALID_GOAL_CONSTRAINTS


def test_a_region_without_size_is_refused():
    flat = PositionConstraint(link_name="tip")
    flat.constraint_region.primitives = [SolidPrimitive(type=1, dimensions=[0.1, 0.0, 0.1])]
    flat.constraint_region.primitive_poses = [Pose()]
    problem = str(refused(Constraints(position_constraints=[flat])))
    assert "has a box with a size that is not positive" in problem


def test_a_position_constraint_without_region_is_passed_over_with_a_warning():
    warnings: list[str] = []
    nothing = Constraints(position_constraints=[PositionConstraint(link_name="tip")])
    assert not converted(nothing, warnings)
    assert warnings == ["the position constraint on link 'tip' has no region and is ignored"]


def test_a_weight_of_nothing_counts_as_one_with_a_warning():
    warnings: list[str] = []
    goal = Constraints(joint_constraints=[JointConstraint(joint_name="elbow")])
    assert converted(goal, warnings).joints[0].weight == 1.0
    assert warnings == ["the weight of the constraint on joint 'elbow' is 0; 1 is used"]


def test_a_request_has_moveits_defaults_and_the_nodes_seed():
    message = plan_message("arm", joint_goal({"elbow": 1.0}), max_velocity_scaling_factor=0.5)
    request = plan_request(message, 7, frames(), print)
    assert (request.group, request.seed, request.velocity_scaling) == ("arm", 7, 0.5)
    assert (request.allowed_time_s, request.attempts) == (1.0, 1)
    assert not request.path
    assert plan_request(MotionPlanRequest(), 0, frames(), print).goals == ()


@pytest.mark.parametrize("time_s", [-1.0, math.nan])
def test_a_planning_time_that_is_no_positive_number_stands_for_the_default(time_s):
    message = plan_message("arm", joint_goal({"elbow": 1.0}), allowed_planning_time=time_s)
    assert plan_request(message, 7, frames(), print).allowed_time_s == 1.0


def test_the_tolerances_of_a_rotation_vector_are_about_the_axes_of_the_frame_that_is_named():
    turned = RigidTransform((0.0, 0.0, 0.0), (0.0, 0.0, HALF, HALF))
    message = pose_goal("tip", (0.1, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), "table")
    message.orientation_constraints[0].absolute_x_axis_tolerance = 0.5
    (constraint,) = converted(message, table=turned).orientations
    assert constraint.tolerances == (0.5, 1e-3, 1e-3)
    assert constraint.axes == turned.rotation
