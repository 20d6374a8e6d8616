"""Which wheels get rollers, and what becomes of those that cannot."""

import mujoco
import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.model.builder import build_model
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.robot.rollers import COUNT

ELLIPSOID = mujoco.mjtGeom.mjGEOM_ELLIPSOID


@pytest.fixture
def cart(parts):
    """Build a cart whose left wheel has <gazebo> tags; it has a second, plain wheel."""

    def make(tags, kind="continuous", axis="0 1 0"):
        wheels = [
            part
            for side, y in (("left", 0.2), ("right", -0.2))
            for part in (
                wheel(side),
                parts.joint(f"{side}_j", "base", side, kind, f"0 {y} 0", axis),
            )
        ]
        gazebo = f'<gazebo reference="left">{tags}</gazebo>'
        control = parts.ros2_control(["left_j", "right_j"])
        urdf = parts.robot(parts.link("base", 5.0), *wheels, gazebo, control)

        return build_model(
            parse_urdf(urdf),
            parse_hardware_info(urdf),
            options=BuildOptions(base="free"),
            tags=parse_gazebo_tags(urdf),
        )

    return make


def wheel(name):
    return (
        f'<link name="{name}"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"'
        ' ixy="0" ixz="0" iyz="0"/></inertial><collision><origin rpy="1.5707963 0 0"/><geometry>'
        '<cylinder radius="0.1" length="0.04"/></geometry></collision></link>'
    )


def tags(direction="1 -1 0", along=1.0, across=0.0, attribute=""):
    return f"<mu1>{along}</mu1><mu2>{across}</mu2><fdir1 {attribute}>{direction}</fdir1>"


def rollers(built, link="left"):
    model = built.model
    parent = model.body(link).id
    return [body for body in range(model.nbody) if model.body_parentid[body] == parent]


def lowest_axis(built):
    """Return the axis of the roller on the floor in the world, the first component positive."""
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_kinematics(built.model, data)
    lowest = min(rollers(built), key=lambda body: data.xpos[body][2])
    axis = data.xmat[lowest].reshape(3, 3)[:, 2]
    return axis * np.sign(axis[0])


@pytest.mark.parametrize(
    ("direction", "axis"),
    [("1 -1 0", (1, -1, 0)), ("-1 -1 0", (1, 1, 0)), ("1 0 0", (1, 0, 0)), ("2 1 5", (2, 1, 0))],
)
def test_the_roller_on_the_floor_lies_along_the_grip(cart, direction, axis):
    built = cart(tags(direction))
    assert len(rollers(built)) == COUNT
    assert lowest_axis(built) == pytest.approx(np.array(axis) / np.linalg.norm(axis), abs=1e-6)
    assert rollers(built, "right") == []


def test_the_grip_may_be_given_in_another_link(cart):
    built = cart(tags(attribute='xmlns:gz="http://gazebosim.org" gz:expressed_in="base"'))
    assert lowest_axis(built) == pytest.approx([0.5**0.5, -(0.5**0.5), 0], abs=1e-6)


def test_wheel_and_rollers_weigh_what_the_wheel_weighs(cart):
    model = cart(tags()).model
    assert model.body("left").subtreemass[0] == pytest.approx(1.0)


def test_the_rim_stands_on_the_floor(cart):
    built = cart(tags())
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    assert data.body("left").xpos[2] == pytest.approx(0.1, abs=1e-4)
    mujoco.mj_step(built.model, data, 50)
    touching = {built.model.geom_bodyid[pair[1]] for pair in data.contact.geom}
    assert touching & set(rollers(built))


@pytest.mark.parametrize(
    ("given", "more"),
    [(tags(across=0.5), {}), ("<mu1>1.0</mu1><mu2>0.0</mu2>", {})],
    ids=["it grips to the side", "no direction"],
)
def test_friction_without_a_clear_direction_makes_a_plain_wheel(cart, given, more):
    assert rollers(cart(given, **more)) == []


@pytest.mark.parametrize(
    ("given", "more", "words"),
    [
        (tags(), {"kind": "revolute"}, "joint 'left_j' is not continuous"),
        (tags(), {"axis": "1 0 0"}, "does not turn about its own axis with joint 'left_j'"),
        (tags("0 1 0"), {}, "would be parallel to the wheel's axis and could not drive"),
    ],
)
def test_what_cannot_have_rollers_keeps_its_shape_and_a_warning_says_why(cart, given, more, words):
    built = cart(given, **more)
    assert rollers(built) == []
    assert any(words in str(finding) for finding in built.report.findings)


@pytest.mark.parametrize("direction", ["1 0", "0 0 0", "1 nan 0", "ahead"])
def test_an_invalid_direction_is_a_warning(direction):
    found = parse_gazebo_tags(
        f'<robot name="r"><link name="left"/><gazebo reference="left">{tags(direction)}</gazebo>'
        "</robot>"
    )
    assert found.link("left").grip is None
    assert "not a direction x y z" in str(found.findings[0])


def test_a_frame_that_is_not_a_link_is_a_warning():
    found = parse_gazebo_tags(
        '<robot name="r"><link name="left"/><gazebo reference="left">'
        '<fdir1 expressed_in="right">1 1 0</fdir1></gazebo></robot>'
    )
    assert "given in 'right', which is not a link" in str(found.findings[0])
