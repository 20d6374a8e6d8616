"""The keys of a kinematics.yaml, and that they act."""

from dataclasses import replace

import pytest
from planar_robot import planar_model

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.kinematics.settings import KinematicsSettings, kinematics_settings
from arm_planning.planner import Planner

MODEL = planar_model()
TURNED = RigidTransform((0.5, 0.5, 0.0), (1.0, 0.0, 0.0, 0.0))
"""The arm reaches the place, but never upside down."""


def test_the_keys_of_moveit_are_read():
    given = {
        "arm.kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
        "arm.kinematics_solver_timeout": 0.2,
        "arm.position_only_ik": True,
    }
    assert kinematics_settings(given, MODEL, pytest.fail) == {"arm": KinematicsSettings(0.2, True)}


def test_a_group_that_does_not_exist_is_named():
    said: list[str] = []
    assert not kinematics_settings({"leg.position_only_ik": True}, MODEL, said.append)
    assert said == ["robot_description_kinematics names the group 'leg'; the robot has arm"]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position_only_ik", "yes"),
        ("kinematics_solver_timeout", "long"),
        ("kinematics_solver_timeout", -1.0),
        ("kinematics_solver_timeout", float("nan")),
        ("kinematics_solver_timeout", 10**400),
        ("kinematics_solver_timeout", True),
    ],
)
def test_a_value_of_the_wrong_kind_is_refused(name: str, value: object):
    with pytest.raises(PlanningError, match=f"robot_description_kinematics.arm.{name} is"):
        kinematics_settings({f"arm.{name}": value}, MODEL, pytest.fail)


def test_position_only_leaves_the_orientation_open():
    with pytest.raises(PlanningError, match="orientation"):
        Planner(MODEL).inverse("arm", TURNED)
    planner = Planner(MODEL, kinematics={"arm": KinematicsSettings(position_only=True)})
    scene = replace(planner.scene, positions=planner.inverse("arm", TURNED))
    assert planner.link_pose("tip", scene).position == pytest.approx((0.5, 0.5, 0.0), abs=1e-5)


def test_position_only_lets_a_straight_path_turn_the_tip():
    planner = Planner(MODEL, kinematics={"arm": KinematicsSettings(position_only=True)})
    planner.scene = replace(planner.scene, positions={"shoulder": 0.0, "elbow": 1.0})
    x, y, z = planner.link_pose("tip").position
    end = RigidTransform((x - 0.1, y, z), TURNED.rotation)
    assert planner.cartesian_path("arm", [end], avoids_collisions=False).fraction == 1.0
