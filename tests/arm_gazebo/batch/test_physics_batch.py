"""Copies of a simulation: each to the bit like the simulation alone."""

from pathlib import Path

import numpy as np
import pytest
from robots import MYCOBOT_ARM

from arm_gazebo.batch.choice import SERIAL_COPIES, make_copies
from arm_gazebo.batch.copies import CommandBounds, Copies
from arm_gazebo.batch.host_batches import PhysicsBatch, SerialBatch
from arm_gazebo.errors import BatchError
from arm_sim import Simulation

ARM = ("j0", "j1", "j2", "j3")
MYCOBOT = (*MYCOBOT_ARM, "gripper_controller")
CONTROLLER = """
controller_manager:
  ros__parameters:
    update_rate: 100
    commander: {{type: forward_command_controller/ForwardCommandController}}
commander:
  ros__parameters: {{joints: [{}], interface_name: {}}}
"""
COPIES = 3
TICKS = 140
LARGEST = 3.0


def simulation(
    folder: Path, robot: str, joints: tuple[str, ...], interface: str, **options: object
) -> Simulation:
    file = folder / "controllers.yaml"
    file.write_text(CONTROLLER.format(", ".join(joints), interface))
    arguments = {"camera": "none"} if robot == "arm" else {}
    return Simulation(robot, controllers=file, arguments=arguments, **options)  # type: ignore[arg-type]


def restart(sim: Simulation) -> None:
    sim.controllers.switch(deactivate=["commander"])
    sim.parts.physics.reset()
    sim.controllers.switch(activate=["commander"])


def batch_of(sim: Simulation, copies: int = COPIES) -> PhysicsBatch:
    return PhysicsBatch(sim.parts.physics, bounds_of(sim), copies, threads=2)


def serial_of(sim: Simulation, copies: int = COPIES) -> SerialBatch:
    return SerialBatch(sim.parts.physics, bounds_of(sim), copies)


def bounds_of(sim: Simulation) -> CommandBounds:
    return CommandBounds(sim.parts.physics, sim.parts.robot.hardware)


def commands(joints: int) -> np.ndarray:
    """Steps, streams and rests for each copy, some beyond the limits: (ticks, copies, joints)."""
    random = np.random.default_rng(4)
    values = random.uniform(-LARGEST, LARGEST, (TICKS, COPIES, joints))
    for tick in range(TICKS):
        if 30 <= tick < 60:
            values[tick] = values[tick - 1] + 0.01 * random.normal(size=(COPIES, joints))
        elif tick % 30:
            values[tick] = values[tick - 1]
    return values


@pytest.mark.parametrize(
    ("robot", "joints", "interface", "options"),
    [
        ("arm", ARM, "position", {}),
        ("arm", ARM, "velocity", {}),
        ("arm", ARM, "effort", {}),
        ("arm", ARM, "position", {"position_proportional_gain": 0.1}),
        # Mimic joints, contacts, things that sleep.
        ("mycobot", MYCOBOT, "position", {}),
    ],
    ids=["position", "velocity", "effort", "proportional", "mycobot"],
)
def test_each_copy_goes_through_the_states_of_the_library(
    tmp_path, robot, joints, interface, options
):
    sim = simulation(tmp_path, robot, joints, interface, **options)
    driven = [joint.name for joint in sim.parts.physics.servo.joints]
    columns = [driven.index(name) for name in joints]
    asked = commands(len(joints))
    batches: tuple[Copies, ...] = batch_of(sim), serial_of(sim)
    states = np.zeros((COPIES, TICKS, *sim.parts.physics.data.qpos.shape))
    for copy in range(COPIES):
        restart(sim)
        for tick in range(TICKS):
            sim["commander"].command(asked[tick, copy].tolist())
            sim.step()
            states[copy, tick] = sim.parts.physics.data.qpos
    for tick in range(TICKS):
        values = np.zeros((COPIES, len(driven)))
        values[:, columns] = asked[tick]
        for batch in batches:
            assert not batch.advance(values).any()
            assert np.array_equal(batch.qpos, states[:, tick]), f"{type(batch)}, tick {tick}"
    assert np.ptp(states[0], axis=0).max() > 0.1
    sim.close()


def test_copies_that_fell_asleep_go_on_as_the_library_does(tmp_path):
    sim = simulation(tmp_path, "arm", ARM, "position")
    batch = batch_of(sim, copies=2)
    restart(sim)
    first, second = [0.1, 0.1, 0.1, 0.1], [0.1, 0.2, 0.1, 0.1]
    for tick in range(150):
        command = first if tick < 120 else second
        # The other copy sleeps on.
        batch.advance(np.array([command, first]))
        sim["commander"].command(command)
        sim.step()
        assert np.array_equal(batch.qpos[0], sim.parts.physics.data.qpos), f"tick {tick}"
    assert batch.qpos[0, 1] != batch.qpos[1, 1]
    sim.close()


@pytest.mark.parametrize("make", [batch_of, serial_of])
def test_a_copy_restarts_alone_and_repeats_its_run(tmp_path, make):
    sim = simulation(tmp_path, "arm", ARM, "position")
    batch = make(sim, copies=2)
    goal = np.full((2, 4), 0.4)
    batch.advance(goal, periods=20)
    once = batch.qpos[1].copy()
    batch.reset([1])
    assert not batch.qpos[1].any()
    batch.advance(goal, periods=20)
    assert np.array_equal(batch.qpos[1], once)
    assert not np.array_equal(batch.qpos[0], once)
    sim.close()


def test_links_are_where_the_library_says_and_looking_changes_nothing(tmp_path):
    sim = simulation(tmp_path, "arm", ARM, "position")
    looked, alone, serial = batch_of(sim, 2), batch_of(sim, 2), serial_of(sim, 2)
    restart(sim)
    body = sim.parts.physics.built.bodies["dyn5"]
    for _ in range(30):
        for batch in (looked, alone, serial):
            batch.advance(np.full((2, 4), 0.5))
        sim["commander"].command([0.5] * 4)
        sim.step()
        for batch in (looked, serial):
            assert np.array_equal(batch.link_positions(body)[1], sim.pose("dyn5")[:3, 3])
    assert np.array_equal(looked.qpos, alone.qpos)
    sim.close()


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        (np.zeros((1, 4)), r"need the shape \(2, 4\), not \(1, 4\)"),
        (np.full((2, 4), np.nan), "need finite values"),
    ],
)
def test_commands_that_are_none_are_refused(tmp_path, values, problem):
    sim = simulation(tmp_path, "arm", ARM, "position")
    for batch in (batch_of(sim, copies=2), serial_of(sim, copies=2)):
        with pytest.raises(BatchError, match=problem):
            batch.advance(values)
    with pytest.raises(BatchError, match="at least 1 copy, not 0"):
        batch_of(sim, copies=0)
    sim.close()


@pytest.mark.parametrize("periods", [0, 1])
def test_a_copy_that_becomes_unstable_is_told(tmp_path, periods):
    sim = simulation(tmp_path, "arm", ARM, "effort")
    batch = batch_of(sim, copies=2)
    batch.advance(np.zeros((2, 4)), periods)
    batch.qvel[1, 0] = np.nan
    assert batch.advance(np.zeros((2, 4))).tolist() == [False, True]
    sim.close()


def test_the_kind_of_batch_follows_from_the_number_of_copies(tmp_path):
    sim = simulation(tmp_path, "arm", ARM, "position")
    physics, hardware = sim.parts.physics, sim.parts.robot.hardware
    assert isinstance(make_copies(physics, hardware, SERIAL_COPIES), SerialBatch)
    assert isinstance(make_copies(physics, hardware, SERIAL_COPIES + 1), PhysicsBatch)
    sim.close()
