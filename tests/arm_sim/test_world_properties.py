"""Gravity, mass and friction are changed while the simulation runs."""

import numpy as np
import pytest

from arm_gazebo.errors import RequestError
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_gazebo.state.run_reset import ResetScope, RunReset
from arm_sim import Simulation

MOON = (0.0, 0.0, -1.62)
WEIGHTLESS = (0.0, 0.0, 0.0)
BOX = """<sdf version='1.9'><model name='box'><link name='body'>
<inertial><mass>0.5</mass><inertia><ixx>8e-4</ixx><iyy>8e-4</iyy><izz>8e-4</izz></inertia></inertial>
<collision name='shape'><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>
</link></model></sdf>"""
WALL = BOX.replace("<link", "<static>true</static><link").replace("'box'", "'wall'")


def fall_m(sim: Simulation, y_m: float) -> float:
    """Return how far a new box falls in 0.2 s."""
    name = sim.spawn(BOX, pose=(0.7, y_m, 1.0))
    sim.run(0.2)
    return 1.0 - float(sim.pose(name)[2, 3])


def slide_m(sim: Simulation) -> float:
    """Return how far a box on the floor slides in gravity that is tilted by 0.3 rad."""
    sim.set_gravity((9.81 * np.sin(0.3), 0.0, -9.81 * np.cos(0.3)))
    before = sim.pose("box")[0, 3]
    sim.run(0.5)
    return float(sim.pose("box")[0, 3] - before)


def test_things_fall_under_the_gravity_that_is_set(sim):
    assert sim.gravity == pytest.approx([0, 0, -9.81])
    assert fall_m(sim, 0.3) == pytest.approx(9.81 * 0.2**2 / 2, rel=0.03)
    sim.set_gravity(MOON)
    assert tuple(sim.gravity) == MOON
    assert fall_m(sim, 0.6) == pytest.approx(1.62 * 0.2**2 / 2, rel=0.03)
    sim.set_gravity(WEIGHTLESS)
    assert fall_m(sim, 0.9) == 0.0


def test_joints_that_are_too_weak_for_the_gravity_are_logged_once(sim, caplog):
    sim.set_gravity((0.0, 0.0, -100.0))
    weak = [r.message for r in caplog.records if "effort limit" in r.message]
    assert [message.split(":")[0] for message in weak] == ["joint 'j1'", "joint 'j2'"]
    assert all("that gravity needs in some poses; it will sink there" in w for w in weak)
    caplog.clear()
    sim.set_gravity((0.0, 0.0, -100.0))
    sim.set_gravity(MOON)
    assert not [r for r in caplog.records if "effort limit" in r.message]


def test_a_resting_thing_wakes_when_gravity_turns(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    sim.run(5.0)
    sim.set_gravity((0.0, 0.0, 9.81))
    sim.run(0.5)
    assert sim.pose("box")[2, 3] > 1.0


def test_a_thing_slides_below_its_friction(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    sim.run(0.5)
    assert sim.properties("box").friction == 1.0
    assert abs(slide_m(sim)) < 1e-3
    sim.set_properties("box", friction=0.1)
    assert sim.properties("box").friction == 0.1
    # Down a slope of 0.3 rad with a coefficient of 0.1.
    way_m = 9.81 * (np.sin(0.3) - 0.1 * np.cos(0.3)) * 0.5**2 / 2
    assert slide_m(sim) == pytest.approx(way_m, rel=0.05)


def test_a_heavier_thing_weighs_more(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    assert sim.properties("box").mass_kg == 0.5
    sim.set_properties("box", mass_kg=0.3)
    assert sim.properties("box").mass_kg == 0.3
    sim.run(0.5)
    force = sum(contact.force for contact in sim.contacts("box"))
    assert force[2] == pytest.approx(0.3 * 9.81, rel=0.02)


def test_robots_things_that_do_not_move_and_unknown_ones_are_refused(sim):
    sim.spawn(WALL, pose=(0.7, 0.3, 0.05))
    assert sim.properties("wall").mass_kg is None
    with pytest.raises(RequestError, match="'wall' is fixed to the world: its mass has no effect"):
        sim.set_properties("wall", mass_kg=1.0)
    with pytest.raises(RequestError, match="'arm' is a robot: its masses and friction are those"):
        sim.set_properties("arm", friction=0.1)
    with pytest.raises(RequestError, match="no entity 'bix'; there are arm, wall"):
        sim.set_properties("bix", mass_kg=1.0)
    sim.set_properties("wall", friction=0.2)
    assert sim.properties("wall").friction == 0.2


@pytest.mark.parametrize("mass", [0.0, -1.0, float("nan"), float("inf"), 1e9, "heavy"])
def test_a_bad_mass_is_refused_and_the_old_one_stays(sim, mass):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    with pytest.raises(RequestError, match=r"the mass of 'box' is 1e-06 to 1e\+06 kg, not "):
        sim.set_properties("box", mass_kg=mass, friction=0.3)
    properties = sim.properties("box")
    assert (properties.mass_kg, properties.friction) == (0.5, 1.0)


@pytest.mark.parametrize("friction", [-0.1, float("nan"), float("inf"), 1000.0])
def test_a_bad_friction_is_refused(sim, friction):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    with pytest.raises(RequestError, match="the friction of 'box' is 0 to 100, not "):
        sim.set_properties("box", friction=friction)


@pytest.mark.parametrize("gravity", [(0, 0), (0, 0, float("nan")), (0, 0, -200.0), 9.81, "down"])
def test_a_bad_gravity_is_refused(sim, gravity):
    with pytest.raises(RequestError, match="the gravity is three numbers x y z from -100 to 100"):
        sim.set_gravity(gravity)
    assert sim.gravity == pytest.approx([0, 0, -9.81])


def test_what_is_set_outlives_a_change_of_the_world(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    sim.set_gravity(MOON)
    sim.set_properties("box", mass_kg=0.2, friction=0.4)
    sim.spawn(BOX, name="other", pose=(0.7, -0.3, 0.05))
    properties = sim.properties("box")
    assert tuple(sim.gravity) == MOON
    assert (properties.mass_kg, properties.friction) == (0.2, 0.4)
    assert sim.properties("other").mass_kg == 0.5
    sim.run(1.0)
    force = sum(contact.force for contact in sim.contacts("box"))
    assert force[2] == pytest.approx(0.2 * 1.62, rel=0.03)


def test_a_thing_that_is_deleted_takes_its_properties_along(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    sim.set_properties("box", mass_kg=0.2)
    sim.delete("box")
    sim.spawn(BOX, pose=(0.7, 0.3, 0.05))
    assert sim.properties("box").mass_kg == 0.5


def test_a_state_has_the_properties_of_its_time(sim):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.5))
    own = sim.save()
    sim.run(0.2)
    expected = sim.parts.state.digest()
    sim.restore(own)
    sim.set_gravity(MOON)
    sim.set_properties("box", mass_kg=0.2, friction=0.4)
    light = sim.save()
    sim.run(0.2)
    expected_light = sim.parts.state.digest()
    sim.restore(own)
    assert sim.gravity == pytest.approx([0, 0, -9.81])
    assert sim.properties("box").mass_kg == 0.5
    sim.run(0.2)
    assert sim.parts.state.digest() == expected
    sim.restore(light)
    assert (sim.properties("box").mass_kg, sim.properties("box").friction) == (0.2, 0.4)
    sim.run(0.2)
    assert sim.parts.state.digest() == expected_light


def test_a_snapshot_in_a_file_has_them(sim, tmp_path):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.5))
    sim.set_gravity(MOON)
    sim.set_properties("box", mass_kg=0.2)
    sim.save(tmp_path / "moon.snapshot")
    sim.run(0.2)
    height = sim.pose("box")[2, 3]
    with Simulation("arm", arguments={"camera": "none"}) as other:
        other.restore(tmp_path / "moon.snapshot")
        assert tuple(other.gravity) == MOON
        assert other.properties("box").mass_kg == 0.2
        other.run(0.2)
        assert other.pose("box")[2, 3] == height


def test_reset_puts_the_own_properties_back(sim):
    sim.set_gravity(MOON)
    sim.reset()
    assert sim.gravity == pytest.approx([0, 0, -9.81])


@pytest.mark.parametrize(
    ("scope", "kept"),
    [
        (ResetScope(), False),
        (ResetScope(time=False), False),
        (ResetScope(spawned=False), True),
        (ResetScope(state=False, spawned=False), True),
    ],
)
def test_a_reset_of_what_was_spawned_puts_the_own_properties_back(scope, kept):
    with Simulation("arm", world="objects", arguments={"camera": "none"}) as sim:
        own_kg = sim.properties("red_box").mass_kg
        reset = RunReset(sim.parts.state, sim.parts.editor, lambda: True, lambda: None)
        sim.set_gravity(MOON)
        sim.set_properties("red_box", mass_kg=0.01)
        reset.reset(scope)
        assert (tuple(sim.gravity) == MOON) is kept
        assert (sim.properties("red_box").mass_kg == 0.01) is kept
        assert (sim.properties("red_box").mass_kg == own_kg) is not kept


def test_a_recorded_run_repeats_with_them_to_the_bit(tmp_path):
    arm = {"arguments": {"camera": "none"}}
    with Simulation("arm", world="objects", record=tmp_path / "a.run", **arm) as sim:
        reset = RunReset(sim.parts.state, sim.parts.editor, lambda: True, lambda: None)
        sim["position_controller"].command([0.4, 0.3, 0.2, 0.1])
        sim.run(0.2)
        sim.set_gravity((1.0, 0.5, -30.0))
        sim.run(0.2)
        sim.spawn(BOX, pose=(0.7, 0.3, 0.2))
        sim.set_properties("box", mass_kg=0.02, friction=0.05)
        sim.set_properties("red_box", mass_kg=3.0)
        sim["position_controller"].command([-0.4, 1.0, 0.2, 0.1])
        sim.run(0.3)
        sim.spawn(BOX, pose=(0.7, -0.3, 0.2))
        sim.run(0.3)
        with pytest.raises(RequestError):
            sim.set_properties("box", mass_kg=-1.0)
        reset.reset(ResetScope())
        sim.set_gravity(MOON)
        sim.run(0.2)
    result = Replay(RunFile(tmp_path / "a.run")).run()
    assert result.difference is None
    assert result.periods >= 100


def test_a_recording_begins_with_them(sim, tmp_path):
    sim.spawn(BOX, pose=(0.7, 0.3, 0.3))
    sim.set_gravity(MOON)
    sim.set_properties("box", mass_kg=0.02, friction=0.05)
    sim.run(0.1)
    with sim.record(tmp_path / "a.run"):
        sim["position_controller"].command([0.4, 0.3, 0.2, 0.1])
        sim.run(1.0)
    result = Replay(RunFile(tmp_path / "a.run")).run()
    assert result.difference is None
    assert result.periods >= 100
