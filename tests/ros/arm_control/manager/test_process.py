"""A manager's process: namespaces, failures, the end."""

from itertools import pairwise

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


def test_all_of_it_can_live_in_a_namespace(run_manager, control_of, client):
    program = run_manager(
        parameters={
            "/right/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}},
            "/right/jsb": {"ros__parameters": {"frame_id": "there"}},
        },
        ros_arguments=("-r", "__ns:=/right", "-r", "__node:=host"),
    )
    control_of("/right").start("jsb")
    message = client.subscribe(JointState, "/right/joint_states").wait_for(1)[0]
    assert message.header.frame_id == "there"
    nodes = {(name, "/right") for name in ("jsb", "controller_manager", "hardwareinterface")}
    client.wait_until(
        lambda: nodes <= set(client.node.get_node_names_and_namespaces()), f"the nodes {nodes}"
    )
    assert program.stop() == 0


@pytest.mark.parametrize("paused", [(), ("--paused",)])
def test_it_ends_with_code_0(run_manager, paused):
    program = run_manager(
        *paused,
        "--start",
        "jsb",
        parameters={"/**/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/ending"),
    )
    assert program.stop() == 0
    assert "Traceback" not in program.output


def test_commands_are_kept_within_the_limits_of_the_description(run_manager, control_of, client):
    types = {
        "jsb.type": BROADCASTER,
        "mover.type": "position_controllers/JointGroupPositionController",
    }
    run_manager(
        "--start",
        "jsb",
        "mover",
        parameters={
            "/**/controller_manager": {
                "ros__parameters": {"enforce_command_limits": True, **types}
            },
            "/**/mover": {"ros__parameters": {"joints": ["j0", "j1"]}},
        },
        ros_arguments=("-r", "__ns:=/limited"),
    )
    states = client.subscribe(JointState, "/limited/joint_states", 1000)
    client.publisher(Float64MultiArray, "/limited/mover/commands").publish(
        Float64MultiArray(data=[9.0, -0.5])
    )
    messages = states.wait_until(
        lambda messages: messages and messages[-1].position[0] >= 3.0, "j0 at its upper limit"
    )
    assert messages[-1].position[:2].tolist() == pytest.approx([3.0, -0.5])
    # 2 rad/s at 100 Hz; a message that was lost on the way lets a step look longer.
    path = [(m.header.stamp.sec + m.header.stamp.nanosec * 1e-9, m.position[0]) for m in messages]
    assert all(b[1] - a[1] <= 2.0 * (b[0] - a[0]) + 1e-6 for a, b in pairwise(path))
