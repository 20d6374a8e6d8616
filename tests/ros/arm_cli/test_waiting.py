"""Verbs report what they wait for, and stop at their timeout."""

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from control_msgs.action import GripperCommand
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger

from arm_cli.main import main
from arm_cli.ros import session

ACTION = "control_msgs/action/GripperCommand"


@pytest.fixture
def arm(capfd) -> Callable[..., Any]:
    """Return a function that runs a verb in this process and returns its output."""

    def run(*words: str, code: int) -> Any:
        capfd.readouterr()
        assert main(list(words)) == code
        said = capfd.readouterr()
        # Fast DDS complains there, too, of shared memory of programs that were killed.
        lines = said.err.splitlines(keepends=True)
        own = [line for line in lines if "RTPS_TRANSPORT_SHM" not in line]
        return SimpleNamespace(out=said.out, err="".join(own))

    return run


@pytest.fixture
def notices_come_at_once(monkeypatch) -> None:
    """Let a command say early what it waits for: what it did before may have taken most of it."""
    monkeypatch.setattr(session, "NOTICE_AFTER_S", 0.1)


@pytest.fixture
def notices_come_late(monkeypatch) -> None:
    """Let a command say what it waits for when it has had time to discover the others."""
    monkeypatch.setattr(session, "NOTICE_AFTER_S", 2.9)


def test_a_missing_service(arm):
    said = arm("service", "call", "/no", "std_srvs/srv/Trigger", "--timeout", "1.5", code=1)
    waiting, gave_up = said.err.splitlines()
    assert waiting.startswith("waiting for service to become available... /no")
    assert gave_up == "arm service call: service /no has no server (waited 1.5 s)"


@pytest.mark.usefixtures("notices_come_at_once")
def test_a_service_that_does_not_answer(arm, client):
    # Nobody spins this node, which shares the client's context.
    silent = Node("silent", context=client.context)
    silent.create_service(Trigger, "/silent", lambda _, response: response)
    try:
        said = arm("service", "call", "/silent", "std_srvs/srv/Trigger", "--timeout", "4", code=1)
    finally:
        silent.destroy_node()
    assert said.err.splitlines()[-2:] == [
        "waiting for the answer of /silent...",
        "arm service call: no answer from /silent within 4 s",
    ]


@pytest.mark.usefixtures("notices_come_late")
def test_a_type_that_no_publisher_of_the_topic_has(arm, client):
    publisher = client.node.create_publisher(JointState, "/states", 10)
    try:
        words = ("topic", "echo", "/states", "std_msgs/msg/String", "--once", "--timeout", "3")
        said = arm(*words, code=1)
    finally:
        client.node.destroy_publisher(publisher)
    assert said.err.splitlines()[0] == (
        "waiting for a std_msgs/msg/String on /states; "
        "its publishers send sensor_msgs/msg/JointState"
    )


@pytest.mark.usefixtures("notices_come_late")
def test_messages_that_a_filter_refuses_are_not_silence(arm, client):
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = client.node.create_publisher(String, "/words", kept)
    publisher.publish(String(data="no"))
    try:
        line = ("topic", "echo", "/words", "--filter", "m.data == 'yes'", "--timeout", "5")
        said = arm(*line, code=1)
    finally:
        client.node.destroy_publisher(publisher)
    refused = "1 message on /words, but none for which --filter holds"
    assert said.err == f"{refused}\narm topic echo: {refused} within 5 s\n"


@pytest.mark.usefixtures("notices_come_late")
def test_silence_beside_another_user_is_explained(arm, client, monkeypatch):
    monkeypatch.setattr("arm_cli.ros.listeners.other_users", lambda domain: ["anna"])
    publisher = client.node.create_publisher(JointState, "/states", 10)
    try:
        said = arm("topic", "echo", "/states", "--once", "--timeout", "3", code=1)
    finally:
        client.node.destroy_publisher(publisher)
    notice = "waiting for a message on /states; user anna runs ROS programs in this ROS domain, too"
    assert said.err.startswith(notice)


@pytest.mark.usefixtures("notices_come_late")
def test_a_command_whose_port_was_removed_says_so(arm, client, monkeypatch):
    monkeypatch.setattr("arm_cli.ros.listeners.lost_ports", lambda: ["/dev/shm/fastrtps_port1"])
    publisher = client.node.create_publisher(JointState, "/states", 10)
    try:
        said = arm("topic", "echo", "/states", "--once", "--timeout", "3", code=1)
    finally:
        client.node.destroy_publisher(publisher)
    notice = "this command hears nothing, because another process removed /dev/shm/fastrtps_port1"
    assert said.err.startswith(notice)


def test_a_missing_action(arm):
    said = arm("action", "send_goal", "/no", ACTION, "--timeout", "0.2", code=1)
    assert said.err == "arm action send_goal: action /no has no server (waited 0.2 s)\n"


@pytest.fixture
def endless_action(client) -> Iterator[list[str]]:
    """An action that ends only by cancelling; yields the cancelled goals."""
    cancelled: list[str] = []

    async def execute(handle: Any) -> GripperCommand.Result:
        future = client.executor.create_task(lambda: None)
        while not handle.is_cancel_requested:
            await future
            future = client.executor.create_task(lambda: None)
        handle.canceled()
        cancelled.append("goal")
        return GripperCommand.Result()

    server = ActionServer(
        client.node,
        GripperCommand,
        "/endless",
        execute,
        callback_group=ReentrantCallbackGroup(),
        cancel_callback=lambda _: CancelResponse.ACCEPT,
    )
    yield cancelled
    client.run(server.destroy, "the end of the action")


@pytest.mark.usefixtures("notices_come_at_once")
def test_a_goal_is_cancelled_at_its_timeout(arm, client, endless_action):
    said = arm("action", "send_goal", "/endless", ACTION, "--timeout", "4", code=1)
    assert said.err.splitlines()[-2:] == [
        "waiting for the result of /endless...",
        "arm action send_goal: no result from /endless within 4 s",
    ]
    assert said.out.endswith("Canceling goal...\nGoal canceled.\n")
    client.wait_until(lambda: endless_action, "the goal cancelled")


def test_simulated_stamps_are_explained(client, start):
    publisher = client.node.create_publisher(JointState, "/joint_states", 10)
    state = JointState()
    state.header.stamp.sec = 12
    client.node.create_timer(0.05, lambda: publisher.publish(state))
    command = start("arm topic delay /joint_states")
    command.wait_for("average delay")
    command.interrupt()
    # On a busy machine it says, too, what it waits for.
    said = [line for line in command.err.splitlines(True) if not line.startswith("waiting for")]
    assert "".join(said) == (
        "the stamps of /joint_states are about 12 s after the start of a clock, not the time of "
        "day: use -s to measure the delay in simulation time (/clock)\n"
    )
