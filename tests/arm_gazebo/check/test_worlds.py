"""`arm check` of worlds and SDF models."""

import pytest

from arm_gazebo.check.world import check_world_file, is_world

WORLD = (
    '<sdf version="1.9"><world name="lab"><light name="lamp" type="point"/><actor name="walker"/>'
    '<model name="crate"><link name="l"><collision name="c"><geometry><box><size>1 1 1</size></box>'
    "</geometry></collision></link></model></world></sdf>"
)


@pytest.fixture
def file(tmp_path):
    def write(text, name="lab.world"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_a_world_is_summed_up_with_what_is_left_out(file):
    check = check_world_file(file(WORLD))
    assert check.is_usable
    assert str(check.summary) == (
        "world 'lab': 1 thing, 1 of them free to move, 1 shape, 1 light; "
        "1 thing is left out: actor 'walker' in lab.world"
    )
    assert [finding.outcome.value for finding in check.findings] == ["left out"]


def test_a_single_model_is_looked_at_as_a_thing_to_spawn(file):
    model = WORLD[WORLD.index("<model") : WORLD.index("</world>")]
    check = check_world_file(file(f"<sdf version='1.9'>{model}</sdf>", "model.sdf"))
    assert check.summary.things == ("crate",)


def test_a_world_in_mjcf_is_looked_at_too(file):
    check = check_world_file(file("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"))
    assert not check.is_usable  # The suffix says that it is SDF.
    text = "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"
    assert check_world_file(file(text, "lab.xml")).summary.shapes == 1


@pytest.mark.parametrize("text", ["no xml", "<sdf/>", WORLD.replace("1 1 1", "1 1")])
def test_a_mistake_is_a_finding(file, text):
    check = check_world_file(file(text))
    [finding] = check.findings
    assert (check.summary, check.is_usable, finding.outcome.value) == (None, False, "error")


@pytest.mark.parametrize(
    ("name", "text", "world"),
    [
        ("a.sdf", "", True),
        ("a.world", "", True),
        ("a.xml", "<mujoco/>", True),
        ("a.xml", "<robot name='r'/>", False),
        ("a.urdf", "<mujoco/>", False),
    ],
)
def test_worlds_and_robots_are_distinguished(file, name, text, world):
    assert is_world(file(text, name)) is world


def test_a_body_on_a_hinge_is_not_free_to_move(tmp_path):
    world = tmp_path / "w.xml"
    geom = '<geom size="0.1"/>'
    hinge = f'<body><joint axis="0 0 1"/>{geom}</body>'
    free = f'<body pos="1 0 0"><freejoint/>{geom}</body>'
    fixed = f'<body pos="2 0 0">{geom}</body>'
    world.write_text(f"<mujoco><worldbody>{hinge}{free}{fixed}</worldbody></mujoco>")
    said = str(check_world_file(world).summary)
    assert said.startswith("world 'w': 3 things, 1 of them free to move, 1 with joints, 3 shapes")
