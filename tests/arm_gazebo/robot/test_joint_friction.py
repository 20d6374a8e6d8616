"""Dry friction of a joint: it holds what it can, and does not spoil what a servo does."""

from typing import Any

import numpy as np
import pytest

G = 9.81


def hanging(parts: Any, mass_kg: float, arm_m: float, friction: float, effort: float = 0.0) -> str:
    """Return the URDF of a link that hangs beside its axis 'j'."""
    return parts.robot(
        parts.link("base"),
        parts.link("bob", mass_kg, arm_m / 4, f"{arm_m} 0 0"),
        parts.joint(
            "j",
            "base",
            "bob",
            xyz="0 0 2",
            limit=f'lower="-3" upper="3" effort="{effort}" velocity="3"',
            more=f'<dynamics friction="{friction}"/>',
        ),
        parts.ros2_control(["j"]),
    )


@pytest.mark.parametrize(
    ("mass_kg", "arm_m"), [(0.001, 0.01), (0.001, 0.1), (0.1, 0.1), (1.0, 0.3), (100.0, 1.0)]
)
@pytest.mark.parametrize("speed", [0.0, -3.0], ids=["at rest", "thrown"])
def test_a_joint_rests_under_its_own_friction(bench, parts, mass_kg, arm_m, speed):
    run = bench(hanging(parts, mass_kg, arm_m, mass_kg * G * arm_m / 0.9))
    run.claim("effort")
    run.command(0.0)
    run.simulation.data.qvel[0] = speed
    come_to_rest = run.run(0.5)[-1]
    moved = run.run(10.0) - come_to_rest
    assert np.abs(moved).max() < 0.002
    assert abs(run.state("velocity")[0]) < 2e-4


def test_a_joint_that_nothing_drives_rests_too(bench, parts):
    limb = parts.joint("k", "bob", "limb", xyz="0.1 0 0", more='<dynamics friction="0.2"/>')
    urdf = hanging(parts, 1.0, 0.1, 20.0, 50.0).replace(
        "</robot>", parts.link("limb", 0.1, 0.02, "0.1 0 0") + limb + "</robot>"
    )
    run = bench(urdf, hold_joints=False)
    run.run(10.0)
    limb = run.built.joints["k"]
    assert abs(run.simulation.data.qpos[limb.qpos_address]) < 0.001


def test_joints_that_stick_do_not_chatter(bench, parts):
    """A thrown arm comes to rest for good, whatever its neighbours do."""
    arm = bench(parts.serial_arm(6, 5.0, 0.6, friction=0.6))
    arm.claim("effort")
    arm.command(*[0.0] * 6)
    arm.simulation.data.qvel[:] = (2, -3, 4, -8, 8, -8)
    arm.run(1.0)
    assert np.ptp(arm.run(1.0), axis=0).max() < 1e-4


def solver(run: Any) -> float | str:
    impedance = float(run.simulation.model.dof_solimp[0, 0])
    return STICKS if impedance == STICKS else YIELDS


STICKS, YIELDS = 0.9999, "yields"


def test_friction_sticks_unless_a_servo_holds_the_joint(bench, parts):
    run = bench(hanging(parts, 0.1, 0.1, 0.2, 5.0))
    assert solver(run) == YIELDS
    run.claim("effort")
    assert solver(run) == STICKS
    run.release("effort")
    assert solver(run) == YIELDS


def test_friction_sticks_where_the_drive_cannot_overcome_it(bench, parts):
    assert solver(bench(hanging(parts, 0.1, 0.1, 0.2, 0.1))) == STICKS


def test_friction_of_a_follower_yields_with_its_leader(bench, parts):
    mimic = '<mimic joint="j"/><dynamics friction="0.1"/>'
    urdf = hanging(parts, 0.1, 0.1, 0.2, 5.0).replace(
        "</robot>",
        parts.link("other", 0.1) + parts.joint("k", "base", "other", more=mimic) + "</robot>",
    )
    run = bench(urdf)
    assert (run.simulation.model.dof_solimp[:, 0] < STICKS).all()
    run.claim("effort")
    assert run.simulation.model.dof_solimp[:, 0].tolist() == [STICKS, STICKS]


def test_a_stalled_joint_stays_stalled_whatever_its_mode_and_is_free_in_the_last_one(bench, parts):
    run = bench(hanging(parts, 0.1, 0.1, 0.2, 5.0))
    run.simulation.stall_joint("j")
    run.claim("effort")
    run.release("effort")
    assert solver(run) == STICKS
    run.simulation.free_joint("j")
    assert solver(run) == YIELDS


def test_a_restored_state_has_the_friction_of_its_modes(bench, parts):
    run = bench(hanging(parts, 0.1, 0.1, 0.2, 5.0))
    held = run.simulation.save_state()["servo"]
    run.claim("effort")
    run.simulation.servo.load_state(held)
    assert solver(run) == YIELDS


@pytest.mark.parametrize("mass_kg", [0.2, 2.0, 20.0])
@pytest.mark.parametrize("dynamics", ['friction="30"', 'friction="30" damping="30"'])
def test_a_drive_without_an_effort_limit_is_sized_for_friction_and_damping(
    bench, parts, mass_kg, dynamics
):
    urdf = hanging(parts, mass_kg, 0.1, 0).replace('friction="0"', dynamics)
    run = bench(urdf)
    run.claim()
    start = run.state("position")[0]
    run.command(start + 0.3)
    positions = run.run(2.0)[:, 0]
    assert positions.max() < start + 0.3 * 1.005
    assert positions[-1] == pytest.approx(start + 0.3, abs=1e-5)


@pytest.mark.parametrize("rate_hz", [100, 500])
@pytest.mark.parametrize(
    ("mass_kg", "effort", "speed"), [(0.015, 20, 0.2), (0.015, 70, 0.05), (0.01, 1000, 0.2)]
)
def test_a_small_sliding_gripper_with_friction_does_not_overshoot(
    bench, parts, mass_kg, effort, speed, rate_hz
):
    """A light finger on a strong drive: MuJoCo's friction knows the finger, not the rotor."""
    limit = f'lower="0" upper="0.04" effort="{effort}" velocity="{speed}"'
    friction = f'<dynamics friction="{0.05 * effort}"/>'
    urdf = parts.robot(
        parts.link("base"),
        *(parts.link(name, mass_kg, 0.02) for name in ("left", "right")),
        parts.joint("j", "base", "left", "prismatic", "0 0 1", "0 1 0", limit, friction),
        parts.joint(
            "k",
            "base",
            "right",
            "prismatic",
            "0 0 1",
            "0 -1 0",
            limit,
            f'{friction}<mimic joint="j"/>',
        ),
        parts.ros2_control(["j"]),
    )
    gripper = bench(urdf, rate_hz)
    gripper.claim()
    gripper.command(0.01)
    positions = gripper.run(1.0)[:, 0]
    assert positions.max() < 0.01 * 1.02
    assert positions[-1] == pytest.approx(0.01, abs=1e-4)
