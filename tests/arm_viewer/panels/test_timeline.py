"""What the timeline shows, and what its buttons become."""

import numpy as np
import pytest
from fake_channel import FakeChannel

from arm_viewer.errors import BrowserMessageError, PageRecordingError
from arm_viewer.panels.timeline import TimelinePanel, curve_fields, timeline_fields
from arm_viewer.recordings.curve import WholeCurve
from arm_viewer.recordings.marks import Mark
from arm_viewer.recordings.open_recording import PlayerState, ShownCurve
from arm_viewer.recordings.playback import Playback
from arm_viewer.recordings.recorder import RecorderState
from arm_viewer.snapshot import Snapshot


class FakePlayer:
    """Does as it is told."""

    problem = ""
    refusals = 0

    def __init__(self):
        self.state = PlayerState()
        self.playback = Playback(10.0)
        self.marks = ()
        self.did = []

    def open(self, path):
        self.did.append(("open", path))

    def close(self):
        self.did.append(("close",))

    def act(self, change):
        change(self.playback)

    def show_curve(self, topic, number):
        raise PageRecordingError(f"no {number} of {topic}")

    def set_marks(self, change):
        self.marks = change(self.marks)


class FakeRecorder:
    """Records nothing."""

    def __init__(self, folder):
        self.folder = folder
        self.state = RecorderState()
        self.did = []

    def start(self, topics):
        self.did.append(topics)

    def stop(self):
        raise PageRecordingError("no recording is running")


@pytest.fixture
def page(tmp_path):
    channel, player, recorder = FakeChannel(), FakePlayer(), FakeRecorder(tmp_path)
    panel = TimelinePanel(channel, player, recorder)
    panel.build(None)
    panel.update(Snapshot())
    return channel, player, recorder, panel


def test_only_what_has_changed_is_sent(page):
    channel, player, _, panel = page
    assert channel.kept["timeline"]["name"] == ""
    assert channel.kept.keys() == set(channel.kinds)
    channel.sent.clear()
    panel.update(Snapshot())
    assert channel.sent == []
    player.state = PlayerState(name="bag", length_s=10.0, time_s=2.5)
    panel.update(Snapshot())
    assert channel.kinds == ["timeline_moment", "timeline"]
    channel.sent.clear()
    player.state = PlayerState(name="bag", length_s=10.0, time_s=3.0)
    panel.update(Snapshot())
    assert channel.kinds == ["timeline_moment"]


def test_a_curve_is_sent_once_it_is_read(page):
    channel, player, _, panel = page
    curve = WholeCurve(np.array([1.0, np.nan]), np.array([2.0, np.nan]), 3)
    for shown in (ShownCurve("/a", "x"), ShownCurve("/a", "x", curve)):
        player.state = PlayerState(name="bag", curve=shown)
        panel.update(Snapshot())
    assert channel.kinds.count("timeline_curve") == 3
    assert channel.kept["timeline_curve"] == curve_fields(player.state.curve)
    assert channel.kept["timeline_curve"]["low"] == [1.0, None]


def test_the_buttons_play_seek_and_change_the_speed(page):
    channel, player, _, _ = page
    channel.take("timeline", do="seek", time_s=4.0)
    channel.take("timeline", do="speed", factor=2.0)
    channel.take("timeline", do="play")
    assert player.playback == Playback(10.0, 4.0, True, 2.0)
    channel.take("timeline", do="pause")
    channel.take("timeline", do="live")
    assert (player.playback.is_playing, player.did) == (False, [("close",)])


def test_a_recording_is_opened_only_by_a_name_of_the_list(page, tmp_path):
    channel, player, _, _ = page
    (tmp_path / "a.mcap").write_bytes(b"x")
    channel.take("recordings")
    assert [row[0] for row in channel.kept["recordings"]["found"]] == ["a.mcap"]
    channel.take("timeline", do="open", name="a.mcap")
    assert player.did == [("open", tmp_path / "a.mcap")]
    with pytest.raises(BrowserMessageError, match="there is no recording"):
        channel.take("timeline", do="open", name="/etc/passwd")


def test_a_mark_replaces_the_one_at_its_moment(page):
    channel, player, _, _ = page
    channel.take("timeline", do="mark", time_s=1.0, text=" first ")
    channel.take("timeline", do="mark", time_s=2.0, text="")
    channel.take("timeline", do="mark", time_s=1.0, text="again")
    assert set(player.marks) == {Mark(1.0, "again"), Mark(2.0, "")}
    channel.take("timeline", do="unmark", time_s=2.0)
    assert player.marks == (Mark(1.0, "again"),)


def test_the_recorder_takes_a_list_of_topics(page):
    channel, _, recorder, _ = page
    channel.take("record", do="start", topics=["/a", "/b"])
    channel.take("record", do="start", topics=[])
    assert recorder.did == [("/a", "/b"), ()]
    with pytest.raises(BrowserMessageError, match="no recording is running"):
        channel.take("record", do="stop")


@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("timeline", {"do": "seek", "time_s": "1"}),
        ("timeline", {"do": "seek", "time_s": float("nan")}),
        ("timeline", {"do": "speed", "factor": 0.0}),
        ("timeline", {"do": "curve", "topic": "/a", "number": "x"}),
        ("timeline", {"do": "erase"}),
        ("timeline", {}),
        ("record", {"do": "start", "topics": "/a"}),
        ("record", {"do": "start", "topics": [1]}),
        ("record", {"do": "start", "topics": ["/a"] * 1000}),
        ("record", {"do": "pause"}),
    ],
)
def test_a_forged_message_is_answered_with_a_sentence(page, kind, fields):
    with pytest.raises(BrowserMessageError):
        page[0].take(kind, **fields)


def test_what_was_refused_is_counted_for_the_banner():
    fields = timeline_fields(PlayerState(name="bag", began_ns=2_000_000_000), "damaged", 3)
    assert (fields["refusals"], fields["problem"], fields["began_s"]) == (3, "damaged", 2.0)
