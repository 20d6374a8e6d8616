"""Straight paths of a link: where they go, how far, and why they stop."""

import itertools
import math

import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_planning.planners.cartesian import CartesianPath, JumpLimits, cartesian_path
from arm_planning.planners.pose_line import PoseLine

AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
START = np.array([0.0, 0.6, 1.2, 0.0, 0.4, 0.0])


@pytest.fixture
def arm() -> InverseKinematics:
    links = [link(f"l{n}") for n in range(7)]
    joints = [
        joint(f"j{n}", f"l{n}", f"l{n + 1}", axis=axis, xyz="0 0 0.2", limits=(-2.8, 2.8))
        for n, axis in enumerate(AXES)
    ]
    names = tuple(f"j{n}" for n in range(6))
    return InverseKinematics(model_of(robot(*links, *joints), arm=(names, "l6")), "arm")


@pytest.fixture
def planar() -> InverseKinematics:
    """Two joints in the plane of x and z."""
    links = [link(f"l{n}") for n in range(4)]
    joints = (
        joint("a", "l0", "l1"),
        joint("b", "l1", "l2", xyz="0.5 0 0"),
        joint("hand", "l2", "l3", xyz="0.5 0 0", kind="fixed", limits=None),
    )
    return InverseKinematics(model_of(robot(*links, *joints), arm=(("a", "b"), "l3")), "arm")


class Wall:
    """Nothing is free once joint 0 is beyond an angle."""

    def __init__(self, angle: float, named: bool = True) -> None:
        self._angle, self._named = angle, named

    def is_free_edge(self, a, b) -> bool:
        return max(a[0], b[0]) < self._angle

    def contacts(self, q) -> list[str]:
        return ["hand with wall, 2 mm deep"] if self._named and q[0] >= self._angle else []


def moved(pose: RigidTransform, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> RigidTransform:
    px, py, pz = pose.position
    return RigidTransform((px + x, py + y, pz + z), pose.rotation)


def tips(kinematics: InverseKinematics, path: CartesianPath) -> np.ndarray:
    return np.array([kinematics.tip_pose(q).position for q in path.points])


def test_the_link_stays_on_the_lines_between_the_points_too(arm):
    begin = arm.tip_pose(START)
    corner, end = moved(begin, y=0.1), moved(begin, y=0.1, z=-0.1)
    path = cartesian_path(arm, START, (corner, end), 0.01)
    assert (path.fraction, path.stopped) == (1.0, "")
    assert path.points[0] == pytest.approx(START)
    assert arm.tip_pose(path.points[-1]).position == pytest.approx(end.position, abs=2e-5)
    middles = (path.points[1:] + path.points[:-1]) / 2.0
    for q in (*path.points, *middles):
        x, y, z = np.subtract(arm.tip_pose(q).position, begin.position)
        assert x == pytest.approx(0.0, abs=1e-3)
        assert z == pytest.approx(0.0, abs=1e-3) or y == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize(("max_step", "points"), [(0.012, 10), (0.011, 11), (0.005, 22)])
def test_steps_are_counted_as_by_moveit(arm, max_step, points):
    begin = arm.tip_pose(START)
    path = cartesian_path(arm, START, (moved(begin, y=0.1001),), max_step)
    assert len(path.points) == points
    steps = np.linalg.norm(np.diff(tips(arm, path), axis=0), axis=1)
    assert steps == pytest.approx(0.1001 / (points - 1), abs=1e-4)


def test_a_turn_on_the_spot_has_steps_as_well(arm):
    begin = arm.tip_pose(START)
    turned = begin.then(RigidTransform(rotation=(0.0, 0.0, math.sin(0.2), math.cos(0.2))))
    path = cartesian_path(arm, START, (turned,), 0.01)
    assert path.fraction == 1.0
    assert len(path.points) >= 13
    poses = [arm.tip_pose(q) for q in path.points]
    for pose, following in itertools.pairwise(poses):
        assert pose.position == pytest.approx(begin.position, abs=2e-5)
        assert PoseLine(pose, following).angle_rad <= 0.0351


def test_a_step_is_halved_where_the_link_would_leave_the_line(arm):
    begin = arm.tip_pose(START)
    path = cartesian_path(arm, START, (moved(begin, y=0.3),), 10.0)
    assert path.fraction == 1.0
    assert len(path.points) > 3


def test_relative_way_points_are_in_the_frame_of_the_one_before(arm):
    begin = arm.tip_pose(START)
    ahead = RigidTransform((0.0, 0.0, -0.03))
    path = cartesian_path(arm, START, (ahead, ahead), 0.01, relative=True)
    expected = begin.then(ahead).then(ahead)
    assert path.fraction == 1.0
    assert arm.tip_pose(path.points[-1]).position == pytest.approx(expected.position, abs=2e-5)


def test_no_way_points_are_a_path_that_stays(arm):
    path = cartesian_path(arm, START, (), 0.01)
    assert (path.fraction, path.stopped) == (0.0, "")
    assert path.points == pytest.approx(START[None])


def test_a_path_out_of_reach_stops_at_the_reach_and_says_so(planar):
    start = np.array([0.5, -1.0])
    begin = planar.tip_pose(start)
    path = cartesian_path(planar, start, (moved(begin, x=0.5),), 0.01, orientation=Orientation.ANY)
    reach = 1.0 - begin.position[0]
    assert path.fraction == pytest.approx(reach / 0.5, abs=2e-3)
    assert "link 'l3' stops at" in path.stopped
    assert "before way point 1 of 1" in path.stopped
    assert "link 'l3' cannot reach" in path.stopped


def test_the_second_way_point_counts_its_part(planar):
    start = np.array([0.5, -1.0])
    begin = planar.tip_pose(start)
    there, beyond = moved(begin, x=0.05), moved(begin, x=5.05)
    path = cartesian_path(planar, start, (there, beyond), 0.01, orientation=Orientation.ANY)
    part = (1.0 - there.position[0]) / 5.0
    assert path.fraction == pytest.approx((1.0 + part) / 2.0, abs=1e-3)
    assert "way point 2 of 2" in path.stopped


def test_fewer_joints_can_follow_a_line_with_what_orientation_they_have(planar):
    start = np.array([0.5, -1.0])
    line = (moved(planar.tip_pose(start), x=0.05),)
    assert cartesian_path(planar, start, line, 0.01).fraction < 0.01
    for orientation in (Orientation.ANY, Orientation.NEAREST):
        assert cartesian_path(planar, start, line, 0.01, orientation=orientation).fraction == 1.0


def test_a_collision_stops_the_path_before_it_and_is_named(arm):
    begin = arm.tip_pose(START)
    path = cartesian_path(arm, START, (moved(begin, y=0.2),), 0.01, checker=Wall(0.2))
    assert 0.0 < path.fraction < 1.0
    assert path.points[:, 0].max() < 0.2
    assert path.stopped.endswith("there is a collision: hand with wall, 2 mm deep")


def test_a_step_that_is_not_proved_free_stops_the_path_without_a_contact(arm):
    begin = arm.tip_pose(START)
    wall = Wall(0.2, named=False)
    path = cartesian_path(arm, START, (moved(begin, y=0.2),), 0.01, checker=wall)
    assert path.stopped.endswith("the next step is not proved free of collisions")


def test_a_violated_constraint_stops_the_path_before_it(arm):
    begin = arm.tip_pose(START)
    path = cartesian_path(
        arm,
        START,
        (moved(begin, y=0.2),),
        0.01,
        violation=lambda q: "joint 'j0' is too far" if q[0] > 0.1 else "",
    )
    assert path.points[:, 0].max() <= 0.1
    assert path.stopped.endswith("joint 'j0' is too far")


def test_a_jump_to_another_branch_stops_the_path(planar):
    """Past the shoulder, the elbow would have to fold over: both joints would jump there."""
    start = np.array([0.0, 3.0])
    begin = planar.tip_pose(start)
    through = moved(begin, x=-2.0 * begin.position[0], z=-2.0 * begin.position[2])
    path = cartesian_path(planar, start, (through,), 0.001, orientation=Orientation.ANY)
    assert path.fraction < 1.0
    assert "would have to jump by" in path.stopped or "cannot reach" in path.stopped


@pytest.mark.parametrize(
    ("jumps", "reason"),
    [
        (JumpLimits(turning_rad=0.02), "in one step; the threshold is 0.02"),
        (JumpLimits(factor=1.05), "times the mean of the steps"),
    ],
)
def test_thresholds_of_joint_jumps_act(arm, jumps, reason):
    begin = arm.tip_pose(START)
    line = (moved(begin, y=0.3),)
    whole = cartesian_path(arm, START, line, 0.01)
    cut = cartesian_path(arm, START, line, 0.01, jumps=jumps)
    assert whole.fraction == 1.0
    assert cut.fraction < 1.0
    assert reason in cut.stopped
    assert np.array_equal(cut.points, whole.points[: len(cut.points)])


def test_a_threshold_of_sliding_joints_leaves_turning_ones_alone(arm):
    line = (moved(arm.tip_pose(START), y=0.1),)
    assert cartesian_path(arm, START, line, 0.01, jumps=JumpLimits(sliding_m=1e-6)).fraction == 1.0


@pytest.mark.parametrize(
    ("max_step", "message"),
    [
        (0.0, "max_step is 0 m; it must be positive"),
        (float("nan"), "max_step is nan m"),
        (1e-9, "steps of 1e-09 m make 100000000 points of this path; 20000 are possible"),
    ],
)
def test_steps_that_make_no_path_are_refused(arm, max_step, message):
    line = (moved(arm.tip_pose(START), y=0.1),)
    with pytest.raises(PlanningError, match=message) as refused:
        cartesian_path(arm, START, line, max_step)
    assert refused.value.code is MoveItErrorCode.FAILURE


def test_a_way_point_that_is_no_pose_is_refused_by_its_number(arm):
    begin = arm.tip_pose(START)
    bad = RigidTransform((0.0, 0.0, float("nan")))
    with pytest.raises(PlanningError, match="way point 2 of 2: the position of the target is not"):
        cartesian_path(arm, START, (begin, bad), 0.01)


def test_a_start_that_is_no_state_is_refused(arm):
    begin = arm.tip_pose(START)
    with pytest.raises(PlanningError, match="the position of joint 'j0' is not finite: nan"):
        cartesian_path(arm, np.full(6, np.nan), (begin,), 0.01)
