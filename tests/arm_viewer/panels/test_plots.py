"""What browsers get of the curves that they draw."""

import struct

import numpy as np
import pytest
from fake_channel import FakeChannel

from arm_description.urdf.parser import parse_urdf
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.plots import PlotFeed, joint_curves
from arm_viewer.plots.history import Curves
from arm_viewer.requests import ListNumbers, PlotCurves
from arm_viewer.snapshot import (
    Description,
    JointReading,
    JointStates,
    ListedController,
    Snapshot,
    Topic,
)

NAN = float("nan")
NAME = "/joint_states.position[a]"
GRIPPER = """<robot name='r'><link name='palm'/><link name='left'/><link name='right'/>
  <joint name='a' type='prismatic'><parent link='palm'/><child link='left'/>
    <limit lower='0' upper='1' effort='1' velocity='1'/></joint>
  <joint name='b' type='continuous'><parent link='palm'/><child link='right'/>
    <mimic joint='a'/></joint></robot>"""


class Listener(FakeChannel):
    """A channel whose browser reads curves."""

    def values(self, number=7):
        """Return all values of a curve that came, and forget them."""
        found = []
        for payload in self.frames:
            at = 8
            while at < len(payload):
                count, curves = struct.unpack_from("<2I", payload, at)
                numbers = struct.unpack_from(f"<{curves}I", payload, at + 8)
                at += 8 + 4 * curves + 4 * count
                rows = np.frombuffer(payload, "<f4", count * curves, at).reshape(curves, count)
                at += rows.nbytes
                found += rows[numbers.index(number)].tolist() if number in numbers else []
        self.frames.clear()
        return found


@pytest.fixture
def listener():
    return Listener()


@pytest.fixture
def feed(listener, monkeypatch):
    """Return a feed in which each update is due; its requests are in `sent`."""
    monkeypatch.setattr("arm_viewer.panels.plots.PERIOD_S", 0.0)
    feed = PlotFeed(listener, lambda request: listener.sent.append(request))
    feed.build(None)
    assert not listener.changing
    return feed


def test_a_browser_gets_what_there_is_and_then_what_is_new(feed, listener):
    curves = Curves()
    curves.append(np.array([1.0, 2.0]), {NAME: np.array([0.5, 0.75])})
    listener.take("plot_add", name=NAME, number=7)
    feed.update(Snapshot(curves=curves))
    assert PlotCurves(frozenset({NAME})) in listener.sent
    assert listener.values() == [0.5, 0.75]
    curves.append(np.array([3.0]), {NAME: np.array([1.0])})
    feed.update(Snapshot(curves=curves))
    assert listener.values() == [1.0]
    listener.take("plot_remove", number=7)
    curves.append(np.array([4.0]), {NAME: np.array([1.0])})
    feed.update(Snapshot(curves=curves))
    assert listener.values() == []


def test_a_browser_that_lags_behind_misses_nothing(feed, listener):
    curves = Curves()
    listener.take("plot_add", name=NAME, number=7)
    listener.keeps_up = False
    curves.append(np.array([1.0]), {NAME: np.array([5.0])})
    feed.update(Snapshot(curves=curves))
    listener.keeps_up = True
    curves.append(np.array([2.0]), {NAME: np.array([6.0])})
    feed.update(Snapshot(curves=curves))
    assert listener.values() == [5.0, 6.0]


def test_a_long_history_is_sent_thinned_but_with_its_peak(feed, listener):
    curves = Curves()
    values = np.zeros(60_000)
    values[12_345] = 9.0
    curves.append(0.002 * np.arange(60_000), {NAME: values})
    listener.take("plot_add", name=NAME, number=7)
    feed.update(Snapshot(curves=curves))
    sent = listener.values()
    assert len(sent) < 9000
    assert max(sent) == 9.0


def test_curves_of_a_topic_share_their_times(feed, listener):
    curves = Curves()
    names = [f"/joint_states.position[{k}]" for k in range(8)]
    for number, name in enumerate(names):
        listener.take("plot_add", name=name, number=number)
    times = 0.002 * np.arange(500)
    curves.append(times, dict.fromkeys(names, times))
    feed.update(Snapshot(curves=curves))
    # A second of eight curves at 500 Hz.
    assert len(listener.frames[0]) < 18_100
    np.testing.assert_allclose(listener.values(7), times, rtol=1e-6)


def test_another_run_replaces_the_curves(feed, listener):
    before, after = Curves(), Curves()
    before.append(np.array([10.0]), {NAME: np.array([1.0])})
    after.append(np.array([5.0]), {NAME: np.array([2.0])})
    listener.take("plot_add", name=NAME, number=7)
    feed.update(Snapshot(curves=before))
    assert ("plot_restart", {}) not in listener.sent
    feed.update(Snapshot(curves=after))
    assert ("plot_restart", {}) in listener.sent
    assert listener.values() == [1.0, 2.0]


def test_a_browser_that_leaves_gets_nothing_more(feed, listener):
    curves = Curves()
    curves.append(np.array([1.0]), {NAME: np.array([1.0])})
    listener.take("plot_add", name=NAME, number=7)
    listener.is_connected = False
    feed.update(Snapshot(curves=curves))
    assert listener.values() == []


def test_whoever_asks_is_told_the_numbers_with_units(feed, listener):
    listener.take("plot_numbers")
    assert ListNumbers() in listener.sent
    feed.update(Snapshot(numbers={"/pose": ("pose.position.x", "pose.orientation.w"), "/x": ()}))
    told = {"topics": {"/pose": [["pose.position.x", "m"], ["pose.orientation.w", ""]]}}
    assert ("plot_numbers", told) in listener.sent


@pytest.mark.parametrize("fields", [{"number": 1}, {"name": "x", "number": 1}, {"name": NAME}])
def test_anything_but_a_curve_is_refused(feed, listener, fields):
    with pytest.raises(BrowserMessageError):
        listener.take("plot_add", **fields)


def test_the_curves_of_the_joints_are_those_of_states_and_commands():
    trajectory = ListedController("/cm", "arm", "jtc", "active", ("a/position", "a/velocity"), ())
    snapshot = Snapshot(
        descriptions={
            "/robot_description": Description("/robot_description", "", parse_urdf(GRIPPER))
        },
        joint_states={
            "/joint_states": JointStates(
                {"a": JointReading(1.0, NAN, 2.0), "b": JointReading(1.0, NAN, NAN)}, 0.0
            )
        },
        controllers=(trajectory,),
        topics=(Topic("/arm/controller_state", ("t",), 1, 0, NAN),),
    )
    (robot,) = joint_curves(snapshot)["robots"]
    (joint,) = robot["joints"]
    assert (joint["name"], joint["slides"]) == ("a", True)
    reference = "/arm/controller_state.reference"
    assert joint["curves"] == {
        "position": ["/joint_states.position[a]", f"{reference}.positions[a]", False, "m"],
        "velocity": ["/joint_states.velocity[a]", f"{reference}.velocities[a]", False, "m/s"],
        "effort": ["/joint_states.effort[a]", None, False, "N"],
    }


def test_a_command_to_a_group_of_joints_holds():
    group = ListedController("/cm", "group", "jgpc", "active", ("b/position", "a/position"), ())
    snapshot = Snapshot(
        joint_states={"/joint_states": JointStates({"a": JointReading(1.0, NAN, NAN)}, 0.0)},
        controllers=(group,),
        topics=(Topic("/group/commands", ("t",), 0, 1, NAN),),
    )
    (robot,) = joint_curves(snapshot)["robots"]
    assert robot["joints"][0]["curves"]["position"][1:3] == ["/group/commands.data[1]", True]
