import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.robot.part import BuildOptions, RobotInWorld
from arm_gazebo.world.loading import WorldLoader, available_worlds

SDF = "<sdf version='1.9'><world name='w'><gravity>0 0 -9.8</gravity>{more}</world></sdf>"


@pytest.fixture
def loader(parts):
    urdf = parts.pendulum()
    options = BuildOptions(step_s=0.002)
    return WorldLoader([RobotInWorld(parse_urdf(urdf), parse_hardware_info(urdf), options=options)])


def refusal(action) -> Refusal:
    with pytest.raises(RequestError) as caught:
        action()
    assert str(caught.value)
    return caught.value.refusal


def test_the_robot_continues_in_another_world(kept, parts, loader):
    world = kept(robot=parts.pendulum())
    world.arm.claim()
    world.arm.command(0.7)
    still = world.arm.run(2.0)[-1]
    base, named = loader.load("shapes", "", all_elements=False)
    world.editor.replace_world(base)
    assert named.name == "shapes"
    assert {"bench", "cone"} <= set(world.names())
    assert "mustard" not in world.names()
    assert np.abs(world.arm.run(0.5) - still).max() < 1e-3


def test_objects_of_the_same_name_start_at_the_new_worlds_poses(kept, parts, things, loader):
    world = kept(robot=parts.pendulum())
    start = world.where("coke_can")
    world.editor.place("coke_can", things.at(1, 1, 1), "", None)
    base, _ = loader.load("pick_and_place_demo", "", all_elements=False)
    world.editor.replace_world(base)
    assert world.where("coke_can") == pytest.approx(start)


def test_nothing_is_left_but_the_robot(kept, parts, loader):
    world = kept(robot=parts.pendulum())
    world.editor.replace_world(loader.load_empty())
    assert world.names() == ["bench"]


@pytest.mark.parametrize("text", [SDF.format(more=""), "<mujoco model='w'/>"])
def test_a_world_may_be_a_text(loader, text):
    base, named = loader.load("", text, all_elements=False)
    assert base.model.nbody == 3
    assert named.uri == ""


def test_a_text_of_mujoco_reads_no_files(loader, tmp_path):
    (tmp_path / "secret.png").write_bytes(b"")
    text = f"<mujoco><asset><texture type='2d' file='{tmp_path}/secret.png'/></asset></mujoco>"
    with pytest.raises(RequestError, match=r"secret\.png' is not read: a text has no folder"):
        loader.load("", text, all_elements=False)


def test_unsupported_elements_are_refused_on_demand(loader):
    text = SDF.format(more="<wind><linear_velocity>1 0 0</linear_velocity></wind>")
    loader.load("", text, all_elements=False)
    kind = refusal(lambda: loader.load("", text, all_elements=True))
    assert kind is Refusal.UNSUPPORTED_ELEMENTS


@pytest.mark.parametrize(
    ("uri", "text", "expected"),
    [
        ("", "", Refusal.NO_RESOURCE),
        ("nowhere", "", Refusal.NO_RESOURCE),
        ("package://nowhere/w.sdf", "", Refusal.NO_RESOURCE),
        ("/etc/hostname", "", Refusal.UNSUPPORTED_FORMAT),
        ("", "<a/>", Refusal.UNSUPPORTED_FORMAT),
        ("", "<mujoco", Refusal.UNREADABLE),
        ("", "<mujoco><nonsense/></mujoco>", Refusal.UNREADABLE),
        ("", "<sdf/>", Refusal.UNREADABLE),
    ],
)
def test_an_invalid_world_is_refused(loader, uri, text, expected):
    assert refusal(lambda: loader.load(uri, text, all_elements=False)) is expected


@pytest.mark.parametrize("as_text", [True, False])
def test_a_world_that_mujoco_cannot_simulate_is_refused(loader, tmp_path, as_text):
    heavy = "<body><freejoint/><geom size='.1' mass='1e308'/></body>"
    text = f"<mujoco><worldbody>{heavy}{heavy}</worldbody></mujoco>"
    file = tmp_path / "heavy.xml"
    file.write_text(text)
    with pytest.raises(RequestError, match="cannot be simulated") as caught:
        loader.load(*(("", text) if as_text else (str(file), "")), all_elements=False)
    assert caught.value.refusal is Refusal.UNREADABLE


def test_a_world_that_needs_too_much_memory_ends_only_the_trial_process(parts):
    urdf = parts.pendulum()
    options = BuildOptions(step_s=0.002, memory_limit=MemoryLimit(5.0, "p"))
    loader = WorldLoader(
        [RobotInWorld(parse_urdf(urdf), parse_hardware_info(urdf), options=options)]
    )
    boxes = "<replicate count='4000' offset='1 0 0'><geom type='box' size='.1 .1 .1'/></replicate>"
    text = f"<mujoco><worldbody>{boxes}</worldbody></mujoco>"
    with pytest.raises(RequestError, match=r"needs more than 5 MB \(parameter p\)"):
        loader.load("", text, all_elements=False)


def test_available_worlds_are_the_shipped_ones_and_those_of_folders(tmp_path):
    (tmp_path / "mine.sdf").write_text("")
    (tmp_path / "notes.txt").write_text("")
    names = [world.name for world in available_worlds([str(tmp_path)])]
    assert {"empty", "house", "mine"} <= set(names)
    assert "notes" not in names


def test_a_missing_folder_is_refused_or_skipped(tmp_path):
    missing = str(tmp_path / "missing")
    assert refusal(lambda: available_worlds([missing])) is Refusal.FAILED
    assert available_worlds([missing], go_on=True)
