"""Drives hold and move under a gravity that changes while they run."""

import math

import numpy as np
import pytest

from arm_gazebo.drives.servo_tuning import weak_drives
from arm_gazebo.physics.world_properties import PropertyChanges

MOON, JUPITER = -1.62, -24.8
HELD_RAD = 1e-6
POSE = (0.4, 0.6, 0.5, 0.3)


def set_gravity(arm, gravity: float) -> None:
    arm.simulation.set_properties(PropertyChanges((0.0, 0.0, gravity)))


@pytest.mark.parametrize("gravity", [MOON, 0.0, JUPITER, 9.81])
@pytest.mark.parametrize("commanded", [True, False])
def test_an_arm_at_rest_holds_its_pose(bench, parts, gravity, commanded):
    arm = bench(parts.arm())
    arm.claim()
    arm.command(*POSE)
    # So long that the drives sleep.
    arm.run(3.0)
    if not commanded:
        arm.release()
        arm.run(0.5)
    before, efforts = arm.state("position"), arm.state("effort")
    set_gravity(arm, gravity)
    ways = arm.run(1.0) - before
    assert np.abs(ways).max() < HELD_RAD
    # The efforts that hold it are proportional to the gravity.
    assert arm.state("effort") == pytest.approx(efforts * gravity / -9.81, abs=2e-3)


def test_a_motion_goes_on_through_the_change_and_ends_where_it_should(bench, parts):
    arm = bench(parts.serial_arm(6, 20.0, 0.9))
    arm.claim()
    arm.command(*[0.9] * 6)
    arm.run(0.2)
    set_gravity(arm, 0.0)
    positions = arm.run(3.0)
    assert positions[-1] == pytest.approx(0.9, abs=1e-4)
    assert positions.max() < 0.9 + 5e-3


def test_an_arm_in_twice_the_gravity_brakes_in_time(bench, parts):
    # The drives of this arm have twice the effort that gravity asks for at most.
    arm = bench(parts.serial_arm(6, 20.0, 0.9))
    arm.claim()
    set_gravity(arm, 1.8 * -9.81)
    arm.command(*[0.9] * 6)
    positions = arm.run(5.0)
    assert positions[-1] == pytest.approx(0.9, abs=1e-3)
    assert positions.max() < 0.9 + 0.01


def test_a_free_joint_swings_as_on_the_moon(bench, parts):
    arm = bench(parts.pendulum(), hold_joints=False)
    set_gravity(arm, MOON)
    arm.run(0.05)
    inertia = 1.0 * (0.5**2 + 0.05**2 / 6)
    fallen = arm.state("position")[0]
    acceleration = 1.0 * -MOON * 0.5 / inertia
    assert fallen == pytest.approx(acceleration * 0.05**2 / 2, rel=0.05)


def test_a_drive_that_is_too_weak_for_it_is_named(bench, parts):
    arm = bench(parts.pendulum(limit='lower="-3" upper="3" effort="10" velocity="3"'))
    physics = arm.simulation
    assert not list(weak_drives(physics.model, physics.servo.joints, physics.servo.tuning))
    set_gravity(arm, JUPITER)
    [(name, problem)] = weak_drives(physics.model, physics.servo.joints, physics.servo.tuning)
    assert name == "j"
    assert f"is below the {24.8 * 0.5:.3g}" in problem
    assert math.isfinite(arm.run(0.1)[-1, 0])
