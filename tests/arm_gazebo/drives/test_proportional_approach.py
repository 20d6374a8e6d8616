"""With gz_ros2_control's proportional gain, the last part of a motion is an exponential decay."""

import math

import numpy as np
import pytest

GAIN = 0.1


@pytest.mark.parametrize("rate_hz", [30.0, 100.0, 225.0])
def test_the_distance_decays_by_e_in_the_original_s_time(bench, parts, rate_hz):
    arm = bench(parts.arm(velocity_limit="0.1"), rate_hz, proportional_gain=GAIN)
    arm.claim()
    arm.command(0.3, 0.0, 0.0, 0.0)
    positions = arm.run(3.0 + 8 / (GAIN * rate_hz))[:, 0]

    speeds = np.diff(positions) * rate_hz
    assert speeds.max() <= 0.1 * 1.001
    # At the speed limit until the decay is slower: 0.1 rad/s = 0.1 rate x distance.
    decay_s = 1 / (GAIN * rate_hz)
    distances = 0.3 - positions
    start = int(np.argmax(distances < 0.5 * 0.1 * decay_s))
    end = start + math.ceil(2 * decay_s * rate_hz)
    periods = np.arange(start, end)
    slope = np.polyfit(periods / rate_hz, np.log(distances[start:end]), 1)[0]
    assert -1 / slope == pytest.approx(decay_s, rel=0.05)


def test_the_joint_arrives_exactly_and_rests(bench, parts):
    arm = bench(parts.arm(velocity_limit="2.0"), 100.0, proportional_gain=GAIN)
    arm.claim()
    arm.command(0.3, 0.2, -0.1, 0.4)
    positions = arm.run(4.0)
    assert positions[-1] == pytest.approx([0.3, 0.2, -0.1, 0.4], abs=1e-4)
    assert (positions[-1] <= [0.3 + 1e-4, 0.2 + 1e-4, 0.0, 0.4 + 1e-4]).all()
    assert np.ptp(positions[-20:], axis=0) == pytest.approx(0.0, abs=1e-6)


def test_without_the_gain_the_joint_brakes_at_the_end(bench, parts):
    arm = bench(parts.arm(velocity_limit="0.1"), 100.0)
    arm.claim()
    arm.command(0.3, 0.0, 0.0, 0.0)
    positions = arm.run(3.1)
    assert positions[-1, 0] == pytest.approx(0.3, abs=1e-3)
