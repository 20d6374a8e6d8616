"""The history of joints, and the rows that the charts draw."""

import math
from dataclasses import replace
from unittest.mock import MagicMock

import numpy as np
import pytest

from arm_description.urdf.parser import parse_urdf
from arm_viewer.panels.plot_panel import JointHistory, PlotPanel, Quantity, interpolated, span_row
from arm_viewer.snapshot import Description, JointReading, JointStates, Snapshot

GRIPPER = """<robot name='r'><link name='palm'/><link name='left'/><link name='right'/>
  <joint name='a' type='continuous'><parent link='palm'/><child link='left'/></joint>
  <joint name='b' type='continuous'><parent link='palm'/><child link='right'/>
    <mimic joint='a'/></joint></robot>"""


def reading(position, velocity=0.0, effort=math.nan):
    return JointReading(position, velocity, effort)


def test_times_are_ages_and_columns_are_joints():
    history = JointHistory(window_s=10.0)
    history.add(100.0, {"j0": reading(1.0), "j1": reading(2.0)}, {})
    history.add(100.1, {"j0": reading(1.5), "j1": reading(2.5)}, {})
    ages, readings, commands = history.table(Quantity.POSITION, now_s=101.0)
    assert history.joints == ("j0", "j1")
    np.testing.assert_allclose(ages, [-1.0, -0.9])
    np.testing.assert_allclose(readings, [[1.0, 1.5], [2.0, 2.5]])
    assert np.isnan(commands).all()


@pytest.mark.parametrize("quantity", Quantity)
def test_each_quantity_has_its_own_values_and_commands(quantity):
    history = JointHistory(window_s=10.0)
    values = {"position": 1.0, "velocity": 2.0, "effort": 3.0}
    commands = {f"j0/{name}": 10.0 * value for name, value in values.items()}
    history.add(1.0, {"j0": JointReading(**values)}, commands)
    _, readings, told = history.table(quantity, now_s=1.0)
    assert readings.item() == values[quantity.value]
    assert told.item() == 10.0 * values[quantity.value]


def test_what_is_older_than_the_window_is_forgotten():
    history = JointHistory(window_s=1.0)
    for time_s in np.arange(0.0, 3.01, 0.25):
        history.add(time_s, {"j0": reading(time_s)}, {})
    ages, readings, _ = history.table(Quantity.POSITION, now_s=3.0)
    assert ages.min() == -1.0
    assert readings.min() == 2.0


def test_there_is_no_line_across_a_gap():
    history = JointHistory(window_s=10.0)
    history.add(1.0, {"j0": reading(1.0)}, {})
    history.add(4.0, {"j0": reading(2.0)}, {})
    _, readings, _ = history.table(Quantity.POSITION, now_s=4.0)
    np.testing.assert_array_equal(readings, [[1.0, math.nan, 2.0]])


def test_other_joints_restart_the_history():
    history = JointHistory(window_s=10.0)
    history.add(1.0, {"j0": reading(1.0)}, {})
    history.add(1.1, {"left_j0": reading(5.0)}, {})
    ages, readings, _ = history.table(Quantity.POSITION, now_s=1.1)
    assert history.joints == ("left_j0",)
    assert ages.tolist() == [0.0]
    assert readings.tolist() == [[5.0]]


def test_an_empty_history_has_no_times():
    ages, readings, commands = JointHistory(window_s=1.0).table(Quantity.EFFORT, now_s=0.0)
    assert ages.size == readings.size == commands.size == 0


def test_an_infinity_is_taken_for_nothing():
    history = JointHistory(10.0)
    history.add(0.0, {"j": JointReading(math.inf, 1.0, -math.inf)}, {"j/position": math.inf})
    _, readings, commands = history.table(Quantity.POSITION, 0.0)
    assert np.isnan(readings).all()
    assert np.isnan(commands).all()


def test_missing_values_are_interpolated():
    ages = np.array([-4.0, -3.0, -1.0, 0.0])
    rows = np.array([[1.0, math.nan, math.nan, 5.0], [math.nan, 2.0, 3.0, math.nan]])
    np.testing.assert_allclose(
        interpolated(ages, rows), [[1.0, 2.0, 4.0, 5.0], [2.0, 2.0, 3.0, 3.0]]
    )


def test_a_row_of_nothing_stays_one():
    assert np.isnan(interpolated(np.array([-1.0, 0.0]), np.full((1, 2), math.nan))).all()


def test_a_chart_of_joints_at_rest_is_not_all_noise():
    resting = np.array([[1.0, 1.0001, 0.9999, 1.0], [1.2, 1.2, 1.2, 1.2]])
    np.testing.assert_allclose(span_row(resting, 0.5), [0.84995, 1.34995, 0.84995, 1.34995])


def test_a_chart_of_joints_that_move_is_as_high_as_they_go():
    np.testing.assert_allclose(span_row(np.array([[-1.0, 2.0, 0.0]]), 0.5), [-1.0, 2.0, -1.0])


def test_a_long_history_keeps_its_window():
    history = JointHistory(window_s=1.0)
    for k in range(1000):
        history.add(0.01 * k, {"j0": reading(k), "j1": reading(-k)}, {})
    ages, readings, _ = history.table(Quantity.POSITION, now_s=9.99)
    np.testing.assert_allclose(ages, np.arange(-1.0, 0.001, 0.01), atol=1e-9)
    np.testing.assert_array_equal(readings, [np.arange(899, 1000), -np.arange(899, 1000)])


def test_nothing_is_drawn_without_a_browser_nor_what_follows_another_joint():
    watched, gui = [], MagicMock()
    panel = PlotPanel(lambda: bool(watched))
    gui.add_dropdown.return_value = MagicMock(value="/joint_states", options=("/joint_states",))
    gui.add_checkbox.return_value = MagicMock(value=False)
    panel.build(gui)
    robot = parse_urdf(GRIPPER)
    states = JointStates({"a": reading(1.0), "b": reading(1.0)}, received_s=1.0)
    snapshot = Snapshot(
        made_s=1.0,
        descriptions={"/robot_description": Description("/robot_description", "", robot)},
        joint_states={"/joint_states": states},
    )
    legend = gui.add_html.return_value
    legend.content = ""
    panel.update(snapshot)
    assert legend.content == ""
    watched.append("a browser")
    panel.update(replace(snapshot, made_s=2.0))
    assert "</span> a</span>" in legend.content
    assert "</span> b</span>" not in legend.content
