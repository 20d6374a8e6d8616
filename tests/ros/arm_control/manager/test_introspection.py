"""The topics ~/introspection_data and ~/statistics of a controller manager."""

from typing import Any

import pytest
from pal_statistics_msgs.msg import Statistics, StatisticsNames, StatisticsValues
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float64MultiArray

JOINTS = ("j0", "j1", "j2", "j3")


@pytest.fixture
def latched():
    """Return the profile of a subscriber that wants the last message, too."""
    return QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize("prefix", ["introspection_data", "statistics"])
def test_end_points_are_those_of_a_real_one(manager, client, prefix):
    found = {}
    for name in ("full", "names", "values"):
        topic = f"/controller_manager/{prefix}/{name}"
        client.wait_until(lambda t=topic: client.node.get_publishers_info_by_topic(t), topic)
        (end_point,) = client.node.get_publishers_info_by_topic(topic)
        qos = end_point.qos_profile
        found[name] = (end_point.topic_type, qos.reliability.name, qos.durability.name)
    package = "pal_statistics_msgs/msg"
    assert found == {
        "full": (f"{package}/Statistics", "RELIABLE", "VOLATILE"),
        "names": (f"{package}/StatisticsNames", "RELIABLE", "TRANSIENT_LOCAL"),
        "values": (f"{package}/StatisticsValues", "RELIABLE", "VOLATILE"),
    }


def test_the_values_of_all_interfaces_go_by_their_names(control, client, latched):
    control.start("position_controller")
    topic = "/controller_manager/introspection_data"
    values = client.subscribe(StatisticsValues, f"{topic}/values")
    names = client.subscribe(StatisticsNames, f"{topic}/names", latched)
    full = client.subscribe(Statistics, f"{topic}/full")
    wanted = [f"command_interface.{joint}/position" for joint in JOINTS]
    publisher = client.publisher(Float64MultiArray, "/position_controller/commands")
    publisher.publish(Float64MultiArray(data=[0.1, 0.2, 0.3, 0.4]))

    def commands_of(message: Any) -> list[float]:
        shown = {item.name: item.value for item in message.statistics}
        return [shown[name] for name in wanted]

    last = full.wait_until(
        lambda messages: messages and commands_of(messages[-1]) == [0.1, 0.2, 0.3, 0.4],
        "the command",
    )[-1]
    (listed,) = names.wait_for(1)
    assert [item.name for item in last.statistics] == list(listed.names)
    message = values.wait_for(1)[-1]
    assert message.names_version == listed.names_version == 1
    assert len(message.values) == len(listed.names)
    assert {f"state_interface.{joint}/position" for joint in JOINTS} <= set(listed.names)


def test_statistics_follow_what_is_loaded(control, client, latched):
    topic = "/controller_manager/statistics"
    names = client.subscribe(StatisticsNames, f"{topic}/names", latched)
    # What the test before had loaded may still be on its way out.
    before = names.wait_for(1)[-1]
    assert "controller_manager.total_time" in before.names
    assert "HardwareInterface.stats/read_cycle/execution_time/average" in before.names
    assert control.load("position_controller")
    added = "position_controller.stats/periodicity/current_value"
    after = names.wait_until(
        lambda messages: added in messages[-1].names, "figures of the controller"
    )[-1]
    assert after.names_version > before.names_version


def test_each_message_is_later_than_the_previous_one(control, client):
    values = client.subscribe(StatisticsValues, "/controller_manager/introspection_data/values")
    values.wait_for(3)
    stamps = [(m.header.stamp.sec, m.header.stamp.nanosec) for m in values.messages]
    assert stamps == sorted(set(stamps))
