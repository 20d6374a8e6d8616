import numpy as np
import pytest

from arm_description import KinematicsError, Robot, parse_urdf
from arm_description.kinematics.inverse import InverseKinematics
from arm_description.transforms import rotation_about, transform

AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
JOINTS = tuple(f"j{n}" for n in range(len(AXES)))


def joint(name: str, parent: str, child: str, axis: str, kind: str = "revolute", reach=2.5) -> str:
    return (
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='0 0 0.1'/><axis xyz='{axis}'/>"
        f"<limit lower='{-reach}' upper='{reach}' effort='1' velocity='1'/></joint>"
    )


def chain(*joints: str, links: int) -> Robot:
    frames = "".join(f"<link name='l{n}'/>" for n in range(links))
    return parse_urdf(f"<robot name='r'>{frames}{''.join(joints)}</robot>")


@pytest.fixture
def arm() -> Robot:
    """An arm of six turning joints, with a finger that does not carry the hand."""
    parts = [joint(name, f"l{n}", f"l{n + 1}", AXES[n]) for n, name in enumerate(JOINTS)]
    return chain(*parts, joint("finger", "l6", "l7", "1 0 0"), links=8)


@pytest.mark.parametrize("seed", range(20))
def test_the_link_gets_where_it_was_for_some_positions(arm, seed):
    random = np.random.default_rng(seed)
    kinematics = InverseKinematics(arm, "l6", JOINTS)
    positions = random.uniform(-2.0, 2.0, 6)
    target = kinematics.pose(positions)
    found = kinematics.solve(target, positions + random.uniform(-0.3, 0.3, 6))
    assert kinematics.pose(found) == pytest.approx(target, abs=2e-4)
    assert np.abs(found).max() <= 2.5


def test_a_solution_near_the_start_is_found_whatever_the_order_of_the_joints(arm):
    names = tuple(reversed(JOINTS))
    kinematics = InverseKinematics(arm, "l6", names)
    positions = np.array([0.3, -0.4, 0.5, 0.9, 0.6, -0.2])
    found = kinematics.solve(kinematics.pose(positions), positions + 0.1)
    assert found == pytest.approx(positions, abs=1e-3)


@pytest.mark.parametrize("axis", ["1 0 0", "0 0.6 0.8", "0 0 -1"])
def test_half_a_turn_is_found(axis):
    robot = chain(joint("j", "l0", "l1", axis, reach=4.0), links=2)
    kinematics = InverseKinematics(robot, "l1", ("j",))
    assert np.abs(kinematics.solve(kinematics.pose((np.pi,)), (0.0,))) == pytest.approx(np.pi)


def test_sliding_joints_are_moved_as_well():
    slides = [
        joint(name, f"l{n}", f"l{n + 1}", axis, "prismatic")
        for n, (name, axis) in enumerate(zip("xyz", ("1 0 0", "0 1 0", "0 0 1"), strict=True))
    ]
    kinematics = InverseKinematics(chain(*slides, links=4), "l3", ("x", "y", "z"))
    target = transform(np.eye(3), (0.4, -0.3, 0.8))
    assert kinematics.solve(target, (0.0, 0.0, 0.0)) == pytest.approx((0.4, -0.3, 0.5), abs=1e-4)


def test_a_pose_out_of_reach_is_refused_with_the_distance(arm):
    kinematics = InverseKinematics(arm, "l6", JOINTS)
    with pytest.raises(KinematicsError, match=r"'l6' cannot reach \(2.000, 0.000, 0.000\)") as no:
        kinematics.solve(transform(np.eye(3), (2.0, 0.0, 0.0)), (0.1,) * 6)
    assert "mm and" in str(no.value)


def test_limits_are_kept():
    robot = chain(joint("j", "l0", "l1", "0 0 1", reach=0.5), links=2)
    kinematics = InverseKinematics(robot, "l1", ("j",))
    beyond = transform(rotation_about((0.0, 0.0, 1.0), 1.0), (0.0, 0.0, 0.1))
    with pytest.raises(KinematicsError, match="the best pose is off by 0 mm and 29 degrees"):
        kinematics.solve(beyond, (0.0,))


def test_a_joint_that_does_not_carry_the_link_is_refused(arm):
    with pytest.raises(KinematicsError, match="'finger' does not move link 'l6'; these do: j0"):
        InverseKinematics(arm, "l6", ("j0", "finger"))


def test_a_joint_without_a_single_position_is_refused():
    robot = chain(joint("j", "l0", "l1", "0 0 1", "floating"), links=2)
    with pytest.raises(KinematicsError, match="joint 'j' is floating"):
        InverseKinematics(robot, "l1", ("j",))
