"""Set-points of many copies: to the bit those of one."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_gazebo.drives.driven_joint import CommandStream
from arm_gazebo.drives.setpoint import Setpoint
from arm_gazebo.drives.setpoint_batch import CommandStreams, approach

PERIOD_S = 0.01
near = st.floats(-3.0, 3.0)
bound = st.floats(0.01, 200.0)


@settings(max_examples=300, deadline=None)
@given(
    position=near,
    velocity=near,
    target=st.one_of(near, st.sampled_from([math.inf, -math.inf])),
    target_velocity=st.one_of(st.just(0.0), near),
    speed=bound,
    braking=bound,
    spare=st.floats(1.0, 10.0),
)
def test_approach_moves_as_one_set_point_does(
    position, velocity, target, target_velocity, speed, braking, spare
):
    one = Setpoint(position, velocity)
    one.approach(target, target_velocity, speed, spare * braking, braking, PERIOD_S)
    rows = [np.full((2, 1), value) for value in (position, velocity, target, target_velocity)]
    limits = [np.array([value]) for value in (speed, spare * braking, braking)]
    positions, velocities = approach(*rows, *limits, PERIOD_S)
    assert positions.tolist() == [[one.position], [one.position]]
    assert velocities.tolist() == [[one.velocity], [one.velocity]]


@pytest.mark.parametrize("near_end", [0.0, 1e-5, 1e-3, 0.3])
def test_a_whole_approach_has_the_same_bits(near_end):
    one = Setpoint(0.0)
    positions, velocities = np.zeros((1, 1)), np.zeros((1, 1))
    for _ in range(200):
        one.approach(near_end, 0.0, 2.0, 30.0, 10.0, PERIOD_S)
        positions, velocities = approach(
            positions,
            velocities,
            np.full((1, 1), near_end),
            0.0,
            np.array([2.0]),
            np.array([30.0]),
            np.array([10.0]),
            PERIOD_S,
        )
        assert (positions[0, 0], velocities[0, 0]) == (one.position, one.velocity)
    assert one.position == near_end


@settings(max_examples=100, deadline=None)
@given(st.lists(st.one_of(st.none(), st.floats(-1.0, 1.0)), max_size=40))
def test_streams_turn_commands_into_targets_as_one_stream_does(commands):
    one, many = CommandStream(0.25, PERIOD_S), CommandStreams.at(np.full((2, 1), 0.25))
    last = 0.25
    for tick, command in enumerate(commands):
        last = last if command is None else command
        one.command(last, tick)
        one.advance()
        many.take(np.full((2, 1), last), np.full((2, 1), tick), PERIOD_S)
        many.advance(None, PERIOD_S)
        assert many.target.tolist() == [[one.target], [one.target]]
        assert many.velocity.tolist() == [[one.velocity], [one.velocity]]
