"""Joint states are kept by name, never by index; silence is reported once."""

from arm_controller.joint_states import PATIENCE_S, JointReadings, LastJointState, SilenceWatch


def test_the_order_of_a_message_does_not_matter():
    readings = JointReadings()
    readings.update(["j1", "j0"], [1.0, 0.0], [11.0, 10.0], [21.0, 20.0])
    assert readings.get("j0") == LastJointState(0.0, 10.0, 20.0)
    assert readings.get("j1") == LastJointState(1.0, 11.0, 21.0)


def test_messages_of_several_sources_complete_each_other():
    readings = JointReadings()
    readings.update(["j0", "j1"], [0.0, 1.0])
    readings.update(["grip"], [5.0])
    readings.update(["j1"], [1.5])
    assert readings.positions == {"j0": 0.0, "j1": 1.5, "grip": 5.0}
    assert readings.names == ("j0", "j1", "grip")


def test_a_message_with_fewer_positions_than_names_is_left_out():
    readings = JointReadings()
    assert not readings.update(["j0", "j1"], [0.0])
    assert readings.names == ()


def test_missing_velocity_and_effort_are_printed_as_unknown():
    readings = JointReadings()
    readings.update(["j0"], [0.25])
    reading = readings.get("j0")
    assert reading is not None
    assert reading.figures() == {
        "position": "0.250000",
        "velocity": "unknown",
        "effort": "unknown",
    }


def test_a_full_reading_shows_all_three_figures():
    assert LastJointState(0.4, -0.01, 1.5).figures() == {
        "position": "0.400000",
        "velocity": "-0.010000",
        "effort": "1.500000",
    }


def test_an_unknown_joint_has_no_reading():
    assert JointReadings().get("j0") is None


def test_a_long_silence_is_detected_once():
    watch = SilenceWatch(now_s=100.0)
    assert not watch.notices(100.0 + PATIENCE_S - 0.1)
    assert watch.notices(100.0 + PATIENCE_S)
    assert not watch.notices(200.0)


def test_every_message_restarts_the_wait():
    watch = SilenceWatch(now_s=0.0)
    watch.hear(4.0)
    assert not watch.notices(4.0 + PATIENCE_S - 0.1)


def test_the_next_silence_is_detected_again():
    watch = SilenceWatch(now_s=0.0)
    assert watch.notices(10.0)
    watch.hear(11.0)
    assert watch.notices(11.0 + PATIENCE_S)
