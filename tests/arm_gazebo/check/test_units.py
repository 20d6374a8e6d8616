"""Remarks of `arm check` about values in another unit, and about what ROS's own parser refuses."""

import pytest

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.build_report import BuildOutcome
from arm_gazebo.check.description import check_description

INERTIAL = '<inertial><mass value="{mass}"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3"/></inertial>'
ROBOT = """<robot name="r"{robot}>
<link name="base"/>
<link name="arm">
{inertial}
<visual><geometry><{shape}/></geometry></visual>
</link>
<joint name="j" type="{kind}">
<origin {origin}/><parent link="base"/><child link="arm"/>
<limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="{velocity}"/>{more}
</joint></robot>"""
PLAIN = {
    "robot": "",
    "inertial": INERTIAL.format(mass=1),
    "shape": 'box size="0.1 0.1 0.4"',
    "kind": "revolute",
    "origin": 'xyz="0 0 0.3"',
    "lower": "-3.14",
    "upper": "3.14",
    "effort": "10",
    "velocity": "3",
    "more": "",
}


def findings(**changes: str) -> list[tuple[str, int, str]]:
    """Return the remarks on a small arm in which some parts are changed."""
    found = check_description(ROBOT.format(**{**PLAIN, **changes}), "r.urdf").findings
    outcomes = (BuildOutcome.DOUBTFUL, BuildOutcome.DROPPED, BuildOutcome.FAILED)
    return [(str(f), f.line, f.message) for f in found if f.outcome in outcomes]


def test_a_sound_arm_gets_no_remark():
    assert findings() == []


@pytest.mark.parametrize(
    ("changes", "line", "said"),
    [
        (
            {"lower": "-180", "upper": "180"},
            7,
            'are 29 turns; in degrees they would be lower="-3.142" upper="3.142"',
        ),
        ({"lower": "-90", "upper": "0"}, 7, 'in degrees they would be lower="-1.571" upper="0"'),
        (
            {"velocity": "180"},
            7,
            '180 rad/s is 29 turns a second; in degrees it would be velocity="3.142"',
        ),
        ({"origin": 'xyz="0 0 300"'}, 7, 'from millimetres it would be xyz="0 0 0.3"'),
        ({"shape": 'box size="100 100 400"'}, 3, "its box is 400 m long; from millimetres it"),
        ({"shape": 'cylinder radius="40" length="9"'}, 3, "its cylinder is 80 m long"),
        (
            {"inertial": INERTIAL.format(mass=0.027), "effort": "200"},
            3,
            "it weighs 27 g, but its joints could lift 68 kg at its reach of 0.3 m",
        ),
    ],
)
def test_another_unit_is_one_remark_with_its_line_and_what_to_write(changes, line, said):
    [(text, at, _)] = findings(**changes)
    assert said in text
    assert at == line


@pytest.mark.parametrize(
    "changes",
    [
        {"lower": "-62", "upper": "62"},  # ten turns of a winch
        {"kind": "continuous", "velocity": "80"},
        {"kind": "prismatic", "lower": "-90", "upper": "90", "velocity": "100"},
        {"velocity": "1e308"},
        {"origin": 'xyz="0 0 15"'},
    ],
)
def test_large_but_sound_values_get_no_remark(changes):
    assert findings(**changes) == []


@pytest.mark.parametrize(
    ("changes", "line", "said"),
    [
        ({"origin": 'xyz="0\t0 0.3"'}, 8, "has a tab or a line end between its numbers in xyz='0"),
        ({"origin": 'xyz="0&#10;0 0.3"'}, 8, "has a tab or a line end between its numbers"),
        ({"upper": "3.14 "}, 9, "<limit> (line 9): has a blank behind its number in upper='3.14'"),
        ({"inertial": INERTIAL.format(mass="1 ")}, 4, "<mass> (line 4): has a blank behind"),
        ({"more": "<dynamics/>"}, 9, "<dynamics> of joint 'j' (line 9): has neither damping nor"),
        ({"robot": ' version="1.1"'}, 1, "has version='1.1'; Jazzy knows only 1.0"),
    ],
)
def test_what_ros_own_parser_does_not_accept_is_said(changes, line, said):
    [(text, at, message)] = findings(**changes)
    assert said in text
    assert message.endswith(
        "urdfdom, which a real robot_state_publisher uses, does not accept that"
    )
    assert at == line


def test_a_safety_controller_without_k_velocity_is_said():
    found = findings(more='<safety_controller soft_upper_limit="1"/>')
    assert any("has no k_velocity" in text for text, _, _ in found)


@pytest.mark.parametrize(
    "changes",
    [
        {"origin": 'xyz=" 0  0 0.3 "'},
        {"upper": " 3.14"},
        {"more": '<dynamics damping="0"/>'},
        {"more": '<safety_controller k_velocity="1"/><!-- <origin xyz="0\t0 0"/> -->'},
    ],
)
def test_what_it_accepts_is_not_said(changes):
    assert not any("urdfdom" in text for text, _, _ in findings(**changes))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"shape": 'box size="1 1 1" colour="red"'},
            "colour='red' of <box> of link 'arm' (line 5)",
        ),
        ({"robot": ' author="me"'}, "author='me' of <robot> (line 1)"),
        ({"more": '<limit jerk="1"/>'}, ""),
        ({"origin": 'xyz="0 0 0.3" degrees="true"'}, "degrees='true' of <origin> of joint 'j'"),
    ],
)
def test_attributes_that_nobody_reads_are_listed(changes, said):
    assert any(said in text and "does not use it" in text for text, _, _ in findings(**changes))


QUARTER = 'xyz="0 0 0.3" quat_xyzw="0 0 0.7071068 0.7071068"'


@pytest.mark.parametrize("version", ["1.1", "1.2"])
def test_a_quaternion_is_read_in_urdf_1_1_and_1_2(version):
    urdf = ROBOT.format(**{**PLAIN, "origin": QUARTER, "robot": f' version="{version}"'})
    origin = parse_urdf(urdf).joint("j").origin
    assert origin.xyz == (0.0, 0.0, 0.3)
    assert origin.rpy == pytest.approx((0.0, 0.0, 1.5707963), abs=1e-6)


def test_a_quaternion_of_any_length_is_a_rotation():
    origin = QUARTER.replace("0.7071068", "1e300")
    urdf = ROBOT.format(**{**PLAIN, "origin": origin, "robot": ' version="1.1"'})
    assert parse_urdf(urdf).joint("j").origin.rpy == pytest.approx((0, 0, 1.5707963), abs=1e-6)


def test_a_quaternion_in_urdf_1_0_is_ignored_with_a_remark():
    remarks = []
    urdf = ROBOT.format(**{**PLAIN, "origin": QUARTER})
    assert parse_urdf(urdf, "r.urdf", remarks.append).joint("j").origin.rpy == (0.0, 0.0, 0.0)
    assert [str(remark) for remark in remarks] == [
        "line 8: <origin> of joint 'j' has quat_xyzw, which is ignored in URDF 1.0; it needs "
        '<robot version="1.1">'
    ]


@pytest.mark.parametrize(
    ("origin", "problem"),
    [
        ('quat_xyzw="0 0 0 0"', "has a quat_xyzw that is no rotation"),
        ('quat_xyzw="0 0 1"', "3 values, not 4"),
        ('quat_xyzw="0 0 0 1" rpy="0 0 0"', "has both rpy and quat_xyzw"),
    ],
)
def test_a_wrong_quaternion_is_an_error_with_its_line(origin, problem):
    [(text, at, _), *_] = findings(origin=origin, robot=' version="1.1"')[1:]
    assert problem in text
    assert at == 8
