"""The gripper whose left finger follows the right one."""

import pytest

from arm_description.errors import XacroError

RIGHT, LEFT = "right_finger_joint", "left_finger_joint"
CONTROLLER = "gripper_controller"


@pytest.fixture
def gripper(demo):
    def start(interface: str):
        robot = demo(
            "gripper_mimic_joint.urdf.xacro",
            f"interface:={interface}",
            "gripper_controller.yaml",
            "fixed",
        )
        robot.run(0.1)
        return robot

    return start


def test_it_closes_and_opens_with_both_fingers(gripper):
    robot = gripper("position")
    for goal in (0.38, 0.19, 0.0):
        assert robot.controllers[CONTROLLER].offer([goal])
        robot.run(1.5)
        assert robot.position(RIGHT) == pytest.approx(goal, abs=2e-3)
        assert robot.position(LEFT) == pytest.approx(goal, abs=2e-3)


def test_the_fingers_meet_in_the_middle(gripper):
    robot = gripper("position")
    open_right, open_left = (robot.body(f"finger_{side}")[0] for side in ("right", "left"))
    assert robot.controllers[CONTROLLER].offer([0.38])
    robot.run(1.5)
    right, left = (robot.body(f"finger_{side}")[0] for side in ("right", "left"))
    assert right[1] == pytest.approx(-left[1], abs=2e-3)
    assert open_left[1] - open_right[1] == pytest.approx(0.9, abs=2e-3)
    # Their inner faces are a finger's 0.06 m further in.
    assert left[1] - right[1] - 0.12 == pytest.approx(0.02, abs=4e-3)


def test_a_force_closes_it_and_the_opposite_force_opens_it(gripper):
    robot = gripper("effort")
    assert robot.controllers[CONTROLLER].offer([0.38])
    robot.run(1.0)
    under_way = robot.position(RIGHT)
    assert 0.05 < under_way < 0.3
    assert robot.position(LEFT) == pytest.approx(under_way, abs=3e-3)
    robot.run(3.0)
    assert robot.position(LEFT) == pytest.approx(0.38, abs=5e-3)
    assert robot.controllers[CONTROLLER].offer([-0.38])
    robot.run(4.0)
    assert robot.position(RIGHT) == pytest.approx(0.0, abs=5e-3)
    assert robot.position(LEFT) == pytest.approx(0.0, abs=5e-3)


def test_another_interface_is_refused_with_the_choices(demo):
    with pytest.raises(XacroError, match="interface can be position, effort"):
        demo("gripper_mimic_joint.urdf.xacro", "interface:=thought", "gripper_controller.yaml", "")
