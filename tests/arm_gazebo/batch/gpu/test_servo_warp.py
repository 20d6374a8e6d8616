"""The drives' law as kernels: bit for bit the law on the host."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from arm_sim import Simulation

wp = pytest.importorskip("warp", reason="the extra `gpu` is not installed")

from arm_gazebo.batch.copies import start_of  # noqa: E402
from arm_gazebo.batch.gpu.servo_warp import ServoWarp  # noqa: E402
from arm_gazebo.drives.driven_joint import DriveMode  # noqa: E402
from arm_gazebo.drives.servo_batch import ServoBatch  # noqa: E402

COPIES, TICKS, MOVING_TICKS = 40, 160, 100
KINDS = ("position", "velocity", "effort", "mixed", "proportional", "mycobot", "several controls")
MODES = {
    "velocity": [DriveMode.VELOCITY] * 4,
    "effort": [DriveMode.EFFORT] * 4,
    "mixed": [DriveMode.HOLD, DriveMode.POSITION, DriveMode.EFFORT, DriveMode.VELOCITY],
}


@pytest.fixture(params=["cpu", "cuda"])
def device(request) -> str:
    if request.param == "cuda" and not wp.get_cuda_device_count():
        pytest.skip("there is no GPU")
    return request.param


def simulation(kind: str, world: Path) -> Simulation:
    if kind == "mycobot":
        return Simulation("mycobot")
    if kind == "several controls":
        return Simulation("arm", world=world, arguments={"camera": "none"})
    gain = {"position_proportional_gain": 0.1} if kind == "proportional" else {}
    sim = Simulation("arm", arguments={"camera": "none"}, **gain)
    for index, mode in enumerate(MODES.get(kind, ())):
        sim.parts.physics.servo.set_mode(index, mode)
    return sim


def states(physics, random: np.random.Generator):
    """Yield positions, velocities, inertias and biases, of 32 bits: noise at first, then rest."""
    model, start = physics.model, start_of(physics, physics.model)
    qpos = np.tile(start.qpos, (COPIES, 1)).astype(np.float32)
    for tick in range(TICKS):
        moves = tick < MOVING_TICKS
        qpos = (qpos + moves * random.normal(0.0, 0.01, qpos.shape)).astype(np.float32)
        qvel = moves * random.normal(0.0, 0.3, (COPIES, model.nv))
        # Some copies are heavy, so that a motion needs more effort than there is.
        weight = random.uniform(0.5, 5.0, (COPIES, 1))
        yield (
            qpos,
            *(
                values.astype(np.float32)
                for values in (
                    qvel,
                    start.M * weight,
                    start.qfrc_bias * weight * (1.0 - 0.5 * moves),
                )
            ),
        )


@pytest.mark.parametrize("kind", KINDS)
def test_the_kernels_give_the_bits_of_the_law_on_the_host(kind, several_controls, device):
    sim = simulation(kind, several_controls)
    physics, random = sim.parts.physics, np.random.default_rng(0)
    model, joints = physics.model, physics.servo.joints
    start = start_of(physics, model)
    here = ServoBatch(model, physics.servo, COPIES)
    there = ServoWarp(model, physics.servo, COPIES, start.qpos, device)
    every = np.arange(COPIES)
    zeros = np.zeros((COPIES, model.nv))
    actuators = [joint.actuator for joint in joints]
    activations, controls = model.actuator_actadr[actuators], model.actuator_ctrladr[actuators]
    with wp.ScopedDevice(device):
        act, ctrl = wp.zeros((COPIES, model.na)), wp.zeros((COPIES, model.nu))
    for tick, state in enumerate(states(physics, random)):
        again = every if tick == 0 else every[::5] if tick == 50 else every[:0]
        if len(again):
            here.restart(again, np.tile(start.qpos, (len(again), 1)), zeros[again])
            there.restart(wp.array(again.astype(np.int32), dtype=wp.int32, device=device))
        if tick < MOVING_TICKS and (tick % 30 == 0 or tick % 7 < 2):
            commands = random.uniform(-3.0, 3.0, (COPIES, len(joints)))
        here.command(commands)
        there.command(commands)
        here.update(*(values.astype(np.float64) for values in state))
        there.update(*(wp.array(values, device=device) for values in state), act, ctrl)
        assert np.array_equal(act.numpy()[:, activations], here.activations.astype(np.float32)), (
            tick
        )
        assert np.array_equal(ctrl.numpy()[:, controls], here.rates.astype(np.float32)), tick
    assert np.ptp(here.activations, axis=0).max() > 0.0
    sim.close()


def test_drives_sleep_and_wake_as_on_the_host(several_controls, device):
    sim = simulation("position", several_controls)
    physics = sim.parts.physics
    model, start = physics.model, start_of(physics, physics.model)
    here = ServoBatch(model, physics.servo, 2)
    there = ServoWarp(model, physics.servo, 2, start.qpos, device)
    here.restart(np.arange(2), np.tile(start.qpos, (2, 1)), np.zeros((2, model.nv)))
    there.restart(wp.array(np.arange(2, dtype=np.int32), dtype=wp.int32, device=device))
    marks = []
    with wp.ScopedDevice(device):
        act, ctrl = wp.zeros((2, model.na)), wp.zeros((2, model.nu))
    commands = np.zeros((2, len(physics.servo.joints)))
    for tick in range(60):
        qpos = np.tile(start.qpos, (2, 1)).astype(np.float32)
        # Something pushes the second copy, and later the first gets a command.
        qpos[1, 0] += np.float32(0.002) * (tick >= 30)
        commands[0, 0] = 0.1 * (tick >= 45)
        zeros = np.zeros((2, model.nv), dtype=np.float32)
        inertia = np.tile(start.M, (2, 1)).astype(np.float32)
        # The gravity differs in each tick: a drive that sleeps does not look at it.
        bias = np.full((2, model.nv), 0.001 * tick, dtype=np.float32)
        here.command(commands)
        there.command(commands)
        here.update(*(one.astype(np.float64) for one in (qpos, zeros, inertia, bias)))
        arrays = (wp.array(one, device=device) for one in (qpos, zeros, inertia, bias))
        there.update(*arrays, act, ctrl)
        assert np.array_equal(act.numpy(), here.activations.astype(np.float32)), tick
        marks.append(act.numpy()[:, 1].copy())
    same = [np.array_equal(*pair) for pair in pairwise(marks[20:])]
    assert any(same)
    assert marks[29][1] != marks[31][1]
    assert marks[44][0] != marks[46][0]
    sim.close()
