import os

import mujoco
import numpy as np
import pytest

from arm_gazebo.build_report import BuildOutcome, BuildReport
from arm_gazebo.errors import ModelError, WorldError
from arm_gazebo.launching.world_path import find_world, shipped_worlds
from arm_gazebo.model.world_file import load_world
from arm_gazebo.sensors.camera_reader import parse_cameras

FRONT_CAMERA_SEES = {
    "purple_sphere",
    "orange_cylinder",
    "red_box",
    "blue_box",
    "green_cylinder",
    "yellow_sphere",
}


def test_shipped_worlds_are_found_by_name():
    assert {"empty", "objects"} <= set(shipped_worlds())
    assert find_world("objects").name == "objects.xml"


def test_own_world_is_found_by_its_path(tmp_path):
    world = tmp_path / "mine.xml"
    world.write_text("<mujoco/>")
    assert find_world(str(world)) == world


def test_what_an_mjcf_world_has_in_vain_is_reported(tmp_path):
    world = tmp_path / "mine.xml"
    world.write_text(
        "<mujoco><option timestep='0.001'/><worldbody><body><joint name='j'/><geom size='.1'/>"
        "</body></worldbody><actuator><motor name='m' joint='j'/><motor name='n' joint='j'/>"
        "</actuator><keyframe><key name='up' qpos='1'/></keyframe>"
        "<sensor><jointpos joint='j'/></sensor></mujoco>"
    )
    report = BuildReport()
    load_world(world, report)
    assert [(f.outcome, f.element) for f in report.findings] == [
        (BuildOutcome.DROPPED, "<option timestep='0.001'> of mine.xml"),
        (BuildOutcome.DROPPED, "keyframe 'up' of mine.xml"),
        (BuildOutcome.DOUBTFUL, "actuator 'm' of mine.xml and 1 more"),
        (BuildOutcome.DROPPED, "sensor of mine.xml"),
    ]


def test_a_margin_with_a_gap_is_reported(tmp_path):
    world = tmp_path / "mine.xml"
    world.write_text(
        "<mujoco><default><geom margin='0.1'/></default><worldbody>"
        "<geom name='a' size='.1' gap='0.1'/><geom name='b' size='.1' gap='0.02'/>"
        "<geom name='c' size='.1'/><body name='d'><geom name='d' size='.1' margin='0' gap='1'/>"
        "</body></worldbody><contact><pair geom1='a' geom2='d' margin='0.3' gap='0.1'/></contact>"
        "</mujoco>"
    )
    report = BuildReport()
    load_world(world, report)
    geoms, pair = report.findings
    assert geoms.element == "geom 'a' of mine.xml and 1 more"
    assert "pushes at 0.1 m" in geoms.message
    assert "write margin='0'" in geoms.message
    assert pair.element == "pair of mine.xml"
    assert "write margin='0.2'" in pair.message


def test_a_shipped_world_has_nothing_in_vain():
    for name in shipped_worlds():
        report = BuildReport()
        load_world(name, report)
        assert report.findings == ()


def test_missing_world_is_named_with_those_that_exist(tmp_path):
    with pytest.raises(WorldError, match=r"no world 'moon': .*/moon, and .* empty, house, objects"):
        find_world("moon")


def test_what_is_not_a_regular_file_is_not_a_world(tmp_path):
    os.mkfifo(tmp_path / "w.sdf")
    for path, kind in ((tmp_path / "w.sdf", "FIFO"), (tmp_path, "folder")):
        with pytest.raises(WorldError, match=f"cannot read the world {path}: it is a {kind}"):
            find_world(path)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("no xml", "broken.xml, line 1: not XML"),
        (
            "<mujoco><worldbody><geom typ='box'/></worldbody></mujoco>",
            "unrecognized attribute: 'typ'",
        ),
        ('<mujoco><include file="gone.xml"/></mujoco>', "gone.xml"),
    ],
)
def test_broken_world_is_named_with_the_reason(tmp_path, text, reason):
    world = tmp_path / "broken.xml"
    world.write_text(text)
    with pytest.raises(WorldError, match=f"broken.xml is not usable MuJoCo XML: .*{reason}"):
        load_world(world)


def test_world_that_does_not_compile_is_not_blamed_on_the_robot(parts, tmp_path):
    world = tmp_path / "broken.xml"
    world.write_text('<mujoco><worldbody><geom type="mesh" mesh="gone"/></worldbody></mujoco>')
    with pytest.raises(WorldError, match=r"broken\.xml is not usable MuJoCo XML: .*gone"):
        parts.build(parts.pendulum(), world)


def test_robot_cannot_take_the_name_of_a_thing_in_the_world(parts, tmp_path):
    world = tmp_path / "world.xml"
    world.write_text('<mujoco><worldbody><body name="bob"/></worldbody></mujoco>')
    with pytest.raises(ModelError, match=r"already has a body 'bob'"):
        parts.build(parts.pendulum(), world)


def test_names_that_only_mujoco_finds_taken_are_refused(parts, tmp_path):
    world = tmp_path / "mine.xml"
    world.write_text(
        '<mujoco><worldbody><body><joint name="k"/><geom size="0.1"/></body></worldbody>'
        '<actuator><motor name="j" joint="k"/></actuator></mujoco>'
    )
    with pytest.raises(ModelError, match=r"robot 'bench' cannot be built: .*'j' in actuator"):
        parts.build(parts.pendulum(), world)


def test_defaults_of_a_world_are_for_the_world(parts, tmp_path):
    world = tmp_path / "world.xml"
    world.write_text(
        '<mujoco><compiler angle="degree"/><default><joint armature="3" damping="4"/>'
        '<geom contype="4" friction="9 9 9"/></default></mujoco>'
    )
    model = parts.build(parts.pendulum(), world).model
    assert model.dof_armature[0] == 0
    assert model.dof_damping[0] == 0
    assert model.jnt_range[0] == pytest.approx([-3, 3])


def in_picture(model, data, sensor):
    """Return the names of the bodies whose origins are in a camera's picture."""
    camera = model.camera(sensor.name).id
    right, up, back = data.cam_xmat[camera].reshape(3, 3).T
    high = np.tan(np.radians(model.cam_fovy[camera]) / 2)
    wide = high * sensor.width / sensor.height
    seen = set()
    for body in range(1, model.nbody):
        way = data.xpos[body] - data.cam_xpos[camera]
        depth = -way @ back
        if depth > 0 and abs(way @ up) < depth * high and abs(way @ right) < depth * wide:
            seen.add(model.body(body).name)
    return seen


@pytest.mark.parametrize(
    ("camera", "expected"),
    [("front", FRONT_CAMERA_SEES), ("side", {"blue_box", "teal_box", "pink_cylinder"})],
)
def test_cameras_of_the_arm_see_the_objects(parts, camera, expected):
    urdf = parts.arm(camera=camera)
    [sensor] = parse_cameras(urdf)
    built = parts.build(urdf, "objects", cameras=[sensor])
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    assert expected <= in_picture(built.model, data, sensor)


def test_objects_lie_still(bench, parts):
    arm = bench(parts.arm(), world="objects")
    start = arm.simulation.data.qpos.copy()
    arm.run(2.0)
    assert arm.simulation.data.qpos == pytest.approx(start, abs=2e-3)
