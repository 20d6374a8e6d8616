"""Everything that MuJoCo counts as state goes on in the next model."""

import mujoco
import numpy as np
import pytest

WORLD = """<mujoco><size nuserdata="3"/><worldbody>
  <body name="first"><freejoint/><geom size="0.1" mass="1"/><site name="first_site"/></body>
  <body name="held" pos="0 2 1"><freejoint/><geom size="0.1" mass="1"/></body>
  <body name="wire" pos="0 3 1"><joint name="wj" axis="0 1 0" stiffness="5" springyield="0.1"/>
    <geom size="0.1" mass="1"/></body>
  <body name="door" pos="3 0 1"><joint name="dj" axis="0 0 1" damping="0.5"/>
    <geom size="0.1" pos="0.3 0 0" mass="1"/><site name="knob" pos="0.3 0 0"/></body>
  <body name="hand" mocap="true" pos="0 5 1"><geom size="0.1"/></body>
</worldbody><tendon>
  <fixed springlength="0" stiffness="2" springyield="0.1"><joint joint="dj" coef="1"/></fixed>
</tendon><equality>
  <weld body1="first"/>
  <weld body1="held" anchor="0 2 1"/>
  <connect body1="wire" anchor="0 0 0"/>
</equality><actuator>
  <motor site="first_site" gear="1 0 0 0 0 0"/>
  <pid joint="wj" kp="1" kv="1" ki="1"/>
  <position joint="dj" kp="20" kv="4" delay="0.2" nsample="110"/>
</actuator><sensor>
  <framepos objtype="site" objname="first_site" delay="0.01" nsample="8"/>
  <framepos objtype="site" objname="knob" delay="0.05" nsample="30"/>
</sensor></mujoco>"""
ELEMENTS = [part for part in mujoco.mjtState.__members__.values() if int(part).bit_count() == 1]
LARGEST = 0.5


@pytest.fixture
def opened(kept, parts, tmp_path):
    """Return a maker of that world."""

    def make():
        file = tmp_path / "world.xml"
        file.write_text(WORLD)
        made = kept(file, robot=parts.pendulum())
        made.arm.claim()
        return made

    return make


@pytest.fixture
def world(opened):
    return opened()


def disturb(simulation, random: np.random.Generator) -> None:
    """Give every number of the state a value of its own."""
    model, data = simulation.model, simulation.data
    data.ctrl[:] = random.uniform(-LARGEST, LARGEST, model.nu)
    # What was measured and commanded before has places and times in it, and is made by steps.
    for _ in range(20):
        data.ctrl += 0.01
        mujoco.mj_step(model, data)
    history = data.history.copy()
    every = mujoco.mjtState.mjSTATE_INTEGRATION
    mujoco.mj_setState(
        model, data, random.uniform(0.1, LARGEST, mujoco.mj_stateSize(model, every)), every
    )
    data.history[:] = history
    data.eq_active[:] = [False, True, False]


def state(simulation, element) -> np.ndarray:
    values = np.zeros(mujoco.mj_stateSize(simulation.model, element))
    mujoco.mj_getState(simulation.model, simulation.data, values, element)
    return values


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_each_element_of_the_state_is_carried_over(world, things, element):
    simulation = world.arm.simulation
    disturb(simulation, np.random.default_rng(3))
    before = state(simulation, element)
    # No plugin of MuJoCo is ever loaded; every other element is in this world.
    assert len(before) or element == mujoco.mjtState.mjSTATE_PLUGIN
    world.spawn("post", things.post, things.at(7, 7, 0))
    after = state(simulation, element)
    # The post has no state, but forces could be applied to it.
    posts = 6 if element == mujoco.mjtState.mjSTATE_XFRC_APPLIED else 0
    assert len(after) == len(before) + posts
    assert after[: len(before)] == pytest.approx(before, abs=1e-12)


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_what_remains_after_a_deletion_goes_on(world, element):
    """All numbers have other places then."""
    simulation = world.arm.simulation
    disturb(simulation, np.random.default_rng(4))
    before = state(simulation, element)
    model = simulation.model
    world.editor.delete("first")
    after = state(simulation, element)
    if element == mujoco.mjtState.mjSTATE_EQ_ACTIVE:
        assert after.tolist() == [1.0, 0.0]
    elif element == mujoco.mjtState.mjSTATE_HISTORY:
        gone = int(model.sensor_historyadr[0]), int(model.sensor_historyadr[1])
        assert after.tolist() == np.delete(before, slice(*gone)).tolist()
    else:
        places = [before.tolist().index(value) for value in after]
        assert places == sorted(set(places))
        gone = {"QPOS": 7, "QVEL": 6, "WARMSTART": 6, "CTRL": 1, "QFRC_APPLIED": 6}
        gone["XFRC_APPLIED"] = 6
        assert len(before) - len(after) == gone.get(element.name.removeprefix("mjSTATE_"), 0)


def test_a_delayed_actuator_goes_on(opened, things):
    """With a delay of 0.2 s it would stand still that long if its past were lost."""
    swapped, undisturbed = opened(), opened()
    for world in (swapped, undisturbed):
        world.arm.simulation.data.actuator("dj::actuator").ctrl[:] = 0.5
        world.arm.run(0.25)
        if world is swapped:
            world.spawn("post", things.post, things.at(7, 7, 0))
        world.arm.run(0.15)
    data, expected = (world.arm.simulation.data for world in (swapped, undisturbed))
    assert expected.joint("dj").qpos[0] > 0.2
    assert data.joint("dj").qpos == pytest.approx(expected.joint("dj").qpos, abs=1e-9)
    measured = expected.sensor("knob::sensor").data
    assert data.sensor("knob::sensor").data == pytest.approx(measured, abs=1e-9)


def test_a_released_weld_stays_released(world, things):
    simulation = world.arm.simulation
    world.arm.run(0.5)
    assert world.where("held")[2] == pytest.approx(1.0, abs=0.02)
    simulation.data.eq_active[1] = False
    world.spawn("post", things.post, things.at(7, 7, 0))
    world.arm.run(0.3)
    assert world.where("held")[2] < 0.8


def test_another_world_starts_as_it_is_described(world, parts, tmp_path):
    """Its things may have the names of those before; only the robots go on."""
    simulation = world.arm.simulation
    disturb(simulation, np.random.default_rng(5))
    joint = simulation.data.joint("j").qpos.copy()
    built = parts.build(parts.pendulum(), tmp_path / "world.xml", step_s=simulation.timing.step_s)
    fresh = mujoco.MjData(built.model)
    world.editor.replace_world(built)
    data = simulation.data
    assert data.eq_active.tolist() == [True] * 3
    assert data.joint("j").qpos == pytest.approx(joint)
    assert not data.xfrc_applied[:5].any()
    for name in ("history", "plastic", "userdata", "mocap_pos"):
        assert getattr(data, name).tolist() == getattr(fresh, name).tolist(), name
    assert not data.ctrl[:-1].any()
