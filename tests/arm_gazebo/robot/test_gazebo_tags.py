"""`<gazebo>` tags for surfaces and colours, and their effect on the model."""

import numpy as np
import pytest

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.model.builder import build_model
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions

ORANGE = (1.0, 0.51, 0.05, 1.0)
BALL = (
    '<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial>'
    '<{}><geometry><sphere radius="0.05"/></geometry></{}>'
)
SOLID, SEEN = BALL.format("collision", "collision"), BALL.format("visual", "visual")


def tags_of(text, *links):
    names = "".join(f'<link name="{name}"/>' for name in links or ("a",))
    return parse_gazebo_tags(f'<robot name="r">{names}{text}</robot>')


def build(urdf, **options):
    return build_model(
        parse_urdf(urdf), [], options=BuildOptions(**options), tags=parse_gazebo_tags(urdf)
    )


def geom_of(built, link):
    return next(g for g in range(built.model.ngeom) if built.model.geom_bodyid[g] == link)


@pytest.mark.parametrize(
    ("text", "friction"),
    [
        ("<mu1>0.4</mu1>", 0.4),
        ("<mu1>0.4</mu1><mu2>0.3</mu2>", 0.3),
        ("<mu>0.2</mu>", 0.2),
        ("<mu1>100000.0</mu1>", 10.0),
        ("<mu1>0</mu1>", 1e-5),
        ('<mu1 value="0.7"/>', 0.7),
        ("", None),
    ],
)
def test_friction(text, friction):
    tags = tags_of(f'<gazebo reference="a">{text}</gazebo>')
    assert tags.link("a").friction == friction
    assert tags.findings == ()


@pytest.mark.parametrize("text", ["nan", "-1", "", "much"])
def test_an_invalid_friction_is_left_out(text):
    tags = tags_of(f'<gazebo reference="a"><mu1>{text}</mu1></gazebo>')
    assert tags.link("a").friction is None
    assert "is not a number" in str(tags.findings[0])


@pytest.mark.parametrize(
    "text",
    [
        "<material>Gazebo/Orange</material>",
        "<material>Orange</material>",
        "<visual><material><ambient>0 0 0 1</ambient><diffuse>1 0.51 0.05 1</diffuse></material>"
        "</visual>",
        "<visual><material><ambient>1 0.51 0.05</ambient></material></visual>",
    ],
)
def test_colours(text):
    assert tags_of(f'<gazebo reference="a">{text}</gazebo>').link("a").rgba == pytest.approx(ORANGE)


def test_several_elements_about_one_link_add_up():
    tags = tags_of(
        '<gazebo reference="a"><mu1>0.5</mu1></gazebo><gazebo reference="a">'
        "<material>Gazebo/Orange</material><selfCollide>true</selfCollide></gazebo>"
    ).link("a")
    assert (tags.friction, tags.rgba, tags.self_collide) == (0.5, ORANGE, True)


def test_what_is_not_simulated_is_listed_once_with_its_first_line():
    tags = tags_of('<gazebo reference="a">\n<kp>1</kp>\n<kp>2</kp><maxVel>1</maxVel></gazebo>')
    assert [str(finding) for finding in tags.findings] == [
        "<gazebo> <kp> and 1 more (line 2): contacts have MuJoCo's own stiffness",
        "<gazebo> <maxVel> (line 3): it is not simulated",
    ]


def test_the_model_has_the_friction_and_a_slippery_link_slides_on_anything():
    built = build(
        f'<robot name="r"><link name="a">{SOLID}</link>'
        '<gazebo reference="a"><mu1>0.1</mu1></gazebo></robot>',
        base="free",
    )
    geom = geom_of(built, built.bodies["a"])
    assert built.model.geom_friction[geom, 0] == 0.1
    assert built.model.geom_priority[geom] > 0


def test_of_two_slippery_links_the_more_slippery_one_decides():
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    built = build(
        f'<robot name="r"><link name="a">{SOLID}</link><link name="b">{SOLID}</link>{joint}'
        '<gazebo reference="a"><mu1>0.1</mu1></gazebo>'
        '<gazebo reference="b"><mu1>0.5</mu1></gazebo></robot>',
        base="free",
    )
    a, b = (
        built.model.geom_priority[geom_of(built, built.bodies[link])].item() for link in ("a", "b")
    )
    assert a > b > 0


def test_the_model_has_the_colour_of_the_tag_rather_than_the_visuals():
    red = '<material name="m"><color rgba="1 0 0 1"/></material></visual>'
    built = build(
        f'<robot name="r"><link name="a">{SEEN.replace("</visual>", red)}</link>'
        '<gazebo reference="a"><material>Gazebo/Orange</material></gazebo></robot>'
    )
    assert built.model.geom_rgba[geom_of(built, built.bodies["a"])] == pytest.approx(ORANGE)


def chain(tags):
    """A base, an arm and a hand whose balls overlap once the arm is folded."""
    limit = '<limit lower="-4" upper="4" effort="1" velocity="1"/>'
    links = "".join(f'<link name="{name}">{SOLID}</link>' for name in ("base", "arm", "hand"))
    joints = "".join(
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.2 0 0.5"/><axis xyz="0 1 0"/>{limit}</joint>'
        for name, parent, child in (("j0", "base", "arm"), ("j1", "arm", "hand"))
    )
    return f'<robot name="r">{links}{joints}{tags}</robot>'


@pytest.mark.parametrize(
    ("tags", "touching"),
    [
        ("", False),
        ("<gazebo><self_collide>true</self_collide></gazebo>", True),
        ('<gazebo reference="hand"><selfCollide>true</selfCollide></gazebo>', True),
        ('<gazebo reference="arm"><selfCollide>true</selfCollide></gazebo>', False),
        ('<gazebo reference="hand"><selfCollide>false</selfCollide></gazebo>', False),
    ],
)
def test_links_collide_if_one_of_them_sets_self_collide(tags, touching):
    import mujoco

    built = build(chain(tags))
    data = mujoco.MjData(built.model)
    # Fold the hand back onto the base.
    data.qpos[built.joints["j1"].qpos_address] = 0.0
    hand, base = built.bodies["hand"], built.bodies["base"]
    first = np.array(built.model.body_pos[built.bodies["arm"]])
    built.model.body_pos[hand] = -first
    mujoco.mj_forward(built.model, data)
    pairs = {tuple(sorted(built.model.geom_bodyid[list(c.geom)])) for c in data.contact}
    assert (tuple(sorted((base, hand))) in pairs) is touching


@pytest.mark.parametrize(
    ("plugin", "said"),
    [
        ("gz-sim-odometry-publisher-system", "plugins are not loaded"),
        ("libgazebo_ros_diff_drive.so", "diff_drive_controller drives wheels"),
        ("gz-sim-joint-position-controller-system", "JointGroupPositionController moves joints"),
    ],
)
def test_an_unsupported_plugin_is_left_out_and_reported(plugin, said):
    tags = tags_of(f'<gazebo>\n<plugin filename="{plugin}" name="p"/></gazebo>')
    (finding,) = tags.findings
    assert f"<plugin filename='{plugin}'> (line 2)" in str(finding)
    assert said in str(finding)


@pytest.mark.parametrize(
    "plugin",
    [
        "gz_ros2_control-system",
        "libgz_ros2_control-system.so",
        "libgazebo_ros_control.so",
        "libgazebo_mimic_joint_plugin.so",
        "gz-sim-sensors-system",
        "gz-sim-imu-system",
        "gz-sim-joint-state-publisher-system",
    ],
)
def test_a_plugin_that_is_not_needed_is_not_reported(plugin):
    assert tags_of(f'<gazebo><plugin filename="{plugin}" name="p"/></gazebo>').findings == ()


def test_a_sensor_without_a_link_is_reported():
    (finding,) = tags_of('<gazebo><sensor name="eye" type="camera"/></gazebo>').findings
    assert "<sensor name='eye'> (line 1): no link carries it" in str(finding)
