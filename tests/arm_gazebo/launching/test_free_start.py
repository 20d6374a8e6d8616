"""Where a robot starts that plans motions and touches itself with all joints at zero."""

from robots import collision, control, joint, link, robot

from arm_description.urdf.description import RobotDescription
from arm_gazebo.launching.free_start import starting_free, with_initial_values
from arm_gazebo.launching.robot_setup import set_up_robot

SHAPES = {
    "base": collision("sphere", radius=0.1),
    "arm": collision("sphere", "0.5 0 0", radius=0.1),
    "hand": collision("sphere", "-0.1 0 0", radius=0.1),
}
LINKS = "".join(link(name, shape) for name, shape in SHAPES.items())
# The hand is in the base, unless its wrist is turned.
FOLDED = robot(
    LINKS,
    joint("shoulder", "base", "arm", axis="0 0 1"),
    joint("wrist", "arm", "hand", axis="0 1 0", xyz="0.25 0 0"),
)
STRAIGHT = FOLDED.replace("0.25 0 0", "0.5 0 0")


def test_a_robot_that_is_free_at_zero_stays_as_it_is():
    setup = set_up_robot(STRAIGHT)
    assert starting_free(setup) == setup


def test_a_robot_that_touches_itself_at_zero_gets_other_initial_values_and_that_is_said():
    setup = starting_free(set_up_robot(FOLDED))
    values = RobotDescription(setup.description).initial_values()
    assert values.keys() == {"wrist"}
    assert "starts with wrist at " in setup.remarks[-1]
    assert setup.remarks[-1].startswith(
        "with all joints at zero the robot touches itself or the floor, and so it starts with "
    )


def test_initial_values_of_the_description_stand():
    given = with_initial_values(set_up_robot(FOLDED).description, {"shoulder": 1.0})
    setup = set_up_robot(given)
    assert RobotDescription(given).initial_values() == {"shoulder": 1.0}
    assert starting_free(setup) == setup


def test_a_mesh_that_does_not_exist_is_left_to_move_group():
    lost = collision("mesh", filename="package://nowhere/lost.stl")
    setup = set_up_robot(FOLDED.replace(SHAPES["hand"], lost))
    assert starting_free(setup) == setup


def test_joints_that_are_only_commanded_are_left_out():
    joints = "<joint name='wrist'><command_interface name='position'/></joint>"
    setup = set_up_robot(FOLDED.replace("</robot>", control(joints) + "</robot>"))
    assert RobotDescription(starting_free(setup).description).initial_values() == {}
