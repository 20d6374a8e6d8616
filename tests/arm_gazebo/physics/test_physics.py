import hashlib
import math

import numpy as np
import pytest

from arm_gazebo.errors import TimingError
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing


@pytest.mark.parametrize("rate_hz", [30, 100, 225, 500, 1000])
def test_every_advance_is_one_control_period(bench, parts, rate_hz):
    arm = bench(parts.pendulum(), rate_hz)
    for _ in range(rate_hz):
        arm.simulation.advance()
    assert arm.simulation.time_s == pytest.approx(1.0, abs=1e-9)


def test_the_time_is_a_number_of_periods_however_long_it_goes(bench, parts):
    arm = bench(parts.pendulum(), 100)
    arm.simulation.reset(time_s=1000.0)
    for _ in range(1000):
        arm.simulation.advance()
    assert arm.simulation.time_s == 1010.0


def test_model_of_another_step_is_refused(parts):
    built = parts.build(parts.pendulum(), step_s=0.001)
    with pytest.raises(TimingError, match=r"built with a physics step of 0\.001 s, .* 0\.002 s"):
        Physics(built, physics_timing(100))


def test_same_commands_give_the_same_run(bench, parts):
    def run():
        arm = bench(parts.arm(), world="objects")
        arm.claim()
        digest = hashlib.sha256()
        for tick in range(200):
            arm.command(0.4 * math.sin(tick / 30), 1.9 * tick / 200, 0.3, math.cos(tick / 10))
            arm.tick()
            digest.update(arm.simulation.data.qpos.tobytes())
        return digest.hexdigest()

    assert run() == run()


def test_poses_alone_are_those_of_the_whole_state(bench, parts):
    arm = bench(parts.arm(), world="objects")
    arm.claim()
    arm.command(0.4, 1.0, 0.3, 0.2)
    arm.run(0.2)
    alone = arm.simulation.poses().xpos.copy()
    whole = arm.simulation.observe()
    assert np.array_equal(alone, whole.xpos)
    assert whole.time == arm.simulation.time_s
    assert whole.ncon, "what lies there touches the floor"


def test_reset_puts_everything_back(bench, parts):
    arm = bench(parts.arm(j1_pos="0.5"))
    arm.claim()
    arm.command(1.0, 1.0, 1.0, 1.0)
    arm.run(0.5)
    arm.simulation.reset(time_s=7.0)
    arm.hardware.read(0, 0)
    assert arm.simulation.time_s == 7.0
    assert arm.state("position") == pytest.approx([0, 0.5, 0, 0])
    assert np.abs(arm.run(0.5)[-1] - [0, 0.5, 0, 0]).max() < 1e-3


@pytest.mark.parametrize("field", ["qvel", "qpos"])
def test_number_that_is_not_finite_does_not_end_the_run(bench, parts, field):
    arm = bench(parts.arm(j1_pos="0.5"))
    arm.run(0.5)
    getattr(arm.simulation.data, field)[1] = math.nan
    before = arm.simulation.time_s
    arm.simulation.advance()
    assert arm.simulation.time_s == pytest.approx(before + 0.01)
    assert arm.run(1.0)[-1] == pytest.approx([0, 0.5, 0, 0], abs=1e-3)
    [failure] = arm.simulation.take_failures()
    assert failure.startswith("the physics became unstable at 0.5")
    assert arm.simulation.take_failures() == []


def test_numbers_that_are_not_finite_are_told_in_the_first_control_period_too(bench, parts):
    arm = bench(parts.pendulum())
    arm.simulation.reset()
    arm.simulation.data.qvel[0] = math.nan
    arm.simulation.advance()
    [failure] = arm.simulation.take_failures()
    assert failure.startswith("the physics became unstable at 0.000 s")
    assert arm.simulation.time_s == pytest.approx(0.01)
    arm.simulation.advance()
    assert arm.simulation.take_failures() == []
    assert np.isfinite(arm.simulation.data.qvel).all()


def test_free_robot_stands_on_its_foot(bench, parts):
    arm = bench(parts.arm(base="free"), base="free")
    data = arm.simulation.data
    start = data.qpos[:7].copy()
    arm.run(2.0)
    assert data.qpos[:7] == pytest.approx(start, abs=2e-3)


def test_arm_pushes_a_thing_that_lies_still(bench, parts):
    arm = bench(parts.arm(), world="objects")
    data, model = arm.simulation.data, arm.simulation.model
    address = model.joint(model.body("red_box").jntadr[0]).qposadr[0]
    data.qpos[address : address + 3] = 0.03, -0.2, 0.04
    arm.claim()
    arm.command(0, 1.9, 0.3, 0.5)
    arm.run(2.0)
    arm.command(-1.0, 1.9, 0.3, 0.5)
    arm.run(2.0)
    assert abs(data.qpos[address] - 0.03) > 0.02


def test_robot_that_cannot_move_is_simulated(parts):
    built = parts.build(parts.robot(parts.link("base", 1.0)))
    simulation = Physics(built, physics_timing(100))
    simulation.advance()
    assert simulation.time_s == pytest.approx(0.01)
