"""Trajectories that replace each other without a step, whatever they are and whenever they come."""

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

JOIN_S = 0.3
STRETCH_S = 0.5
PERIOD_S = 0.001
MOST_RAD_S2 = 400.0
"""More than a difference of some rad that fades within JOIN_S needs."""

unhurried = settings(
    deadline=None,
    max_examples=25,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)

angles = st.floats(-1.0, 1.0)
triples = st.lists(angles, min_size=3, max_size=3)
still = st.just([0.0, 0.0, 0.0])


@st.composite
def trajectories(draw: Callable) -> list[tuple[Any, ...]]:
    """Two to four points with velocities and accelerations, which end at rest."""
    times = np.cumsum(draw(st.lists(st.floats(0.4, 1.0), min_size=2, max_size=4)))
    moving = [(time_s, draw(triples), draw(triples), draw(triples)) for time_s in times[:-1]]
    return [*moving, (times[-1], draw(triples), draw(still), draw(still))]


@st.composite
def sequences(draw: Callable) -> list[tuple[list[tuple[Any, ...]], float, float]]:
    """Trajectories, how long each is followed, and where its stamp lies against the present."""
    return [
        (draw(trajectories()), draw(st.floats(0.0, STRETCH_S)), draw(st.floats(-0.7, 0.5)))
        for _ in range(draw(st.integers(2, 4)))
    ]


@unhurried
@given(sequences())
def test_commands_are_continuous_in_position_and_velocity(make_rig, sequence):
    rig = make_rig(commands=("position", "velocity"), smooth_replacement_time=JOIN_S)
    rig.period_s = PERIOD_S
    rig.tick()
    commands = [(rig.commanded(), rig.commanded("velocity"))]
    for points, followed_s, offset_s in sequence:
        rig.trajectory(points, stamp_s=rig.time_s + offset_s)
        for _ in range(1 + round(followed_s / PERIOD_S)):
            rig.tick()
            commands.append((rig.commanded(), rig.commanded("velocity")))

    position, velocity = (np.array(values) for values in zip(*commands, strict=True))
    assert np.abs(np.diff(velocity, axis=0)).max() <= MOST_RAD_S2 * PERIOD_S
    travelled = (velocity[:-1] + velocity[1:]) / 2.0 * PERIOD_S
    assert np.abs(np.diff(position, axis=0) - travelled).max() <= MOST_RAD_S2 * PERIOD_S**2
