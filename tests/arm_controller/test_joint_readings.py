"""Joint states are kept by name, never by index."""

from arm_controller.joint_readings import JointReading, JointReadings


def test_the_order_of_a_message_does_not_matter():
    readings = JointReadings()
    readings.update(["j1", "j0"], [1.0, 0.0], [11.0, 10.0], [21.0, 20.0])
    assert readings.get("j0") == JointReading(0.0, 10.0, 20.0)
    assert readings.get("j1") == JointReading(1.0, 11.0, 21.0)


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


def test_a_joint_without_velocity_and_effort_is_told_so():
    readings = JointReadings()
    readings.update(["j0"], [0.25])
    assert str(readings.get("j0")) == "Position: 0.250000 Velocity: unknown Effort: unknown"


def test_a_full_reading_shows_all_three_figures():
    text = str(JointReading(0.4, -0.01, 1.5))
    assert text == "Position: 0.400000 Velocity: -0.010000 Effort: 1.500000"


def test_a_joint_never_heard_of_has_no_reading():
    assert JointReadings().get("j0") is None
