"""robot_state_publisher and time: its throttle, stamps of no time, and time that is set back."""

import pytest
from tf2_msgs.msg import TFMessage

NODE = "robot_state_publisher"


def seconds(stamp) -> float:
    return stamp.sec + stamp.nanosec * 1e-9


def stamps(collector) -> list[float]:
    return [round(seconds(m.transforms[0].header.stamp), 6) for m in collector.messages]


def test_stamps_may_be_ignored(tf, send):
    _, collector = tf(ignore_timestamp=True)
    for stamp in (1.0, 1.0, 0.0):
        send(stamp, turn=0.0)
    collector.wait_for(3)
    assert stamps(collector) == [1.0, 1.0, 0.0]


def test_the_frequency_changes_at_once(tf, send, set_parameters):
    _, collector = tf(publish_frequency=1)
    send(1.0, turn=0.0)
    collector.wait_for(1)
    assert set_parameters(NODE, publish_frequency=100.0) == ""
    send(1.01, turn=0.0)
    collector.wait_for(2)
    assert stamps(collector) == [1.0, 1.01]


def test_a_frequency_out_of_range_is_refused(tf, set_parameters):
    tf()
    reason = "Parameter publish_frequency out of range Min: 0.0, Max: 1000.0, value: 1001.0"
    assert set_parameters(NODE, publish_frequency=1001.0) == reason
    assert set_parameters(NODE, publish_frequency=20).startswith("Wrong parameter type")


def test_time_that_is_set_back_starts_again(client, tf, send, latched, set_parameters):
    node, collector = tf(use_sim_time=True)
    static = client.subscribe(TFMessage, "/tf_static", latched)

    def node_time_s(prefix: str) -> float:
        # The node stamps its static transforms with its own time.
        assert set_parameters(NODE, frame_prefix=prefix) == ""
        sent = static.wait_until(
            lambda m: bool(m) and m[-1].transforms[0].child_frame_id.startswith(prefix), prefix
        )
        return seconds(sent[-1].transforms[0].header.stamp)

    send(10.0, turn=0.0)
    collector.wait_for(1)
    assert node_time_s("a/") == 10.0
    for stamp in (5.0, 5.01, 5.02):
        send(stamp, turn=0.0)
    node.wait_for_line("Moved backwards in time, re-publishing joint transforms!")
    collector.wait_for(2)
    assert stamps(collector) == [10.0, 5.02]
    assert node_time_s("b/") == 5.02


def test_a_short_loop_goes_on_moving_and_is_told_once(tf, send):
    node, collector = tf(use_sim_time=True)
    # The third message of each later pass tells that time was set back.
    for heard in (4, 6, 8):
        for stamp in (20.0, 20.1, 20.2, 20.3):
            send(stamp, turn=0.0)
        collector.wait_for(heard)
    assert stamps(collector) == [20.0, 20.1, 20.2, 20.3, 20.2, 20.3, 20.2, 20.3]
    node.wait_for_line("Moved backwards in time")
    assert node.output.count("Moved backwards in time") == 1


@pytest.mark.parametrize("stamp", [0.0, -5.0])
def test_a_second_publisher_with_no_time_in_its_stamps_changes_nothing(tf, send, stamp):
    node, collector = tf(use_sim_time=True)
    send(10.0, turn=0.0)
    collector.wait_for(1)
    for n in range(1, 4):
        for time in (stamp, 10.0 + 0.05 * n - 0.01, stamp, 10.0 + 0.05 * n):
            send(time, turn=0.0)
        collector.wait_for(n + 1)
    assert stamps(collector) == [10.0, 10.05, 10.1, 10.15]
    assert "Moved backwards" not in node.output


def test_negative_stamps_are_told_once(tf, send):
    node, collector = tf(use_sim_time=True)
    for _ in range(20):
        send(-5.0, turn=0.0)
    send(1.0, turn=0.0)
    collector.wait_for(1)
    node.wait_for_line("ignored a JointState about turn: its stamp, -5 s, is negative")
    assert stamps(collector) == [1.0]
    assert len(node.own_words) == 1


def test_a_frequency_next_to_zero_leaves_the_node_settable(tf, send, set_parameters):
    _, collector = tf()
    assert set_parameters(NODE, publish_frequency=5e-324) == ""
    assert set_parameters(NODE, publish_frequency=20.0) == ""
    send(1.0, turn=0.0)
    collector.wait_for(1)
