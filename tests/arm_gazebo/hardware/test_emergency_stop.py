"""The drives at an emergency stop: how far they go, what holds, and what happens at the release."""

import numpy as np
import pytest

MASS_KG = 2.0
EFFORT = 0.5
SPEED = 4.0
INERTIA = MASS_KG * 0.1**2 / 6
"""Of the wheel: a cube with a side of 0.1 m."""


@pytest.fixture
def wheel(bench, parts):
    """A wheel that is turned by velocity commands, at full speed."""
    made = bench(parts.wheel(MASS_KG, f'effort="{EFFORT}" velocity="10"'))
    made.claim("velocity")
    made.command(SPEED)
    made.run(2.0)
    assert made.state("velocity") == pytest.approx(SPEED, rel=0.01)
    return made


def test_a_drive_stops_within_the_distance_that_physics_allows(wheel):
    start, speed = float(wheel.state("position")[0]), float(wheel.state("velocity")[0])
    wheel.hardware.set_emergency_stop(True)
    way = wheel.run(2.0)[:, 0] - start
    braking = wheel.simulation._tuning.bounds(0).braking
    full = EFFORT / INERTIA
    # Not shorter than with the whole effort, and not longer than with what is planned for stops.
    assert speed**2 / (2 * full) <= way[-1] <= speed**2 / (2 * braking) + 2 * speed / wheel.rate_hz
    assert way.max() - way[-1] < 1e-3
    assert abs(wheel.state("velocity")[0]) < 1e-3


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
def test_an_arm_in_full_motion_comes_to_rest_and_holds(bench, parts, interface):
    arm = bench(parts.serial_arm(6, 15.0, 0.9))
    arm.claim(interface)
    arm.command(*{"position": [1.0], "velocity": [0.7], "effort": [2.0]}[interface])
    arm.run(0.4)
    moving = np.abs(arm.state("velocity")).max()
    assert moving > 0.2
    arm.hardware.set_emergency_stop(True)
    # Whatever is commanded from now on has no effect.
    arm.command(*{"position": [-1.0], "velocity": [-0.7], "effort": [5.0]}[interface])
    arm.run(1.5)
    held = arm.state("position")
    rest = arm.run(1.0)
    assert np.abs(rest - held).max() < 1e-3
    assert np.abs(arm.state("velocity")).max() < 1e-3


@pytest.mark.parametrize("interface", ["position", "velocity"])
def test_a_release_causes_no_jump(bench, parts, interface):
    arm = bench(parts.serial_arm(6, 15.0, 0.9))
    arm.claim(interface)
    arm.command(*{"position": [1.0], "velocity": [0.7]}[interface])
    arm.run(0.4)
    arm.hardware.set_emergency_stop(True)
    arm.run(1.5)
    held = arm.state("position")
    arm.hardware.set_emergency_stop(False)
    assert arm.commanded == pytest.approx(held if interface == "position" else 0.0, abs=0.01)
    rest = arm.run(1.0)
    assert np.abs(rest - held).max() < 1e-3
    # The drives obey again.
    arm.command(*(held + 0.2 if interface == "position" else np.full(6, 0.2)))
    arm.run(1.0)
    assert (arm.state("position") > held + 0.1).all()


def test_a_joint_that_would_fall_is_held(bench, parts):
    pendulum = bench(parts.pendulum(), hold_joints=False)
    start = pendulum.state("position")
    pendulum.hardware.set_emergency_stop(True)
    assert pendulum.run(1.0)[-1] == pytest.approx(start, abs=1e-3)
    pendulum.hardware.set_emergency_stop(False)
    assert pendulum.run(0.5)[-1] > start + 0.1


def test_an_interface_claimed_meanwhile_moves_nothing_before_the_release(bench, parts):
    pendulum = bench(parts.pendulum())
    pendulum.hardware.set_emergency_stop(True)
    pendulum.claim("velocity")
    pendulum.command(1.0)
    assert np.abs(pendulum.run(0.5)).max() < 1e-3
    pendulum.hardware.set_emergency_stop(False)
    # What was commanded during the stop is forgotten.
    assert np.abs(pendulum.run(0.5)).max() < 1e-3
    pendulum.command(1.0)
    assert pendulum.run(0.5)[-1] > 0.2
