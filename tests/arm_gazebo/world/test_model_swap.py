"""A running simulation continues in another model without any disturbance."""

import math
import resource

import mujoco
import numpy as np
import pytest

from arm_gazebo.world.changes import Spawned, WorldChanges, changed_model


@pytest.fixture
def moving(kept):
    """Return an arm under way, in a world of free things that were just disturbed."""
    world = kept()
    world.arm.claim()
    world.arm.command(0.5, 0.6, -0.4, 0.3)
    world.editor.place("coke_can", None, "", np.array([0.3, 0.1, 1.0, 0.0, 2.0, 1.0]))
    world.arm.run(0.15)
    return world


def test_every_state_is_carried_over(moving, things):
    simulation = moving.arm.simulation
    model, before = simulation.model, simulation.data
    moving.spawn("crate", things.crate, things.at(3, 3, 1))
    after = simulation.data
    assert after is not before
    assert np.abs(before.qvel).max() > 0.1
    for joint in range(model.njnt):
        name = model.joint(joint).name
        assert after.joint(name).qpos == pytest.approx(before.joint(name).qpos, abs=1e-12)
        assert after.joint(name).qvel == pytest.approx(before.joint(name).qvel, abs=1e-12)
    for actuator in range(model.nactuator):
        name = model.actuator(actuator).name
        assert after.actuator(name).ctrl == pytest.approx(before.actuator(name).ctrl, abs=1e-12)
        there, here = (m.actuator(name).actadr[0] for m in (model, simulation.model))
        assert after.act[here] == pytest.approx(before.act[there], abs=1e-12)
    assert after.time == before.time


def test_gains_and_rotors_are_carried_over(moving, things):
    simulation = moving.arm.simulation
    model = simulation.model
    moving.spawn("crate", things.crate, things.at(3, 3, 1))
    moving.editor.delete("mustard")
    for name in moving.arm.built.joints:
        before, after = model.actuator(name), simulation.model.actuator(name)
        assert after.gainprm.tolist() == before.gainprm.tolist()
        assert after.biasprm.tolist() == before.biasprm.tolist()
        there, here = (m.joint(name).dofadr[0] for m in (model, simulation.model))
        assert simulation.model.dof_armature[here] == model.dof_armature[there]


def test_a_free_wheel_keeps_its_rotor(kept, parts, things):
    """MuJoCo keeps the inertia of such a joint from when the model was made."""
    world = kept("empty", robot=parts.wheel(0.6, 'effort="50" velocity="3"'))
    world.arm.claim("velocity")
    simulation = world.arm.simulation
    before = simulation.model.dof_M0[0]
    world.spawn("post", things.post, things.at(3, 3, 1))
    assert simulation.model.dof_M0[0] == pytest.approx(before)
    world.arm.tick()
    assert simulation.data.M[0] == pytest.approx(before)


@pytest.mark.parametrize("rate_hz", [30, 100, 500])
def test_the_arm_continues_its_motion(kept, things, rate_hz):
    """The same motion with and without three swaps in the middle of it."""
    disturbed, undisturbed = kept("house", rate_hz), kept("house", rate_hz)
    ways = []
    for world, swaps in ((disturbed, True), (undisturbed, False)):
        world.arm.claim()
        way = []
        for tick in range(round(1.2 * rate_hz)):
            angle = 0.4 * math.sin(2 * math.pi * tick / rate_hz)
            world.arm.command(angle, 1.0 + angle, angle, angle)
            world.arm.tick()
            way.append(world.arm.state("position"))
            if swaps and tick == round(0.3 * rate_hz):
                world.spawn("crate", things.crate, things.at(3, 3, 0.05))
            if swaps and tick == round(0.6 * rate_hz):
                world.spawn("post", things.post, things.at(4, 4, 0.05))
            if swaps and tick == round(0.9 * rate_hz):
                world.editor.delete("crate")
        ways.append(way)
    assert np.abs(np.array(ways[0]) - ways[1]).max() < 2e-4
    assert disturbed.arm.simulation.time_s == undisturbed.arm.simulation.time_s


def test_a_joint_at_rest_stays_at_rest(kept, things):
    world = kept("empty")
    world.arm.claim()
    world.arm.command(0.4, 0.8, 0.5, -0.6)
    still = world.arm.run(2.0)[-1]
    world.spawn("crate", things.crate, things.at(3, 3, 1))
    assert np.abs(world.arm.run(1.0) - still).max() < 1e-5


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
def test_every_kind_of_command_counts_after_a_swap(kept, things, interface):
    world = kept("empty")
    world.arm.claim(interface)
    world.spawn("crate", things.crate, things.at(3, 3, 1))
    values = {"position": 0.5, "velocity": 0.5, "effort": 2.0}
    world.arm.command(values[interface], 0, 0, 0)
    assert world.arm.run(1.0)[-1][0] > 0.3


def test_a_deleted_support_lets_fall_what_slept_on_it(kept, things):
    world = kept()
    world.spawn("post", things.post, things.at(3, 3, 0.05))
    world.spawn("crate", things.crate, things.at(3, 3, 0.151))
    world.arm.run(2.0)
    assert world.where("crate")[2] == pytest.approx(0.15, abs=2e-3)
    world.editor.delete("post")
    world.arm.run(1.0)
    assert world.where("crate")[2] == pytest.approx(0.05, abs=2e-3)


def test_the_base_stays_as_it_is(kept, things):
    world = kept()
    base = world.arm.built
    bodies = [body.name for body in base.spec.bodies]
    world.spawn("crate", things.crate, things.at(3, 3, 1))
    world.editor.delete("red_cylinder")
    assert [body.name for body in base.spec.bodies] == bodies


def test_pictures_are_clipped_as_before(kept, things):
    world = kept()
    before = world.arm.built.model
    world.spawn("crate", things.crate, things.at(100, 0, 1))
    after = world.editor.model
    assert after.stat.extent == before.stat.extent
    assert (after.vis.map.znear, after.vis.map.zfar) == (before.vis.map.znear, before.vis.map.zfar)


@pytest.mark.parametrize("degree", [True, False])
def test_angles_of_a_spawned_thing_are_its_own(parts, degree):
    """The world's file may count in degrees, the thing's in radians, and the other way round."""
    base = parts.build(parts.pendulum())
    base.spec.compiler.degree = degree
    from arm_gazebo.world.spawn_model import ModelSource

    turned = "<robot name='r'><link name='world'/><link name='a'>{m}</link>{j}</robot>".format(
        m="<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
        "</inertial>",
        j="<joint name='q' type='revolute'><parent link='world'/><child link='a'/>"
        "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>",
    )
    thing = Spawned("thing", ModelSource(0.002).read("", turned), np.eye(4))
    model = changed_model(base, WorldChanges(spawned=(thing,))).model
    assert model.joint("thing::q").range == pytest.approx([-1.0, 1.0])


def test_a_world_that_changes_all_the_time_needs_no_more_memory(kept, parts, things):
    world = kept("empty", robot=parts.pendulum())
    for _ in range(10):
        world.spawn("crate", things.chest, things.at(3, 3, 1))
        world.editor.delete("crate")
    before_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(50):
        world.spawn("crate", things.chest, things.at(3, 3, 1))
        world.arm.tick()
        world.editor.delete("crate")
    grown_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before_kb
    assert world.editor.model.nbody == world.arm.built.model.nbody
    # One set of MuJoCo's arrays is 0.5 MB and more.
    assert grown_kb < 20_000


def test_sleep_is_left_to_what_lies_still(kept, things):
    world = kept()
    world.spawn("crate", things.crate, things.at(3, 3, 0.05))
    world.arm.run(3.0)
    data = world.arm.simulation.data
    assert mujoco.mj_name2id(world.editor.model, mujoco.mjtObj.mjOBJ_BODY, "crate::base") > 0
    assert (data.tree_asleep[1:] >= 0).sum() >= 4
