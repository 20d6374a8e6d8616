"""What the other parts of the dock show, and what is sent to whom."""

import math

import pytest
from fake_channel import FakeChannel

from arm_node.rigid_transform import RigidTransform
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.observations import Observations, diagnostic_rows, pose_fields
from arm_viewer.requests import MeasureRates
from arm_viewer.snapshot import ComponentStatus, LogEntry, Snapshot, Topic, Transform

QUARTER = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
TREE = {
    "arm": Transform("world", RigidTransform((1.0, 0.0, 0.0), QUARTER)),
    "hand": Transform("arm", RigidTransform((2.0, 0.0, 0.0))),
    "eye": Transform("arm", RigidTransform((0.0, 1.0, 0.0))),
    "moon": Transform("sky", RigidTransform()),
    "egg": Transform("hen", RigidTransform()),
    "hen": Transform("egg", RigidTransform()),
}


def test_the_pose_of_a_frame_in_another_goes_over_what_both_hang_on():
    assert pose_fields(TREE, "hand", "eye")["position"] == [2.0, -1.0, 0.0]
    in_world = pose_fields(TREE, "hand", "world")
    assert in_world["position"] == [1.0, 2.0, 0.0]
    assert in_world["rpy"] == [0.0, 0.0, round(math.pi / 2, 5)]
    assert pose_fields(TREE, "world", "hand")["position"] == [-2.0, 1.0, 0.0]


@pytest.mark.parametrize(
    ("frame", "within", "problem"),
    [
        ("hand", "moon", "'hand' and 'moon' are in different trees, below 'world' and 'sky'."),
        ("foot", "world", "There is no transform of 'foot' at present."),
        ("egg", "world", "There is no transform of 'egg' at present."),
    ],
)
def test_without_a_pose_a_sentence_says_why(frame, within, problem):
    assert pose_fields(TREE, frame, within) == {"problem": problem}


def test_a_component_that_falls_silent_is_stale():
    found = {
        "b": ComponentStatus(2, "hot", "", (), 100.0),
        "a": ComponentStatus(0, "", "", (), 94.0),
    }
    assert [(name, level) for name, level, *_ in diagnostic_rows(found, 100.0)] == [
        ("a", 3),
        ("b", 2),
    ]


class Listener(FakeChannel):
    """A channel whose browser asks for parts."""

    def __init__(self):
        super().__init__()
        self.requests = []

    def show(self, part, measures=False, frame="", within=""):
        fields = {"part": part, "measures": measures, "frame": frame, "within": within}
        self.take("show_part", **fields)

    def read(self):
        sent, self.sent = self.sent, []
        return sent


@pytest.fixture
def listener():
    return Listener()


@pytest.fixture
def parts(listener, monkeypatch):
    monkeypatch.setattr("arm_viewer.panels.observations.PERIOD_S", 0.0)
    parts = Observations(listener, listener.requests.append)
    parts.build(None)
    return parts


def entries(first, last):
    return tuple(LogEntry(k, 0.5, 20, "node", str(k), "") for k in range(first, last + 1))


def texts(messages):
    return [entry[3] for _, fields in messages for entry in fields["entries"]]


def test_a_browser_gets_the_log_and_then_what_is_new(parts, listener):
    listener.show("log")
    parts.update(Snapshot())
    assert listener.read() == [("log", {"entries": [], "restarts": True})]
    parts.update(Snapshot(log=entries(1, 3)))
    assert texts(listener.read()) == ["1", "2", "3"]
    # The oldest ones are forgotten meanwhile.
    parts.update(Snapshot(log=entries(3, 5)))
    assert texts(listener.read()) == ["4", "5"]
    parts.update(Snapshot(log=entries(3, 5)))
    assert listener.read() == []


def test_a_long_log_comes_in_several_messages(parts, listener):
    listener.show("log")
    parts.update(Snapshot(log=entries(1, 1200)))
    messages = listener.read()
    assert texts(messages) == [str(k) for k in range(1, 1201)]
    assert [fields["restarts"] for _, fields in messages] == [True, False, False]


def test_only_the_part_that_is_shown_is_sent_and_only_when_it_changes(parts, listener):
    topic = Topic("/a", ("t/msg/T",), 1, 2, 9.96, 1234.4, math.nan)
    snapshot = Snapshot(topics=(topic,), log=entries(1, 2), transforms=TREE)
    parts.update(snapshot)
    assert listener.read() == []
    listener.show("topics")
    parts.update(snapshot)
    parts.update(snapshot)
    row = ["/a", "t/msg/T", 1, 2, 10.0, 1234.0, None]
    assert listener.read() == [("topics", {"topics": [row]})]
    listener.show("frames", frame="hand", within="arm")
    parts.update(snapshot)
    ((kind, fields),) = listener.read()
    assert kind == "frames"
    assert fields["pose"]["position"] == [2.0, 0.0, 0.0]
    assert ["hand", "arm"] in fields["frames"]


def test_rates_are_measured_only_while_somebody_sees_them(parts, listener):
    listener.show("topics", measures=True)
    parts.update(Snapshot())
    listener.show("log", measures=True)
    parts.update(Snapshot())
    listener.show("topics", measures=True)
    parts.update(Snapshot())
    listener.is_connected = False
    parts.update(Snapshot())
    assert [request.wanted for request in listener.requests] == [True, False, True, False]
    assert MeasureRates(True) in listener.requests


def test_another_part_is_refused_with_a_sentence(parts, listener):
    with pytest.raises(BrowserMessageError, match="no part 'x'; there are log, diagnostics"):
        listener.show("x")
