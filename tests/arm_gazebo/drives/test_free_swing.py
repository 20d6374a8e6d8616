"""Undriven joints swing according to their links' inertia, whatever interfaces they have."""

import math

import mujoco
import numpy as np
import pytest

MASS_KG, LENGTH_M, SIDE_M = 1.0, 0.5, 0.05
INERTIA = MASS_KG * (LENGTH_M**2 + SIDE_M**2 / 6)
"""About the axis of the pendulum of `parts`, a cube: kg m2."""
DOWN = math.pi / 2
AMPLITUDE = 0.05


def period(positions: np.ndarray, rate_hz: float) -> float:
    """Return the time between crossings of the lowest point in the same direction, in s."""
    offset = positions - DOWN
    rising = np.flatnonzero((offset[:-1] < 0) & (offset[1:] >= 0))
    times = rising + offset[rising] / (offset[rising] - offset[rising + 1])
    return float(np.diff(times).mean() / rate_hz)


def swing(arm, seconds: float = 6.0) -> float:
    """Let a pendulum go near its lowest point and return its period."""
    simulation = arm.simulation
    joint = simulation.built.joints["j"]
    simulation.data.qpos[joint.qpos_address] = DOWN + AMPLITUDE
    simulation.data.qvel[:] = 0.0
    mujoco.mj_forward(simulation.model, simulation.data)
    simulation.servo.reset()
    return period(arm.run(seconds)[:, 0], arm.rate_hz)


@pytest.mark.parametrize("how", ["never claimed", "released", "by effort"])
def test_a_pendulum_has_the_period_that_theory_gives(bench, parts, how):
    arm = bench(parts.pendulum(), hold_joints=False)
    if how == "released":
        arm.claim("position")
        arm.run(0.1)
        arm.release("position")
    elif how == "by effort":
        arm.claim("effort")
        arm.command(0.0)
    gravity = -float(arm.simulation.model.opt.gravity[2])
    theory = 2 * math.pi * math.sqrt(INERTIA / (MASS_KG * gravity * LENGTH_M))
    assert swing(arm) == pytest.approx(theory, rel=0.002)


def test_mimic_joints_of_an_undriven_joint_have_no_gear_either(bench, parts):
    follower = parts.joint("f", "base", "finger", more='<mimic joint="j" multiplier="1"/>')
    urdf = parts.pendulum().replace(
        "<ros2_control", f"{parts.link('finger', 0.01, 0.05)}{follower}<ros2_control", 1
    )
    arm = bench(urdf, hold_joints=False)
    model = arm.simulation.model
    assert model.dof_armature == pytest.approx(0.0)
    arm.claim("position")
    held = model.dof_armature.copy()
    assert (held > 0).all()
    arm.release("position")
    assert model.dof_armature == pytest.approx(0.0)
    arm.claim("effort")
    own = arm.simulation.built.joints
    assert model.dof_armature[own["j"].dof_address] == 0.0
    assert model.dof_armature[own["f"].dof_address] == held[own["f"].dof_address]


def test_an_undriven_free_wheel_has_no_rotor(bench, parts):
    """MuJoCo keeps the inertia of such a body in an array of its own."""
    arm = bench(parts.wheel(1.0, 'effort="5" velocity="10"'), hold_joints=False)
    arm.claim("velocity")
    arm.release("velocity")
    arm.simulation.data.qfrc_applied[0] = 0.01
    arm.run(1.0)
    inertia = 1.0 * 0.1**2 / 6
    assert arm.state("velocity")[0] == pytest.approx(0.01 / inertia, rel=0.01)
