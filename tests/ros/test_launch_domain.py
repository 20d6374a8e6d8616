"""`arm launch domain:=auto`: several simulations on one machine never hear each other."""

import os
import re
import signal

import pytest
from run_python import run_python
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

pytestmark = pytest.mark.timeout(600)

WORLDS = 4
SMALLEST = ("camera:=none", "controller_node:=false", "use_robot_state_pub:=false")


def domain_of(launched) -> int:
    found = re.search(r"ROS_DOMAIN_ID=(\d+); export it", launched.output)
    assert found, launched.output
    return int(found[1])


def test_worlds_side_by_side_do_not_hear_each_other(launch, client_in):
    worlds = [launch("domain:=auto", *SMALLEST) for _ in range(WORLDS)]
    for launched in worlds:
        launched.wait_until_ready()
    domains = [domain_of(launched) for launched in worlds]
    assert len({*domains, int(os.environ["ROS_DOMAIN_ID"])}) == WORLDS + 1
    clients = [client_in(domain) for domain in domains]
    states = [client.subscribe(JointState, "/joint_states") for client in clients]
    topic = "/position_controller/commands"
    publishers = [client.publisher(Float64MultiArray, topic) for client in clients]
    goals = [0.1 * (number + 1) for number in range(WORLDS)]
    for publisher, goal in zip(publishers, goals, strict=True):
        publisher.publish(Float64MultiArray(data=[goal, 0.0, 0.0, 0.0]))
    for _ in range(2):  # Whoever heard somebody else's command would not be there the second time.
        for each, goal in zip(states, goals, strict=True):
            each.clear()
            each.wait_until(
                lambda m, g=goal: bool(m) and abs(m[-1].position[0] - g) < 0.005, f"j0 is at {goal}"
            )
    for client in clients:
        assert client.node.count_publishers("/joint_states") == 1
        assert client.node.count_subscribers(topic) == 1
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domains[0])}
    nodes = run_python("-m", "arm_cli", "node", "list", env=environment)
    assert nodes.stdout.splitlines().count("/controller_manager") == 1, nodes.stdout
    # Nothing was said of a second node of a name, which would stop the later launch.
    for launched in worlds:
        launched.process.send_signal(signal.SIGINT)
    assert [launched.wait() for launched in worlds] == [0] * WORLDS
