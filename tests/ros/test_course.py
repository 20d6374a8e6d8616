"""`course:=S0`: the world without the node, at the original's rate, speed and last approach."""

import math

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

TOPIC = "/position_controller/commands"
DECAY_S = 1 / (0.1 * 30)


def test_course_s0_moves_as_the_original_does(launch, client):
    launch("course:=S0", "camera:=none", "real_time_factor:=4").wait_until_ready()
    assert client.node.count_publishers(TOPIC) == 0
    client.wait_until(lambda: client.node.count_subscribers(TOPIC) == 1, "the controller")
    states = client.subscribe(JointState, "/joint_states")
    first = states.wait_for(1)[0]
    start = dict(zip(first.name, first.position, strict=True))
    assert [start[f"j{i}"] for i in range(4)] == pytest.approx([0.0, 0.5, 0.5, 1.0], abs=0.01)

    goal = [0.2, 0.5, 0.5, 1.0]
    client.publisher(Float64MultiArray, TOPIC).publish(Float64MultiArray(data=goal))
    index = list(first.name).index("j0")
    seen = states.wait_until(lambda m: m and abs(m[-1].position[index] - 0.2) < 5e-4, "j0 there")
    times = np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in seen])
    positions = np.array([m.position[index] for m in seen])
    assert np.rint(np.diff(times) * 30).min() == 1
    assert (np.diff(positions) / np.diff(times)).max() <= 0.1 * 1.01
    left = 0.2 - positions
    tail = (left < 0.5 * 0.1 * DECAY_S) & (left > 0.5 * 0.1 * DECAY_S * math.exp(-2))
    slope = np.polyfit(times[tail], np.log(left[tail]), 1)[0]
    assert -1 / slope == pytest.approx(DECAY_S, rel=0.1)
