import re

import mujoco
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from robots import TETRAHEDRON_OBJ

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.world.spawn_model import ModelSource

SOURCE = ModelSource(0.002)
NASTY = st.sampled_from(
    [
        *("", " ", "0", "-0", "-1", "1e308", "1e-320", "1e400", "nan", "inf", "1 2", "0 0 0"),
        *("a" * 3000, "ä", "world", "base", "link", "freejoint", "../..", "/dev/zero", "&lt;"),
        *("<", ">", "/", '"', "<!--", "<![CDATA[", "&e;", "mesh", "plane", "hfield", "sdf"),
    ]
)
WORDS = re.compile(r"""(?<=")[^"<>]*(?=")|(?<=<)/?[\w:]+|(?<=>)[^<>]+(?=<)|[<>/="]""")


def refused(text: str) -> tuple[Refusal, str]:
    with pytest.raises(RequestError) as caught:
        SOURCE.read("", text)
    return caught.value.refusal, str(caught.value)


@pytest.mark.parametrize(
    ("name", "format_", "root"),
    [("crate", "urdf", "base"), ("ball", "sdf", "ball"), ("puck", "mjcf", "thing")],
)
def test_each_format_is_known_by_its_root_element(things, name, format_, root):
    model = SOURCE.read("", getattr(things, name))
    assert (model.format, model.root) == (format_, root)
    assert model.spec.copy().compile().nq == 7


def test_a_model_in_a_model_is_spawned_as_one_or_refused(things):
    inner = things.ball[things.ball.index("<model") : things.ball.index("</sdf>")]
    outer = '<sdf version="1.9"><model name="outer">{}</model></sdf>'
    model = SOURCE.read("", outer.format(inner))
    assert (model.root, model.spec.copy().compile().nv) == ("outer", 6)
    kind, words = refused(outer.format(f'<link name="plate"/>{inner}'))
    assert kind is Refusal.UNREADABLE
    assert "exactly one top-level body" in words
    joint = "<joint name='j' type='fixed'><parent>plate</parent><child>ball::body</child></joint>"
    tied = SOURCE.read("", outer.format(f'<link name="plate"/>{inner}{joint}'))
    assert tied.root == "outer"


def test_a_margin_with_a_gap_is_reported():
    puck = (
        '<mujoco><worldbody><body><geom size="1" margin="1" gap="0.5"/></body></worldbody></mujoco>'
    )
    (finding,) = SOURCE.read("", puck).findings
    assert "write margin='0.5'" in finding.message


def test_joints_of_a_urdf_move(things):
    model = SOURCE.read("", things.chest).spec.copy().compile()
    assert model.joint("hinge").range == pytest.approx([-1.5, 1.5])


def link(name: str, size: str, centre: str = "0 0 0") -> str:
    return (
        f'<link name="{name}"><inertial><origin xyz="{centre}"/><mass value="1"/>'
        '<inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><origin xyz="{centre}"/><geometry><box size="{size}"/></geometry></collision>'
        "</link>"
    )


def cupboard(more: str = "") -> str:
    """Return a URDF bolted to the world, whose door reaches 5 mm into it and has a knob."""
    return (
        '<robot name="cupboard"><link name="world"/>'
        + link("case", "0.5 0.5 0.8")
        + link("door", "0.02 0.5 0.8", "0 -0.25 0")
        + link("knob", "0.05 0.05 0.05", "0.02 -0.45 0")
        + '<joint name="bolt" type="fixed"><parent link="world"/><child link="case"/>'
        '<origin xyz="0 0 1"/></joint>'
        '<joint name="hinge" type="revolute"><parent link="case"/><child link="door"/>'
        '<origin xyz="0.255 0.25 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint>'
        '<joint name="screw" type="fixed"><parent link="door"/><child link="knob"/></joint>'
        f"{more}</robot>"
    )


def test_the_door_of_a_spawned_cupboard_swings_freely():
    model = SOURCE.read("", cupboard()).spec.copy().compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    assert data.ncon == 0
    assert data.qpos == pytest.approx([0.0], abs=1e-6)
    data.qfrc_applied[0] = 0.2
    mujoco.mj_step(model, data, 500)
    assert data.qpos[0] > 0.2


@pytest.mark.parametrize(
    ("tag", "touch"),
    [
        ("", False),
        ("<gazebo><self_collide>true</self_collide></gazebo>", True),
        ("<gazebo reference='stop'><selfCollide>true</selfCollide></gazebo>", True),
    ],
)
def test_links_of_a_spawned_model_collide_only_with_self_collide(tag, touch):
    """A door against a stop on another joint, neither its neighbour nor overlapping at first."""
    stop = (
        link("stop", "0.1 0.1 0.1", "0.35 -0.1 0")
        + '<joint name="slide" type="prismatic"><parent link="case"/><child link="stop"/>'
        '<axis xyz="0 0 1"/><limit lower="0" upper="0.001" effort="1" velocity="1"/></joint>'
    )
    model = SOURCE.read("", cupboard(stop + tag)).spec.copy().compile()
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = 0.2
    mujoco.mj_step(model, data, 1000)
    assert bool(data.joint("hinge").qpos[0] < 0.3) is touch


def test_a_urdf_with_a_world_link_is_static():
    text = (
        "<robot name='r'><link name='world'/><link name='post'/><joint name='j' type='fixed'>"
        "<parent link='world'/><child link='post'/></joint></robot>"
    )
    model = SOURCE.read("", text)
    assert model.root == "post"
    assert model.spec.copy().compile().nq == 0


@pytest.mark.parametrize(
    ("text", "refusal", "words"),
    [
        ("", Refusal.NO_RESOURCE, "neither uri nor resource_string"),
        ("no xml", Refusal.UNREADABLE, "resource_string"),
        ("<a/>", Refusal.UNSUPPORTED_FORMAT, "<a> is not one of"),
        ("<robot/>", Refusal.UNREADABLE, "needs the attribute 'name'"),
        ("<sdf/>", Refusal.UNREADABLE, "LoadWorld"),
        ("<sdf><world name='w'/></sdf>", Refusal.UNREADABLE, "LoadWorld"),
        ("<mujoco/>", Refusal.UNREADABLE, "one top-level body"),
        ("<mujoco><worldbody><body/><body/></worldbody></mujoco>", Refusal.UNREADABLE, "thing_2"),
        (
            "<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>",
            Refusal.UNREADABLE,
            "mass and inertia",
        ),
        (
            "<mujoco><asset><mesh file='/etc/passwd'/></asset></mujoco>",
            Refusal.MISSING_ASSETS,
            "a text has no folder",
        ),
    ],
)
def test_an_invalid_model_is_refused_with_the_reason(text, refusal, words):
    kind, message = refused(text)
    assert kind is refusal
    assert words in message


@pytest.mark.parametrize("mass", ["inf", "1e308"])
def test_numbers_that_cannot_be_simulated_are_refused(things, mass):
    kind, message = refused(things.puck.replace('mass="0.1"', f'mass="{mass}"'))
    assert kind is Refusal.UNREADABLE
    assert "cannot be simulated" in message or "mass" in message


def test_a_missing_mesh_is_a_refusal(things):
    text = things.crate.replace("<box size='0.1 0.1 0.1'/>", "<mesh filename='model://no/x.stl'/>")
    kind, message = refused(text)
    assert kind is Refusal.MISSING_ASSETS
    assert "model://no/x.stl" in message


def test_entities_of_xml_are_not_expanded():
    kind, _ = refused("<!DOCTYPE r [<!ENTITY e SYSTEM 'file:///etc/passwd'>]><robot name='&e;'/>")
    assert kind is Refusal.UNREADABLE


@pytest.mark.parametrize(
    ("uri", "refusal"),
    [
        ("/no/such/file.urdf", Refusal.NO_RESOURCE),
        ("package://nowhere/x.urdf", Refusal.NO_RESOURCE),
        ("http://example.org/x.sdf", Refusal.NO_RESOURCE),
        ("/dev/null", Refusal.NO_RESOURCE),
        ("/", Refusal.NO_RESOURCE),
        ("\x00", Refusal.NO_RESOURCE),
    ],
)
def test_invalid_files_are_refused(uri, refusal):
    with pytest.raises(RequestError) as caught:
        SOURCE.read(uri, "")
    assert caught.value.refusal is refusal


@pytest.mark.parametrize("name", ["post.urdf", "post.urdf.xacro"])
def test_a_file_with_xacro_in_it_is_expanded(tmp_path, name):
    (tmp_path / name).write_text(
        "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>"
        "<xacro:property name='foot' value='post'/><link name='world'/><link name='${foot}'/>"
        "<joint name='j' type='fixed'><parent link='world'/><child link='${foot}'/></joint></robot>"
    )
    assert SOURCE.read(str(tmp_path / name), "").root == "post"


def test_a_folder_of_an_sdf_model_will_do(things, tmp_path, monkeypatch):
    folder = tmp_path / "my_ball"
    folder.mkdir()
    (folder / "model.sdf").write_text(things.ball)
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    assert SOURCE.read("model://my_ball", "").root == "ball"


def test_an_mjcf_file_brings_its_meshes(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "pyramid.obj").write_text(TETRAHEDRON_OBJ)
    file = tmp_path / "thing.xml"
    file.write_text(
        "<mujoco><asset><mesh name='p' file='meshes/pyramid.obj'/></asset><worldbody>"
        "<body name='b'><geom type='mesh' mesh='p'/></body></worldbody></mujoco>"
    )
    model = SOURCE.read(str(file), "")
    world = mujoco.MjSpec()
    world.worldbody.add_frame().attach_body(model.spec.copy().body("b"), "one::", "")
    assert world.compile().nmesh == 1


@pytest.mark.parametrize("name", ["../x.obj", "/x.obj"])
def test_an_mjcf_file_reads_nothing_from_elsewhere(tmp_path, name):
    file = tmp_path / "thing.xml"
    file.write_text(f"<mujoco><asset><mesh file='{name}'/></asset></mujoco>")
    with pytest.raises(RequestError, match="outside the folder of the MJCF file"):
        SOURCE.read(str(file), "")


@pytest.mark.parametrize("side", ["right", "left", "up", "down", "front", "back"])
def test_the_sides_of_a_texture_are_files_too(tmp_path, side):
    file = tmp_path / "thing.xml"
    file.write_text(f"<mujoco><asset><texture file{side}='../x.png'/></asset></mujoco>")
    with pytest.raises(RequestError, match="outside the folder of the MJCF file"):
        SOURCE.read(str(file), "")


@pytest.mark.parametrize("included", ["in/a.xml", "loop.xml", "in/b.xml"])
def test_what_an_mjcf_file_includes_reads_nothing_from_elsewhere_either(tmp_path, included):
    (tmp_path / "in").mkdir()
    for name, content in {
        "thing.xml": f"<include file='{included}'/>",
        "loop.xml": "<include file='loop.xml'/><include file='in/a.xml'/>",
        "in/a.xml": "<asset><mesh file='../../x.obj'/></asset>",
        "in/b.xml": "<include file='in/a.xml'/>",
    }.items():
        (tmp_path / name).write_text(f"<mujoco>{content}</mujoco>")
    with pytest.raises(RequestError, match="outside the folder of the MJCF file"):
        SOURCE.read(str(tmp_path / "thing.xml"), "")


# MuJoCo warns of an almost singular inertia, and goes on.
@pytest.mark.filterwarnings("ignore:Inertia matrix is too close to singular")
@settings(max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_spoilt_texts_are_refused_or_can_be_simulated(things, data):
    text = data.draw(st.sampled_from([things.chest, things.ball, things.puck]))
    for _ in range(data.draw(st.integers(1, 3))):
        places = list(WORDS.finditer(text))
        place = places[data.draw(st.integers(0, len(places) - 1))]
        text = text[: place.start()] + data.draw(NASTY) + text[place.end() :]
    message = ""
    mass = np.zeros(1)
    try:
        mass = SOURCE.read("", text).spec.copy().compile().body_mass
    except RequestError as error:
        message = str(error)
    assert message.strip() or np.isfinite(mass).all()
