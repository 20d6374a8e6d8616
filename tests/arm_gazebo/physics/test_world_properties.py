"""Changed properties leave the model as if the world had been built with them."""

import numpy as np
import pytest

from arm_gazebo.physics.world_properties import UNCHANGED, PropertyChanges

WORLD = """<mujoco><option gravity="0 0 {gravity}"/><worldbody>
  <geom type="plane" size="5 5 0.1"/>
  <body name="thing" pos="1 0 0.1"><freejoint/>
    <geom type="box" size="0.1 0.1 0.1" mass="{mass}" friction="{friction}"/>
    <body name="lid" pos="0 0 0.2"><joint name="hinge" axis="0 1 0" damping="1"/>
      <geom type="box" size="0.1 0.1 0.01" mass="{lid}" friction="{friction}"/></body>
  </body>
</worldbody></mujoco>"""
DERIVED = ("body_subtreemass", "body_invweight0", "dof_invweight0", "dof_M0", "actuator_acc0")


@pytest.fixture
def running(bench, parts, tmp_path):
    """Return a maker of simulations of a pendulum beside a thing with a lid."""

    def make(gravity: float = -9.81, mass: float = 1.0, lid: float = 0.5, friction: float = 1.0):
        file = tmp_path / f"{gravity} {mass} {friction}.xml"
        file.write_text(WORLD.format(gravity=gravity, mass=mass, lid=lid, friction=friction))
        made = bench(parts.serial_arm(3, 20.0, 0.7), 100, file)
        made.claim()
        return made

    return make


def test_a_heavier_thing_has_all_that_follows_from_its_mass(running):
    made, wanted = running().simulation, running(mass=3.0, lid=1.5).simulation
    made.set_properties(PropertyChanges(masses={"thing": 4.5}))
    for name in ("body_mass", "body_inertia", *DERIVED):
        np.testing.assert_allclose(
            getattr(made.model, name), getattr(wanted.model, name), rtol=1e-9, err_msg=name
        )
    assert made.model.dof_armature.tolist() == wanted.model.dof_armature.tolist()


def test_the_own_mass_is_put_back_to_the_bit(running):
    made = running().simulation
    own = {name: getattr(made.model, name).copy() for name in ("body_mass", "body_inertia")}
    made.set_properties(PropertyChanges(masses={"thing": 0.37}, frictions={"thing": 0.1}))
    made.set_properties(UNCHANGED)
    for name, values in own.items():
        assert getattr(made.model, name).tolist() == values.tolist()
    shapes = made.model.geom_bodyid == made.model.body("lid").id
    assert made.model.geom_friction[shapes].tolist() == [[1.0, 0.005, 0.0001]]
    assert made.model.geom_priority[shapes].tolist() == [0]


def test_a_lower_friction_counts_against_any_other_shape(running):
    made = running().simulation
    made.set_properties(PropertyChanges(frictions={"thing": 0.25}))
    made.advance()
    made.advance()
    data = made.observe()
    assert data.ncon > 0
    assert {float(contact.friction[0]) for contact in data.contact} == {0.25}


@pytest.mark.parametrize("gravity", [-30.0, -1.62, 0.0, 9.81])
def test_a_run_is_the_one_of_a_world_with_this_gravity(running, gravity):
    one, other = running(), running(gravity=gravity)
    one.simulation.set_properties(PropertyChanges((0.0, 0.0, gravity)))
    one.simulation.reset()
    other.simulation.reset()
    for each in (one, other):
        each.command(0.9, -0.7, 0.8)
        each.run(1.0)
    assert one.simulation.data.qpos.tolist() == other.simulation.data.qpos.tolist()


def test_drives_are_tuned_again_as_they_were_at_first(running):
    made = running().simulation
    before = made.servo.tuning
    made.set_properties(PropertyChanges((0.0, 0.0, -30.0)))
    heavier = made.servo.tuning
    assert (heavier.gravity[1:] > 2.9 * before.gravity[1:]).all()
    assert (heavier.braking[1:] < before.braking[1:]).all()
    made.set_properties(UNCHANGED)
    assert made.servo.tuning.braking.tolist() == before.braking.tolist()
    assert made.servo.tuning.gravity.tolist() == before.gravity.tolist()
