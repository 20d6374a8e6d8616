"""Worlds in SDF, as the tutorials write them."""

import mujoco
import numpy as np
import pytest
from robots import TETRAHEDRON_OBJ

from arm_gazebo.build_report import BuildOutcome, BuildReport
from arm_gazebo.errors import WorldError
from arm_gazebo.model.world_file import load_world
from arm_gazebo.sdf.world import read_sdf_world

GROUND = """<model name="ground_plane"><static>true</static><link name="link">
  <collision name="collision"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane>
  </geometry></collision>
  <visual name="visual"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane>
  </geometry><material><ambient>0.8 0.8 0.8 1</ambient><diffuse>0.8 0.8 0.8 1</diffuse></material>
  </visual>
</link></model>
"""


def shape(geometry, pose="0 0 0 0 0 0", more=""):
    both = f"<geometry>{geometry}</geometry><pose>{pose}</pose>"
    return (
        f'<collision name="c">{both}{more}</collision><visual name="v">{both}'
        "<material><diffuse>1 0 0 1</diffuse></material></visual>"
    )


CYLINDER = shape("<cylinder><radius>0.015</radius><length>0.35</length></cylinder>")
INERTIAL = (
    "<inertial><mass>0.05</mass><inertia><ixx>5e-4</ixx><iyy>5e-4</iyy><izz>4e-6</izz></inertia>"
    "</inertial>"
)
BOX = shape("<box><size>0.2 0.4 0.6</size></box>")


def model(name, pose="0 0 0 0 0 0", link=BOX, head="", attributes=""):
    return (
        f'<model name="{name}"><pose {attributes}>{pose}</pose>{head}'
        f'<link name="link">{link}</link></model>'
    )


STATIC = "<static>true</static>"


@pytest.fixture
def write(tmp_path):
    def file(content, name="lab.sdf"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'<?xml version="1.0"?>\n<sdf version="1.7">\n{content}\n</sdf>\n')
        return path

    return file


@pytest.fixture
def world(write):
    def made(*parts):
        report = BuildReport()
        path = write('<world name="lab">\n{}\n</world>'.format("\n".join(parts)))
        compiled = read_sdf_world(path, report).compile()
        data = mujoco.MjData(compiled)
        mujoco.mj_forward(compiled, data)
        return compiled, data, report

    return made


def test_free_model_stands_on_the_ground(world):
    free = model("red_cylinder", "0.22 0.12 0.175 0 0 0", INERTIAL + CYLINDER)
    compiled, data, _ = world(GROUND, free)
    assert compiled.body("red_cylinder::link").mass[0] == pytest.approx(0.05)
    mujoco.mj_step(compiled, data, nstep=500)
    assert data.body("red_cylinder").xpos == pytest.approx([0.22, 0.12, 0.175], abs=1e-3)


@pytest.mark.parametrize(("gravity", "falls"), [("false", False), ("0", False), ("true", True)])
def test_gravity_does_not_act_on_a_link_that_says_so(world, gravity, falls):
    free = model("crate", "0 0 3 0 0 0", f"<gravity>{gravity}</gravity>{BOX}")
    compiled, data, report = world(GROUND, free)
    mujoco.mj_step(compiled, data, nstep=100)
    assert (data.body("crate").xpos[2] < 2.9) == falls
    assert report.findings == ()


def test_a_link_without_inertial_weighs_what_it_does_in_gazebo(world):
    compiled, _, report = world(model("crate"))
    crate = compiled.body("crate::link")
    assert crate.mass[0] == 1.0
    assert crate.inertia == pytest.approx([1.0, 1.0, 1.0])
    assert report.warnings == ()


def test_static_model_does_not_fall(world):
    compiled, data, _ = world(model("shelf", "1 2 3 0 0 1.5708", head=STATIC))
    assert compiled.nv == 0
    assert data.body("shelf::link").xpos == pytest.approx([1, 2, 3])
    assert data.body("shelf::link").xmat.reshape(3, 3)[:, 0] == pytest.approx([0, 1, 0], abs=1e-4)


@pytest.mark.parametrize(
    ("geometry", "kind", "size"),
    [
        ("<box><size>0.2 0.4 0.6</size></box>", "BOX", [0.1, 0.2, 0.3]),
        ("<sphere><radius>0.3</radius></sphere>", "SPHERE", [0.3, 0, 0]),
        (
            "<cylinder><radius>0.1</radius><length>0.6</length></cylinder>",
            "CYLINDER",
            [0.1, 0.3, 0],
        ),
        ("<capsule><radius>0.1</radius><length>0.6</length></capsule>", "CAPSULE", [0.1, 0.3, 0]),
    ],
)
def test_shapes(world, geometry, kind, size):
    compiled, _, _ = world(model("thing", link=shape(geometry), head=STATIC))
    assert list(compiled.geom_type) == [getattr(mujoco.mjtGeom, f"mjGEOM_{kind}")] * 2
    assert compiled.geom_size == pytest.approx(np.array([size, size]))
    assert sorted(compiled.geom_contype) == [0, 1]


def test_colour_and_friction(world):
    slippery = "<surface><friction><ode><mu>0.2</mu><mu2>0.2</mu2></ode></friction></surface>"
    link = shape("<sphere><radius>0.3</radius></sphere>", more=slippery)
    compiled, _, _ = world(model("thing", link=link, head=STATIC))
    [seen] = np.flatnonzero(compiled.geom_contype == 0)
    [touched] = np.flatnonzero(compiled.geom_contype)
    assert compiled.geom_rgba[seen] == pytest.approx([1, 0, 0, 1])
    assert compiled.geom_friction[touched][0] == pytest.approx(0.2)


def test_colours_of_gazebo_are_known_by_name_and_transparency_counts(world):
    blue = "<material><script><name>Gazebo/Blue</name></script></material>"
    geometry = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    link = f'<visual name="v">{geometry}<transparency>0.25</transparency>{blue}</visual>'
    compiled, _, _ = world(model("thing", link=link, head=STATIC))
    assert compiled.geom_rgba[0] == pytest.approx([0, 0, 1, 0.75])


def test_a_colour_of_three_numbers_hides_nothing(world):
    link = BOX.replace("1 0 0 1", "0 1 0")
    light = '<light name="lamp" type="point"><diffuse>.1 .2 .3</diffuse>{}</light>'
    compiled, _, _ = world(
        "<scene><ambient>0.1 0.2 0.3</ambient><background>0 0 1</background></scene>",
        light.format("<specular>.4 .5 .6</specular>"),
        model("thing", link=link, head=STATIC),
    )
    [seen] = np.flatnonzero(compiled.geom_contype == 0)
    assert compiled.geom_rgba[seen] == pytest.approx([0, 1, 0, 1])
    assert compiled.light("lamp").diffuse == pytest.approx([0.1, 0.2, 0.3])
    assert compiled.light("lamp").specular == pytest.approx([0.4, 0.5, 0.6])
    assert compiled.vis.headlight.ambient == pytest.approx([0.1, 0.2, 0.3])
    assert list(compiled.tex_data[:3]) == [0, 0, 255]


def test_poses_are_relative_to_models_and_frames(world):
    _, data, _ = world(
        '<frame name="table"><pose relative_to="desk">0 0 1 0 0 0</pose></frame>',
        model("desk", "2 0 0 0 0 1.5707963", head=STATIC),
        model("cup", "0.5 0 0 0 0 0", head=STATIC, attributes='relative_to="table"'),
        model("hat", "0 0 0 90 0 0", head=STATIC, attributes='degrees="true"'),
    )
    assert data.body("cup").xpos == pytest.approx([2, 0.5, 1], abs=1e-6)
    assert data.body("hat").xmat.reshape(3, 3)[:, 2] == pytest.approx([0, -1, 0], abs=1e-6)


def test_a_rotation_may_be_a_quaternion(world):
    attributes = 'rotation_format="quat_xyzw"'
    _, data, _ = world(model("hat", "1 2 3 0.7 0 0 0.7", head=STATIC, attributes=attributes))
    assert data.body("hat").xpos == pytest.approx([1, 2, 3])
    assert data.body("hat").xmat.reshape(3, 3)[:, 2] == pytest.approx([0, -1, 0], abs=1e-6)


def test_links_of_a_model_keep_their_frames(world):
    _, data, _ = world(
        '<model name="lamp"><static>true</static><link name="foot"/>'
        '<link name="head"><pose relative_to="foot">0 0 2 0 0 0</pose></link></model>'
    )
    assert data.body("lamp::head").xpos == pytest.approx([0, 0, 2])


LAMP = """<model name="lamp"><static>true</static><link name="foot"/>
  <joint name="hinge" type="revolute">{hinge}<parent>foot</parent><child>head</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
  <link name="head">{head}</link><link name="bulb">{bulb}</link></model>"""


def test_poses_may_be_relative_to_joints(world):
    """As `gz sdf -p` prints a URDF."""
    _, data, report = world(
        LAMP.format(
            hinge='<pose relative_to="foot">0 0 0.5 0 0 0</pose>',
            head='<pose relative_to="hinge"/>',
            bulb='<pose relative_to="hinge">0.1 0 0 0 0 0</pose>',
        )
    )
    assert data.body("lamp::head").xpos == pytest.approx([0, 0, 0.5])
    assert data.body("lamp::bulb").xpos == pytest.approx([0.1, 0, 0.5])
    listed = [str(f) for f in report.findings if "hinge" in f.element]
    assert listed == ["joint 'hinge' in lab.sdf (line 5): the links of a model are one rigid body"]


def test_a_joint_is_at_its_child(world):
    _, data, _ = world(
        LAMP.format(
            hinge="<pose>0 0 -0.1 0 0 0</pose>",
            head="<pose>0 0 2 0 0 0</pose>",
            bulb='<pose relative_to="hinge">0.1 0 0 0 0 0</pose>',
        )
    )
    assert data.body("lamp::bulb").xpos == pytest.approx([0.1, 0, 1.9])


PUTTING = """<model name="table" placement_frame="{frame}"><static>true</static>
  <pose>5 0 0 0 0 1.5707963</pose>
  <link name="top"><pose>1 0 0.8 0 0 0</pose></link>
  <frame name="edge" attached_to="top"><pose>0.5 0 0 0 0 0</pose></frame></model>"""
CUP = model("cup", head=STATIC, attributes='relative_to="table"')


@pytest.mark.parametrize(
    ("frame", "table", "top"),
    [
        ("", [5, 0, 0], [5, 1, 0.8]),
        ("__model__", [5, 0, 0], [5, 1, 0.8]),
        ("top", [5, -1, -0.8], [5, 0, 0]),
        ("edge", [5, -1.5, -0.8], [5, -0.5, 0]),
    ],
)
def test_a_pose_places_the_frame_that_a_model_names(world, frame, table, top):
    _, data, _ = world(PUTTING.format(frame=frame), CUP)
    assert data.body("table").xpos == pytest.approx(table, abs=1e-6)
    assert data.body("table::top").xpos == pytest.approx(top, abs=1e-6)
    assert data.body("cup").xpos == pytest.approx(table, abs=1e-6)


def test_an_include_may_name_another_frame_to_be_placed(world, write, tmp_path, monkeypatch):
    write(PUTTING.format(frame="top"), "models/table/model.sdf")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
    include = "<include><uri>model://table</uri><name>{}</name>{}</include>"
    edge = "<pose>0 0 0 0 0 0</pose><placement_frame>edge</placement_frame>"
    _, data, _ = world(
        include.format("as_it_says", ""),
        include.format("elsewhere", "<pose>0 0 0 0 0 0</pose>"),
        include.format("by_its_edge", edge),
    )
    assert data.body("as_it_says::top").xpos == pytest.approx([5, 0, 0], abs=1e-6)
    assert data.body("elsewhere::top").xpos == pytest.approx([0, 0, 0], abs=1e-6)
    assert data.body("by_its_edge").xpos == pytest.approx([-1.5, 0, -0.8], abs=1e-6)


def test_included_model_is_found_on_the_resource_path(world, write, tmp_path, monkeypatch):
    write(model("can", link=INERTIAL + CYLINDER, head=STATIC), "models/can/model.sdf")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
    include = "<include><uri>model://can</uri>{}</include>"
    compiled, data, _ = world(
        include.format("<pose>1 0 0 0 0 0</pose>"),
        include.format("<name>second</name><static>false</static><pose>2 0 0 0 0 0</pose>"),
    )
    assert data.body("can").xpos == pytest.approx([1, 0, 0])
    assert data.body("second").xpos == pytest.approx([2, 0, 0])
    assert compiled.nv == 6


def test_mesh_beside_its_file_is_found(world, write, tmp_path, monkeypatch):
    write(
        model("wedge", link=shape("<mesh><uri>wedge.obj</uri><scale>2 2 2</scale></mesh>")),
        "models/wedge/model.sdf",
    )
    (tmp_path / "models/wedge/wedge.obj").write_text(TETRAHEDRON_OBJ)
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
    compiled, _, _ = world("<include><uri>model://wedge</uri></include>")
    assert set(compiled.geom_type) == {int(mujoco.mjtGeom.mjGEOM_MESH)}
    assert np.ptp(compiled.mesh_vert[:4], axis=0).max() == pytest.approx(2 * 2**0.5, abs=0.3)


def test_sun_and_ground_of_gazebo_need_no_files(world, monkeypatch):
    monkeypatch.delenv("GZ_SIM_RESOURCE_PATH", raising=False)
    fuel = "https://fuel.gazebosim.org/1.0/OpenRobotics/models"
    compiled, _, _ = world(
        f"<include><uri>{fuel}/Sun</uri></include>",
        "<include><uri>model://ground_plane</uri></include>",
    )
    assert compiled.light("sun").dir == pytest.approx(np.array([-0.5, 0.1, -0.9]) / 1.07**0.5)
    assert sorted(compiled.geom_contype) == [0, 1]


def test_models_on_the_web_are_left_out_and_counted(world):
    fuel = "https://fuel.gazebosim.org/1.0/OpenRobotics/models"
    cans = (f"<include><uri>{fuel}/{name}</uri><pose>1 0 0 0 0 0</pose></include>" for name in "AB")
    compiled, _, report = world(*cans, model("block", head=STATIC))
    assert compiled.body("block").id > 0
    assert [(f.outcome, f.count, f.message) for f in report.findings] == [
        (BuildOutcome.LEFT_OUT, 2, f"'{fuel}/A' is on the web, and nothing is downloaded")
    ]


def test_lights(world):
    compiled, _, _ = world(
        '<light name="lamp" type="point"><pose>0 0 2 0 0 0</pose><diffuse>0.5 0.4 0.3 1</diffuse>'
        "<attenuation><constant>0.5</constant><linear>0.1</linear><quadratic>0.01</quadratic>"
        "</attenuation></light>"
    )
    assert compiled.light("lamp").pos == pytest.approx([0, 0, 2])
    assert compiled.light("lamp").diffuse == pytest.approx([0.5, 0.4, 0.3])
    assert compiled.light("lamp").attenuation == pytest.approx([0.5, 0.1, 0.01])


def test_what_is_not_simulated_is_listed_and_not_fatal(world):
    _, _, report = world(
        '<physics name="fast" type="ode"/>', '<plugin name="a" filename="b"/>' * 2, GROUND
    )
    assert [(finding.outcome, str(finding)) for finding in report.findings] == [
        (BuildOutcome.DROPPED, "physics 'fast' in lab.sdf (line 4): it is not simulated"),
        (BuildOutcome.LEFT_OUT, "plugin 'a' in lab.sdf and 1 more (line 5): it is not simulated"),
    ]
    assert report.left_out == "2 things are left out: plugin 'a' in lab.sdf and 1 more"


def test_attributes_without_effect_are_listed_too(world):
    _, _, report = world(
        '<frame name="desk"/><frame name="loose" attached_to="desk"/>',
        '<model name="a" canonical_link="l" colour="red"><static>1</static><pose frame="">0 0 0 0 '
        '0 0</pose><link name="l" sort="x"/><link name="m" sort="y"/></model>',
    )
    assert [str(finding) for finding in report.findings] == [
        "colour='red' of model 'a' in lab.sdf (line 5): it is not simulated",
        "sort='x' of link 'l' in lab.sdf and 1 more (line 5): it is not simulated",
    ]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (model("a", "0 0 0"), r"<pose> of model 'a' has '0 0 0': 3 values, not 6"),
        (model("a", "0 0 x 0 0 0"), "has 'x', which is not a finite number"),
        (model("a", link=shape("<box/>")), "<box> of .* needs a <size>"),
        (model("a", link=shape("<box><size>0 1 1</size></box>")), "they must be above 0"),
        (model("a", link=shape("<sphere><radius>-1</radius></sphere>")), "-1; it must be above 0"),
        (model("a", link=BOX.replace("1 0 0 1", "1 0")), "'1 0': 2 values, not 3 or 4"),
        (model("a", attributes='relative_to="b"'), "relative to 'b', not one of a"),
        (model("a", attributes='relative_to="a"'), "closes a circle of frames"),
        (
            LAMP.format(hinge="", head='<pose relative_to="hinge"/>', bulb="").replace("\n", ""),
            "closes a circle of frames",
        ),
        (PUTTING.format(frame="leg"), "placed by 'leg', not one of edge, top"),
        (model("a") + model("a"), "already taken"),
        ("<include><uri>model://nowhere</uri></include>", "is not available: no file"),
        ("<include/>", "needs a <uri>"),
        (
            model("a", "0 0 0 0 0 0 0", attributes='rotation_format="quat_xyzw"'),
            "has a quaternion of length 0",
        ),
        (
            model("a", attributes='rotation_format="matrix"'),
            "has the rotation_format 'matrix'; there is euler_rpy, quat_xyzw",
        ),
        (GROUND.replace("<static>true</static>", ""), "a plane cannot move"),
    ],
)
def test_errors_are_reported_with_file_and_line(world, content, said):
    with pytest.raises(WorldError, match=rf"lab\.sdf, line 4: (.|\n)*{said}"):
        world(content)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("no xml", "not XML"),
        ("<mujoco/>", "is not SDF"),
        ("<sdf/>", "needs a <world>"),
        ('<!DOCTYPE sdf [<!ENTITY a SYSTEM "/etc/passwd">]><sdf>&a;</sdf>', "DOCTYPE"),
    ],
)
def test_an_invalid_world_is_refused(tmp_path, text, said):
    path = tmp_path / "odd.world"
    path.write_text(text)
    with pytest.raises(WorldError, match=said):
        load_world(path)


def test_lights_of_one_name_are_refused(write):
    content = '<light name="sun" type="point"/><include><uri>model://sun</uri></include>'
    with pytest.raises(WorldError, match=r"lab\.sdf is not usable SDF: .*'sun' in light"):
        load_world(write(f'<world name="lab">{content}</world>'))


def test_robot_is_put_into_an_sdf_world(parts, write):
    path = write(f'<world name="lab">{GROUND}{model("shelf", "2 0 0.3 0 0 0")}</world>')
    built = parts.build(parts.pendulum(), path)
    assert built.model.body("shelf").dofnum[0] == 6
    assert built.model.body("bob").dofnum[0] == 1


@pytest.mark.parametrize("shipped", ["empty", "pick_and_place_demo", "house"])
def test_friction_holds_as_in_the_shipped_worlds(world, shipped):
    here, there = world(GROUND)[0].opt, load_world(shipped).compile().opt
    assert (here.cone, here.impratio) == (mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0)
    assert (there.cone, there.impratio) == (here.cone, here.impratio)
