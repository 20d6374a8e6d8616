import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_description import forward_kinematics
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.kinematics.forward import ForwardKinematics

ARM = robot(
    *(link(name) for name in ("base", "upper", "hand", "left", "right")),
    joint("shoulder", "base", "upper", xyz="0.1 0 0.2", axis="0 0.6 0.8"),
    joint("rail", "upper", "hand", xyz="0 0.3 0", axis="1 0 0", kind="prismatic"),
    joint("grip", "hand", "left", xyz="0 0 0.1", axis="0 0 1"),
    joint("follow", "hand", "right", "<mimic joint='grip' multiplier='-1'/>", xyz="0 0 0.1"),
)


@pytest.fixture
def model():
    return model_of(ARM, arm=(("shoulder", "rail"), "hand"))


def test_all_links_are_placed_for_all_active_joints(model):
    kinematics = ForwardKinematics(model)
    assert kinematics.joints == ("shoulder", "rail", "grip")
    positions = {"shoulder": 0.3, "rail": -0.1, "grip": 0.8}
    expected = forward_kinematics(model.robot, positions)
    poses = kinematics.poses(np.array(list(positions.values())))
    assert poses.keys() == expected.keys()
    for name, pose in poses.items():
        assert pose == pytest.approx(expected[name], abs=1e-12), name


def test_a_group_moves_and_the_others_stay_where_they_are(model):
    kinematics = ForwardKinematics(model, "arm", {"grip": 0.5})
    expected = forward_kinematics(model.robot, {"shoulder": 0.2, "rail": 0.1, "grip": 0.5})
    found = kinematics.pose(np.array([0.2, 0.1]), "right")
    assert found == pytest.approx(expected["right"], abs=1e-12)


def test_poses_are_copies(model):
    kinematics = ForwardKinematics(model)
    first = kinematics.pose(np.zeros(3), "hand")
    kinematics.pose(np.ones(3), "hand")
    assert first == pytest.approx(forward_kinematics(model.robot, {})["hand"])


def test_an_unknown_link_is_refused_with_those_that_exist(model):
    with pytest.raises(PlanningError, match="no link 'foot'; the robot has base, upper") as refused:
        ForwardKinematics(model).pose(np.zeros(3), "foot")
    assert refused.value.code is MoveItErrorCode.INVALID_LINK_NAME
