import math

import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.planners.pose_line import PoseLine


def about_z(angle: float) -> tuple[float, float, float, float]:
    return (0.0, 0.0, math.sin(angle / 2.0), math.cos(angle / 2.0))


def test_a_pose_moves_straight_and_turns_evenly():
    line = PoseLine(
        RigidTransform((0.0, 0.0, 1.0)), RigidTransform((3.0, 4.0, 1.0), about_z(math.pi / 2))
    )
    assert line.length_m == pytest.approx(5.0)
    assert line.angle_rad == pytest.approx(math.pi / 2)
    quarter = line.at(0.25)
    assert quarter.position == pytest.approx((0.75, 1.0, 1.0))
    assert quarter.rpy()[2] == pytest.approx(math.pi / 8)


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_the_ends_are_the_poses(share):
    poses = (RigidTransform((0.0, 1.0, 2.0), about_z(0.3)), RigidTransform(rotation=about_z(2.0)))
    found = PoseLine(*poses).at(share)
    assert found.position == pytest.approx(poses[int(share)].position)
    assert found.rotation == pytest.approx(poses[int(share)].rotation)


def test_it_turns_the_short_way_whatever_the_quaternions_sign():
    x, y, z, w = about_z(0.4)
    line = PoseLine(RigidTransform(), RigidTransform(rotation=(-x, -y, -z, -w)))
    assert line.angle_rad == pytest.approx(0.4)
    assert line.at(0.5).rpy()[2] == pytest.approx(0.2)


def test_equal_rotations_stay():
    line = PoseLine(RigidTransform(rotation=about_z(0.4)), RigidTransform(rotation=about_z(0.4)))
    assert line.angle_rad == pytest.approx(0.0)
    assert line.at(0.5).rotation == pytest.approx(about_z(0.4))
