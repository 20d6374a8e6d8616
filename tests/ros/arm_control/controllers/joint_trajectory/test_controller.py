"""Topics, service and parameters of the joint trajectory controller."""

from collections.abc import Callable
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from control_msgs.msg import SpeedScalingFactor
from control_msgs.srv import QueryTrajectoryState
from rclpy.qos import qos_profile_sensor_data
from trajectory_msgs.msg import JointTrajectory

NAME = "joint_trajectory_controller"
JOINTS = ["j0", "j1", "j2", "j3"]
HERE = (0.0, 0.0, 0.0, 0.0)
THERE = (0.1, 0.2, 0.3, 0.4)
ACTION = f"/{NAME}/follow_joint_trajectory/_action"


@pytest.fixture
def loaded(control):
    """Configure the controller, and leave it inactive."""
    assert control.load(NAME)
    assert control.configure(NAME)
    return control


@pytest.fixture
def query(client) -> Callable[[float], Any]:
    """Return a function that asks for the state at a time."""

    def ask(time_s: float) -> Any:
        seconds, nanoseconds = divmod(round(time_s * 1e9), 1_000_000_000)
        request = QueryTrajectoryState.Request(time=Time(sec=seconds, nanosec=nanoseconds))
        return client.call(QueryTrajectoryState, f"/{NAME}/query_state", request)

    return ask


def time_of(message: Any) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


@pytest.mark.parametrize(
    ("topic", "kind", "type_", "reliability", "durability"),
    [
        row.split()
        for row in (
            f"/{NAME}/controller_state publishers"
            " control_msgs/msg/JointTrajectoryControllerState RELIABLE TRANSIENT_LOCAL",
            f"{ACTION}/feedback publishers"
            " control_msgs/action/FollowJointTrajectory_FeedbackMessage RELIABLE VOLATILE",
            f"{ACTION}/status publishers action_msgs/msg/GoalStatusArray RELIABLE TRANSIENT_LOCAL",
            f"/{NAME}/joint_trajectory subscriptions"
            " trajectory_msgs/msg/JointTrajectory BEST_EFFORT VOLATILE",
            f"/{NAME}/speed_scaling_input subscriptions"
            " control_msgs/msg/SpeedScalingFactor BEST_EFFORT TRANSIENT_LOCAL",
        )
    ],
    ids=lambda value: value if value.startswith("/") else "",
)
def test_end_points_of_an_inactive_one_are_those_of_a_real_one(
    loaded, client, topic, kind, type_, reliability, durability
):
    read = getattr(client.node, f"get_{kind}_info_by_topic")
    # The name of its node arrives later than the end point.
    client.wait_until(lambda: [e.node_name for e in read(topic)] == [NAME], f"{kind} of {topic}")
    (end_point,) = read(topic)
    assert end_point.topic_type == type_
    assert end_point.qos_profile.reliability.name == reliability
    assert end_point.qos_profile.durability.name == durability


def test_its_services_are_those_of_a_real_one(loaded, client):
    expected = {
        f"{ACTION}/cancel_goal": ["action_msgs/srv/CancelGoal"],
        f"{ACTION}/get_result": ["control_msgs/action/FollowJointTrajectory_GetResult"],
        f"{ACTION}/send_goal": ["control_msgs/action/FollowJointTrajectory_SendGoal"],
        f"/{NAME}/query_state": ["control_msgs/srv/QueryTrajectoryState"],
    }

    def services() -> dict[str, list[str]]:
        if NAME not in client.node.get_node_names():
            return {}
        return dict(client.node.get_service_names_and_types_by_node(NAME, "/"))

    found = client.wait_until(
        lambda: services() if expected.keys() <= services().keys() else None, "its services"
    )
    assert {name: found[name] for name in expected} == expected


def test_end_points_go_with_the_cleanup(loaded, client):
    topics = [f"/{NAME}/joint_trajectory", f"{ACTION}/status", f"/{NAME}/controller_state"]

    def count() -> int:
        node = client.node
        return sum(node.count_publishers(t) + node.count_subscribers(t) for t in topics)

    client.wait_until(lambda: count() == 3, "the end points")
    assert loaded.call("cleanup_controller", name=NAME).ok
    client.wait_until(lambda: count() == 0, "no end points")


def test_the_state_is_published_in_every_cycle(active, states):
    messages = states.wait_for(20)[-10:]
    assert list(messages[0].joint_names) == JOINTS
    assert messages[0].speed_scaling_factor == 1.0
    times_s = [time_of(message) for message in messages]
    assert times_s == pytest.approx([times_s[0] + 0.01 * i for i in range(10)])


def test_the_state_has_what_is_wanted_measured_and_commanded(active, send, states):
    states.wait_for(1)  # Matched: the first state at the goal will not be missed.
    send((0.1, THERE)).result()

    def arrivals(messages: Any) -> list[Any]:
        return [m for m in messages if list(m.feedback.positions) == list(THERE)]

    message = arrivals(states.wait_until(arrivals, "the arm is there"))[0]
    assert list(message.reference.positions) == list(THERE)
    assert list(message.reference.velocities) == [0.0] * 4
    assert list(message.reference.accelerations) == [0.0] * 4
    assert len(message.feedback.velocities) == 4
    assert list(message.error.positions) == [0.0] * 4
    assert list(message.output.positions) == list(THERE)
    assert not message.output.velocities
    parts = (message.reference, message.feedback)
    assert [part.time_from_start.nanosec for part in parts] == [pytest.approx(100_000_000)] * 2


def test_a_late_subscriber_gets_the_last_state_of_an_inactive_one(active, send, request):
    send((0.1, THERE)).result()  # stopped sooner, it might never have been updated
    assert active.switch([], [NAME]).ok
    assert request.getfixturevalue("states").wait_for(1)


def test_a_trajectory_on_the_topic_is_followed(active, client, trajectory, states):
    publisher = client.publisher(JointTrajectory, f"/{NAME}/joint_trajectory")
    publisher.publish(trajectory((0.1, THERE)))
    states.wait_until(
        lambda messages: messages and list(messages[-1].feedback.positions) == list(THERE),
        "the arm is there",
    )
    hasty = client.publisher(JointTrajectory, f"/{NAME}/joint_trajectory", qos_profile_sensor_data)
    hasty.publish(trajectory((0.1, HERE)))
    followed = states.wait_until(
        lambda messages: messages and list(messages[-1].feedback.positions) == list(HERE),
        "a best-effort one",
    )
    assert list(followed[-1].error.positions) == [0.0] * len(HERE)


def test_a_faulty_trajectory_on_the_topic_is_dropped_with_the_reason(
    active, client, trajectory, manager
):
    publisher = client.publisher(JointTrajectory, f"/{NAME}/joint_trajectory")
    publisher.publish(trajectory((0.1, (1, 2, 3))))
    reason = "Mismatch between joint_names size (4) and positions (3) at point #0."
    assert reason in manager.wait_for_line(reason)


def test_query_state_returns_future_set_points(active, send, states, query):
    send((100.0, (100.0, 0.0, 0.0, 0.0)))
    (message, *_) = states.wait_until(
        lambda messages: messages and messages[-1].reference.velocities[0] > 0.0, "it moves"
    )[-1:]
    now, ahead = query(time_of(message)), query(time_of(message) + 10.0)
    assert now.success
    assert ahead.success
    assert list(ahead.name) == JOINTS
    assert ahead.position[0] - now.position[0] == pytest.approx(10.0, rel=1e-3)
    assert ahead.velocity[0] == pytest.approx(1.0, rel=1e-3)
    late = query(time_of(message) + 1000.0)
    assert not late.success
    assert "is after the end of the trajectory" in late.message
    assert list(late.position) == pytest.approx([100.0, 0.0, 0.0, 0.0])
    assert [list(late.velocity), list(late.acceleration)] == [[0.0] * 4] * 2


def test_query_state_answers_while_paused(active, states, query, manager):
    states.wait_for(1)
    manager.tell("pause")
    try:
        assert list(query(0.0).name) == JOINTS
    finally:
        manager.tell("resume")


def test_speed_scaling_stops_the_trajectory_and_lets_it_go_on(
    active, client, send, states, latched
):
    publisher = client.publisher(SpeedScalingFactor, f"/{NAME}/speed_scaling_input", latched)
    publisher.publish(SpeedScalingFactor(factor=0.0))
    states.wait_until(
        lambda messages: messages and messages[-1].speed_scaling_factor == 0.0, "standstill"
    )
    goal = send((0.1, THERE))
    states.clear()
    stands = states.wait_for(20)
    assert all(m.reference.positions == stands[0].reference.positions for m in stands)
    assert not goal.ended()
    publisher.publish(SpeedScalingFactor(factor=1.0))
    assert goal.result()[1] == 0


def test_a_tolerance_changes_while_it_is_active(active, send, set_parameter):
    with_a_jump = ((0.0, (9, 9, 9, 9)), (0.1, HERE))
    assert send(*with_a_jump).result()[1] == 0
    assert set_parameter(f"/{NAME}", "constraints.j0.trajectory", 0.01).successful
    assert send(*with_a_jump).result()[1] == -4


def test_parameters_cannot_change_while_the_loop_is_blocked(active, set_parameter, manager):
    manager.tell("block")
    try:
        result = set_parameter(f"/{NAME}", "cmd_timeout", 1.0)
    finally:
        manager.tell("unblock")
    assert not result.successful
    assert result.reason == "the control loop did not apply the change within 1 s"
