"""A world whose actuators have several controls each, before those of the robot.

Then `data.ctrl` has more numbers than the model has actuators.
"""

import numpy as np
import pytest

from arm_gazebo.batch.copies import CommandBounds
from arm_gazebo.batch.host_batches import PhysicsBatch, SerialBatch

WORLDS_OWN = 7
"""Controls of the world's three actuators."""


@pytest.fixture
def arm(bench, parts, several_controls):
    made = bench(parts.pendulum(), 100.0, several_controls)
    made.claim()
    return made


def test_the_robots_command_moves_the_robot_alone(arm):
    arm.command(0.5)
    assert arm.run(1.5)[-1] == pytest.approx([0.5], abs=2e-3)
    data = arm.simulation.data
    assert not data.ctrl[:WORLDS_OWN].any()
    assert data.joint("dj").qpos == pytest.approx(0.0, abs=1e-9)
    assert data.joint("hj").qpos == pytest.approx([1, 0, 0, 0], abs=1e-9)


def test_the_worlds_own_actuators_take_their_own_controls(arm):
    # Position and rate of the first one, and the same position for the one that integrates.
    arm.simulation.data.ctrl[[0, 5]] = 0.4
    arm.command(0.0)
    arm.run(10.0)
    assert arm.simulation.data.joint("dj").qpos == pytest.approx(0.4, abs=2e-2)
    assert arm.state("position") == pytest.approx([0.0], abs=2e-3)


@pytest.mark.parametrize("make", [PhysicsBatch, SerialBatch])
def test_copies_move_as_the_single_one(arm, make):
    batch = make(arm.simulation, CommandBounds(arm.simulation, [arm.hardware]), 2)
    # The copies start at rest, with their drives at rest.
    arm.release()
    arm.simulation.reset()
    arm.claim()
    for angle in (0.5, -0.3):
        arm.command(angle)
        for _ in range(30):
            arm.tick()
            assert not batch.advance(np.array([[angle], [0.0]])).any()
            assert np.array_equal(batch.qpos[0], arm.simulation.data.qpos)
    assert abs(batch.qpos[0, -1] - batch.qpos[1, -1]) > 0.2
