import mujoco
import numpy as np
import pytest

from arm_description.urdf.robot import Pose
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing

FLOOR = '<geom type="plane" size="0 0 1"/>'
FAR_AWAY = '<geom type="box" size="0.1 0.1 0.1" pos="50 0 0.1"/>'


@pytest.fixture
def world(tmp_path):
    def make(*things):
        file = tmp_path / "world.xml"
        file.write_text(f"<mujoco><worldbody>{''.join(things)}</worldbody></mujoco>")
        return file

    return make


def detects_contacts(bench):
    bench.tick()
    return not bench.simulation.model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_CONTACT)


def test_arm_in_the_air_over_a_bare_floor_needs_no_contacts(bench, parts, world):
    assert not detects_contacts(bench(parts.arm(), world=world(FLOOR)))


@pytest.mark.parametrize(
    "thing",
    [
        FAR_AWAY,
        '<body pos="9 9 9"><freejoint/><geom size="0.1"/></body>',
        '<geom type="plane" size="0 0 1" euler="0 10 0"/>',
        '<body mocap="true" pos="9 9 9"><geom size="0.1"/></body>',
    ],
)
def test_anything_else_to_touch_keeps_them_on(bench, parts, world, thing):
    assert detects_contacts(bench(parts.arm(), world=world(FLOOR, thing)))


def test_self_collision_keeps_them_on(bench, parts, world):
    assert detects_contacts(bench(parts.arm(), world=world(FLOOR), self_collide=True))


def test_robot_that_stands_on_the_floor_keeps_them_on(bench, parts, world):
    assert detects_contacts(bench(parts.arm(base="free"), world=world(FLOOR), base="free"))


@pytest.mark.parametrize("rate_hz", [30, 100, 500])
@pytest.mark.parametrize("height", [1.0, 3.0, 10.0])
def test_falling_robot_hits_the_floor_as_if_they_were_always_on(
    bench, parts, world, height, rate_hz
):
    ball = parts.link("ball", 1.0).replace(
        "</link>", '<collision><geometry><sphere radius="0.02"/></geometry></collision></link>'
    )
    urdf = parts.robot(ball, parts.ros2_control([]))
    runs = []
    for things in ((FLOOR,), (FLOOR, FAR_AWAY)):
        spawn = Pose((0.0, 0.0, height))
        falling = bench(urdf, rate_hz, world(*things), base="free", spawn=spawn)
        heights = []
        for _ in range(round(1.7 * rate_hz)):
            falling.tick()
            heights.append(falling.simulation.data.qpos[2])
        runs.append(heights)
    assert runs[0][0] > height - 0.1
    assert np.array_equal(*runs)


@pytest.mark.parametrize("shape", ["plane", "ball"])
def test_a_margin_pushes_as_if_they_were_always_on(bench, parts, world, shape):
    """Forces begin where the margins meet, far above the floor here."""
    ball = parts.link("ball", 1.0).replace(
        "</link>", '<collision><geometry><sphere radius="0.02"/></geometry></collision></link>'
    )
    urdf, runs = parts.robot(ball, parts.ros2_control([])), []
    for things in ((FLOOR,), (FLOOR, FAR_AWAY)):
        file = world(*things)
        if shape == "plane":
            file.write_text(file.read_text().replace("<geom ", '<geom margin="0.3" ', 1))
        built = parts.build(urdf, file, base="free", spawn=Pose((0.0, 0.0, 1.0)))
        if shape == "ball":
            built.model.geom_margin[built.model.geom_bodyid > 0] = 0.3
            mujoco.mj_setConst(built.model, mujoco.MjData(built.model))
        simulation = Physics(built, physics_timing(100.0))
        heights = []
        for _ in range(150):
            simulation.advance()
            heights.append(simulation.data.qpos[2])
        runs.append(heights)
    assert min(runs[1][50:]) > 0.25
    assert np.array_equal(*runs)


@pytest.mark.parametrize("rate_hz", [30, 100, 500])
def test_falling_arm_hits_the_floor_as_if_they_were_always_on(bench, parts, world, rate_hz):
    runs = []
    for things in ((FLOOR,), (FLOOR, FAR_AWAY)):
        arm = bench(parts.arm(j1_pos="0.5"), rate_hz, world(*things), hold_joints=False)
        runs.append(arm.run(2.0))
    assert np.array_equal(*runs)
