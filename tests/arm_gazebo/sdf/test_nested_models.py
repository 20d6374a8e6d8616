"""Nested models, written in place or included."""

import os

import mujoco
import numpy as np
import pytest
from robots import TETRAHEDRON_OBJ

from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import WorldError
from arm_gazebo.sdf.world import read_sdf_world

BOX = "<geometry><box><size>0.2 0.2 0.2</size></box></geometry>"
LINK = f'<link name="{{}}"><collision name="c">{BOX}</collision></link>'
STATIC = "<static>true</static>"


def link(name, pose="0 0 0 0 0 0", more=""):
    return LINK.format(name).replace("<collision", f"<pose>{pose}</pose>{more}<collision")


def model(name, *parts, pose="0 0 0 0 0 0", attributes=""):
    return f'<model name="{name}" {attributes}><pose>{pose}</pose>{"".join(parts)}</model>'


def include(name, *parts):
    return f"<include><uri>model://{name}</uri>{''.join(parts)}</include>"


def joint(parent, child, kind="fixed"):
    return (
        f'<joint name="{parent}_{child}" type="{kind}"><parent>{parent}</parent>'
        f"<child>{child}</child></joint>"
    )


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return the folder of the models, having put some in it."""
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))

    def write(**models):
        for name, text in models.items():
            path = tmp_path / "models" / name / "model.sdf"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f'<sdf version="1.9">\n{text}\n</sdf>')
        return tmp_path

    write(
        table=model("table", STATIC, link("top", "0 0 0.8 0 0 0"), pose="0 0 0.1 0 0 0"),
        cup=model("cup", link("body")),
    )
    return write


@pytest.fixture
def world(folder):
    def made(*parts, **models):
        path = folder(**models) / "house.sdf"
        path.write_text(f'<sdf version="1.9">\n<world name="house">{"".join(parts)}</world></sdf>')
        report = BuildReport()
        compiled = read_sdf_world(path, report).compile()
        data = mujoco.MjData(compiled)
        mujoco.mj_forward(compiled, data)
        return compiled, data, report

    return made


def test_a_model_that_only_includes_another_holds_it(world):
    """As the models of many a house are written."""
    wrapped = model("table_01", include("table"), pose="2 0 0 0 0 1.5707963")
    compiled, data, report = world(wrapped)
    assert data.body("table_01::table::top").xpos == pytest.approx([2, 0, 0.9])
    assert compiled.nv == 0
    assert report.findings == ()


def test_an_included_model_without_a_joint_falls_separately(world):
    compiled, _, _ = world(model("cup_01", include("cup"), pose="0 0 3 0 0 0"))
    assert compiled.body("cup_01").dofnum == 6


def test_names_and_poses_of_an_include_count(world):
    parts = include("table", "<name>desk</name><pose>1 2 3 0 0 0</pose>")
    _, data, _ = world(model("room", STATIC, parts, pose="10 0 0 0 0 0"))
    assert data.body("room::desk::top").xpos == pytest.approx([11, 2, 3.8])


def test_a_pose_may_be_relative_to_a_frame_of_another_model(world):
    cup = '<pose relative_to="desk::top">0 0 0.2 0 0 0</pose>'
    _, data, _ = world(
        model(
            "room",
            STATIC,
            include("table", "<name>desk</name>"),
            include("cup", cup),
            '<frame name="handle" attached_to="cup::body"><pose>0.1 0 0 0 0 0</pose></frame>',
            link("hook").replace("<pose>", '<pose relative_to="handle">'),
        ),
        model("lamp", STATIC, link("foot")).replace("<pose>", '<pose relative_to="room::hook">', 1),
    )
    assert data.body("room::cup::body").xpos == pytest.approx([0, 0, 1.1])
    assert data.body("room::hook").xpos == pytest.approx([0.1, 0, 1.1])
    assert data.body("lamp").xpos == pytest.approx([0.1, 0, 1.1])


@pytest.mark.parametrize("how", ["element", "attribute"])
def test_a_frame_of_the_inner_model_is_placed(world, how):
    if how == "element":
        inner = include("table", "<pose/><placement_frame>top</placement_frame>")
    else:
        inner = model("table", link("top", "0 0 0.8 0 0 0"), attributes='placement_frame="top"')
    _, data, _ = world(model("room", STATIC, inner, pose="0 0 5 0 0 0"))
    assert data.body("room::table::top").xpos == pytest.approx([0, 0, 5])


def test_models_nest_to_any_depth_written_or_included(world):
    _, data, _ = world(
        include("flat", "<pose>0 0 10 0 0 0</pose>"),
        flat=model("flat", STATIC, model("room", include("corner"), pose="1 0 0 0 0 0")),
        corner=model("corner", include("table", "<pose>0 1 0 0 0 0</pose>")),
    )
    assert data.body("flat::room::corner::table::top").xpos == pytest.approx([1, 1, 10.8])


def test_joints_tie_models_together(world):
    compiled, data, report = world(
        model(
            "tray",
            link("plate"),
            include("cup", "<pose>0 0 0.3 0 0 0</pose>"),
            joint("plate", "cup::body"),
            pose="0 0 3 0 0 0",
        )
    )
    assert compiled.nv == 6
    mujoco.mj_step(compiled, data, nstep=100)
    apart = data.body("tray::cup::body").xpos - data.body("tray::plate").xpos
    assert apart == pytest.approx([0, 0, 0.3])
    assert report.findings == ()


def test_models_that_no_joint_ties_are_things_of_their_own(world):
    compiled, data, _ = world(
        model(
            "tray",
            link("plate"),
            include("cup", "<pose>0 0 0.3 0 0 0</pose>"),
            include("table"),
            pose="0 0 3 0 0 0",
        )
    )
    assert compiled.nv == 12
    assert data.body("tray::cup").xpos == pytest.approx([0, 0, 3.3])
    assert data.body("tray::table::top").xpos == pytest.approx([0, 0, 3.9])


@pytest.mark.parametrize(
    ("outer", "inner", "free"),
    [
        ("", "", True),
        (STATIC, "", False),
        ("", STATIC, False),
        (STATIC, "<static>false</static>", False),
    ],
)
def test_models_in_a_static_model_are_static(world, outer, inner, free):
    compiled, _, _ = world(model("outer", outer, include("cup", inner)))
    assert compiled.nv == (6 if free else 0)


def test_a_joint_to_the_world_holds_a_model(world):
    compiled, _, _ = world(model("lamp", link("foot"), joint("world", "foot")))
    assert compiled.nv == 0


def test_a_merged_model_has_no_separate_name(world):
    merged = include("table", "<pose>0 0 1 0 0 0</pose>").replace(
        "<include>", "<include merge='1'>"
    )
    _, data, report = world(
        model("room", STATIC, merged, link("vase").replace("<pose>", '<pose relative_to="top">'))
    )
    assert data.body("room::top").xpos == pytest.approx([0, 0, 1.8])
    assert data.body("room::vase").xpos == pytest.approx([0, 0, 1.8])
    assert report.findings == ()


def test_a_model_beside_the_includer_is_found_without_any_path(world, monkeypatch, tmp_path):
    (tmp_path / "models/cup").mkdir(parents=True, exist_ok=True)
    (tmp_path / "models/cup/wedge.obj").write_text(TETRAHEDRON_OBJ)
    monkeypatch.delenv("GZ_SIM_RESOURCE_PATH")
    mesh = "<geometry><mesh><uri>model://cup/wedge.obj</uri></mesh></geometry>"
    compiled, _, report = world(
        "<include><uri>models/room</uri></include>",
        room=model("room", include("cup")),
        cup=model("cup", f'<link name="body"><visual name="v">{mesh}</visual></link>'),
    )
    assert compiled.nmesh == 1
    assert report.findings == ()


def test_gazebos_own_sun_and_ground_may_stand_in_a_model(world):
    compiled, _, _ = world(model("scene", STATIC, include("sun"), include("ground_plane")))
    assert compiled.nlight == 1
    assert mujoco.mjtGeom.mjGEOM_PLANE in compiled.geom_type


@pytest.mark.parametrize(
    ("parts", "models", "said"),
    [
        (
            [include("a")],
            {"a": model("a", include("b")), "b": model("b", include("a"))},
            r"b/model\.sdf, line 2: <include> of model 'b' includes a/model\.sdf within itself",
        ),
        ([model("a", include("nowhere"))], {}, r"house\.sdf, line 2: .* is not available"),
        (
            [model("a", include("cup"), include("cup"))],
            {},
            "has the name 'cup', which is already taken",
        ),
        (
            [model("a", link("cup"), include("cup"))],
            {},
            "has the name 'cup', which is already taken",
        ),
        ([model("a", include("cup", '<pose relative_to="table::no"/>'))], {}, "not one of cup"),
        (
            [model("a", include("cup", '<pose relative_to="cup::lip"/>'))],
            {},
            "relative to 'lip', not one of body|relative to 'cup::lip'",
        ),
        ([model("a", include("cup", '<pose relative_to="cup::body"/>'))], {}, "a circle of frames"),
        ([model("", link("b"))], {}, "needs a name"),
    ],
)
def test_errors_are_reported(world, parts, models, said):
    with pytest.raises(WorldError, match=said):
        world(*parts, **models)


def test_an_included_fifo_is_refused(world, tmp_path):
    os.mkfifo(tmp_path / "fifo.sdf")
    with pytest.raises(WorldError, match=r"cannot read .*fifo\.sdf: it is a FIFO"):
        world("<include><uri>fifo.sdf</uri></include>")


def test_files_that_multiply_are_refused(world, monkeypatch):
    monkeypatch.setattr("arm_gazebo.sdf.scope.MAX_MODELS", 500)
    models = {
        f"m{i}": model(f"m{i}", *(include(f"m{i + 1}", f"<name>n{k}</name>") for k in range(10)))
        for i in range(9)
    }
    with pytest.raises(WorldError, match="the limit of 500 models"):
        world(include("m0"), m9=model("m9", link("l")), **models)


def test_a_house_of_87_parts_has_them_all(world):
    parts = [
        model(f"part_{i}", include("table", f"<name>t{i}</name>"), pose=f"{i} 0 0 0 0 0")
        for i in range(87)
    ]
    compiled, _, report = world(*parts)
    assert np.count_nonzero(compiled.geom_contype) == 87
    assert report.findings == ()
