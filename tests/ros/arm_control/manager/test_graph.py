"""Nodes, topics and messages of the controller manager and the broadcaster."""

from itertools import pairwise
from typing import Any

import pytest
from control_msgs.msg import DynamicJointState
from controller_manager_msgs.msg import ControllerManagerActivity
from lifecycle_msgs.msg import TransitionEvent
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState

BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"
JOINTS = ("j0", "j1", "j2", "j3")

BEST_EFFORT, STRICT = 1, 2


def end_points(client: Any, topic: str, kind: str) -> list[Any]:
    return getattr(client.node, f"get_{kind}_info_by_topic")(topic)


@pytest.mark.parametrize(
    ("topic", "kind", "node", "type_", "reliability", "durability"),
    [
        row.split()
        for row in (
            "/joint_states publishers joint_state_broadcaster"
            " sensor_msgs/msg/JointState RELIABLE TRANSIENT_LOCAL",
            "/dynamic_joint_states publishers joint_state_broadcaster"
            " control_msgs/msg/DynamicJointState RELIABLE TRANSIENT_LOCAL",
            "/joint_state_broadcaster/transition_event publishers joint_state_broadcaster"
            " lifecycle_msgs/msg/TransitionEvent RELIABLE VOLATILE",
            "/position_controller/commands subscriptions position_controller"
            " std_msgs/msg/Float64MultiArray BEST_EFFORT VOLATILE",
            "/position_controller/transition_event publishers position_controller"
            " lifecycle_msgs/msg/TransitionEvent RELIABLE VOLATILE",
            "/controller_manager/activity publishers controller_manager"
            " controller_manager_msgs/msg/ControllerManagerActivity RELIABLE TRANSIENT_LOCAL",
            "/robot_description subscriptions controller_manager"
            " std_msgs/msg/String RELIABLE TRANSIENT_LOCAL",
        )
    ],
    ids=lambda value: value if value.startswith("/") else "",
)
def test_end_points_are_those_of_a_real_one(
    control, client, topic, kind, node, type_, reliability, durability
):
    control.start("joint_state_broadcaster", "position_controller")
    # The name of its node arrives later than the end point.
    client.wait_until(
        lambda: [e.node_name for e in end_points(client, topic, kind)] == [node],
        f"{kind} of {topic}",
    )
    (end_point,) = end_points(client, topic, kind)
    assert end_point.topic_type == type_
    assert end_point.qos_profile.reliability.name == reliability
    assert end_point.qos_profile.durability.name == durability


def test_there_is_a_node_for_each_controller_and_component(control, client):
    control.start("joint_state_broadcaster")
    expected = {"controller_manager", "joint_state_broadcaster", "hardwareinterface"}
    client.wait_until(lambda: expected <= set(client.node.get_node_names()), f"nodes {expected}")
    assert [client.node.get_node_names().count(name) for name in expected] == [1, 1, 1]


def test_controllers_have_no_life_cycle_services(control, client):
    control.start("joint_state_broadcaster")
    client.wait_until(lambda: "joint_state_broadcaster" in client.node.get_node_names(), "the node")
    services = client.node.get_service_names_and_types_by_node("joint_state_broadcaster", "/")
    assert not [name for name, types in services if "lifecycle_msgs" in types[0]]


def test_unload_takes_the_node_away(control, client):
    control.load("position_controller")
    client.wait_until(lambda: "position_controller" in client.node.get_node_names(), "the node")
    control.unload("position_controller")
    client.wait_until(
        lambda: "position_controller" not in client.node.get_node_names(), "the node's end"
    )
    assert "controller_manager" in client.node.get_node_names()


@pytest.fixture
def latched():
    """Return the profile of a subscriber that wants the last message, too."""
    return QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_a_late_listener_learns_the_activity(control, client, latched):
    control.start("position_controller")
    activity = client.subscribe(ControllerManagerActivity, "/controller_manager/activity", latched)

    def wait_for(label: str) -> Any:
        # What is latched may be told anew a moment after the answer of the switch.
        wanted = [("position_controller", label)]
        return activity.wait_until(
            lambda m: m and [(c.name, c.state.label) for c in m[-1].controllers] == wanted,
            f"the controller {label}",
        )[-1]

    message = wait_for("active")
    assert [(c.name, c.state.id) for c in message.hardware_components] == [("HardwareInterface", 3)]
    control.switch([], ["position_controller"])
    wait_for("inactive")


def test_transitions_are_published(control, client):
    control.load("position_controller")
    events = client.subscribe(TransitionEvent, "/position_controller/transition_event")
    client.wait_until(
        lambda: end_points(client, "/position_controller/transition_event", "publishers"),
        "the publisher",
    )
    # Which of the first events a subscriber sees depends on when it is matched: let it see one.
    while not events.messages:
        assert control.configure("position_controller")
    control.switch(["position_controller"])
    expected = [("inactive", "activating"), ("activating", "active")]
    events.wait_until(
        lambda m: [(e.start_state.label, e.goal_state.label) for e in m[-2:]] == expected,
        f"the events {expected}",
    )


# Joint states


def test_joint_states_are_complete_and_in_order(control, client):
    control.start("joint_state_broadcaster")
    messages = client.subscribe(JointState, "/joint_states").wait_for(3)
    for message in messages:
        assert message.name == list(JOINTS)
        assert message.header.frame_id == "base_link"
        assert len(message.position) == len(message.velocity) == len(message.effort) == 4
    dynamic = client.subscribe(DynamicJointState, "/dynamic_joint_states").wait_for(1)[0]
    assert dynamic.header.frame_id == "base_link"
    assert dynamic.joint_names == list(JOINTS)
    assert [list(v.interface_names) for v in dynamic.interface_values] == [
        ["position", "velocity", "effort"]
    ] * 4


def test_stamps_are_one_period_apart(control, client):
    control.start("joint_state_broadcaster")
    messages = client.subscribe(JointState, "/joint_states").wait_for(20)
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages]
    steps = {b - a for a, b in pairwise(stamps)}
    assert all(step > 0 and step % 10_000_000 == 0 for step in steps)


def test_a_late_subscriber_gets_the_last_state_while_paused(control, client, manager, latched):
    control.start("joint_state_broadcaster")
    client.subscribe(JointState, "/joint_states").wait_for(1)
    manager.tell("pause")
    try:
        late = client.subscribe(JointState, "/joint_states", latched)
        assert late.wait_for(1)[0].name == list(JOINTS)
    finally:
        manager.tell("resume")


def test_topics_can_be_local(control, client, run_manager):
    parameters = {
        "/**/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}},
        "/**/jsb": {"ros__parameters": {"use_local_topics": True}},
    }
    run_manager("--start", "jsb", parameters=parameters, ros_arguments=("-r", "__ns:=/left"))
    (message, *_) = client.subscribe(JointState, "/left/jsb/joint_states").wait_for(1)
    assert sorted(message.name) == ["j0", "j1", "j2", "j3"]
    assert client.node.count_publishers("/left/joint_states") == 0
