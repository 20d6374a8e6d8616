"""Moves between states of which samples are looked at."""

import numpy as np
from planar_arm import PlanarArm

from arm_planning.planners.space import CLEARANCE_M, SampledSpace

LIMITS = np.array([-3.0, -3.0]), np.array([3.0, 3.0])
START, GOAL = np.array([-0.2, 0.0]), np.array([0.9, 0.0])
RADIUS_M = 0.1


def disc(angle: float) -> tuple[float, float, float]:
    """A disc that the tip of the stretched arm misses by less than the clearance."""
    distance = 2.0 + RADIUS_M + CLEARANCE_M / 2.0
    return distance * np.cos(angle), distance * np.sin(angle), RADIUS_M


def test_moves_keep_a_clearance_where_the_ends_have_it():
    space = SampledSpace(PlanarArm((disc(0.35),)), *LIMITS)
    assert space.connect(START, GOAL) is not None
    assert space.with_clearance(np.array([START, GOAL])).connect(START, GOAL) is None


def test_an_end_without_clearance_takes_none_from_the_moves():
    space = SampledSpace(PlanarArm((disc(0.35), disc(0.9))), *LIMITS)
    assert space.with_clearance(np.array([START, GOAL])).connect(START, GOAL) is not None
