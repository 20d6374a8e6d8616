"""Live or recorded: what the page sees, and what reaches a robot."""

import time
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.curve import NumberPlace
from arm_viewer.recordings.marks import Mark, read_marks
from arm_viewer.recordings.playback import Playback
from arm_viewer.recordings.player import Player
from arm_viewer.recordings.run_check import MAGIC, PROFILE, EqualPart, RunVerdict
from arm_viewer.requests import (
    AddFile,
    LookAtThing,
    MoveJoints,
    RemoveThing,
    SetEmergencyStop,
    SetPlaying,
    ShowContacts,
    ShowPictures,
)
from arm_viewer.snapshot import Snapshot
from arm_viewer.world.dropped_file import DroppedFile

TIMEOUT_S = 60.0
LIVE = Snapshot(made_s=1.0, stops=MappingProxyType({"": True}))
MOVE = MoveJoints("", {"j0": 1.0})


class Reader:
    """Says which moment was asked for as the refusal of the snapshot."""

    def __init__(self, recording):
        self._recording = recording
        self.asked = []

    def at(self, time_ns, now_s, speed, wanted):
        if time_ns == 13:
            raise PageRecordingError("damaged here")
        return Snapshot(
            now_s, "a.mcap", refusal=f"{time_ns}", image_topics=tuple(sorted(wanted.pictures))
        )

    def reread(self):
        self.asked.append("reread")

    def numbers(self):
        pattern = np.frombuffer(b"12345678", dtype=np.uint8)
        return {("/a", "x"): NumberPlace(0, pattern, np.zeros(8, dtype=bool))}


@pytest.fixture
def sent():
    return []


@pytest.fixture
def player(sent):
    player = Player(lambda: LIVE, sent.append, Reader)
    yield player
    player.close()


@pytest.fixture
def file(write_mcap):
    return write_mcap([("/a", 0, b"12345678"), ("/a", 10_000_000_000, b"12345678")])


def until(condition):
    deadline_s = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline_s
        time.sleep(0.005)


def shows(player, moment_ns):
    return lambda: player.latest().refusal == str(moment_ns)


def test_live_everything_reaches_the_robot(player, sent):
    player.send(MOVE)
    assert player.latest() is LIVE
    assert (sent, player.state.name) == ([MOVE], "")


def test_a_recording_shows_the_moment_and_the_live_emergency_stop(player, file):
    player.open(file)
    until(shows(player, 0))
    player.act(lambda playback: playback.seek(2.5))
    until(shows(player, 2_500_000_000))
    assert player.latest().replay == "a.mcap"
    assert player.latest().stops == LIVE.stops


def test_nothing_but_the_emergency_stop_reaches_a_robot(player, file, sent):
    player.open(file)
    for request in (MOVE, SetPlaying(True), ShowContacts(True), SetEmergencyStop(True)):
        player.send(request)
    things = (RemoveThing("box"), AddFile(DroppedFile("a.stl", b"x"), RigidTransform()))
    for request in (*things, LookAtThing("box")):
        player.send(request)
    assert sent == [ShowContacts(True), SetEmergencyStop(True), LookAtThing("box")]
    assert player.refusals == 4
    player.close()
    player.send(MOVE)
    assert sent[-1] == MOVE


def test_back_to_live(player, file):
    player.open(file)
    until(shows(player, 0))
    player.close()
    assert player.latest() is LIVE
    with pytest.raises(PageRecordingError, match="no recording is open"):
        player.act(Playback.play)


def test_it_plays_to_the_end(player, file):
    player.open(file)
    player.act(lambda playback: (playback.seek(9.5), playback.set_speed(10.0), playback.play()))
    until(shows(player, 10_000_000_000))
    assert not player.state.is_playing


def test_shown_seconds_go_on_with_the_recording_and_stand_with_it(player, file):
    player.open(file)
    until(shows(player, 0))
    player.act(lambda playback: playback.seek(4.0))
    until(shows(player, 4_000_000_000))
    first_s = player.latest().made_s
    player.send(ShowPictures(frozenset({"/camera"})))
    until(lambda: player.latest().image_topics == ("/camera",))
    assert player.latest().made_s == first_s
    player.act(lambda playback: playback.seek(1.0))
    until(shows(player, 1_000_000_000))
    # A jump, also one back, is a gap in the charts.
    assert player.latest().made_s > first_s + 10.0


def test_pictures_that_were_wanted_live_are_wanted_of_the_recording(player, file, sent):
    player.send(ShowPictures(frozenset({"/camera"})))
    player.open(file)
    until(lambda: player.latest().image_topics == ("/camera",))
    assert sent == [ShowPictures(frozenset({"/camera"}))]


def test_damage_ends_the_replay_with_a_sentence(player, file):
    player.open(file)
    player.act(lambda playback: playback.seek(13e-9))
    until(lambda: player.problem)
    assert player.problem == "damaged here"


def test_the_first_number_has_a_curve(player, file):
    player.open(file)
    until(lambda: player.state.curve is not None and player.state.curve.curve is not None)
    assert player.state.numbers == (("/a", "x"),)
    with pytest.raises(PageRecordingError, match="has no number 'y'"):
        player.show_curve("/a", "y")


def test_marks_are_written(player, file):
    player.open(file)
    player.set_marks(lambda marks: (*marks, Mark(2.0, "here")))
    assert player.state.marks == read_marks(file) == (Mark(2.0, "here"),)


def test_a_file_that_cannot_be_read_leaves_what_is_shown(player, file, tmp_path):
    player.open(file)
    with pytest.raises(PageRecordingError, match="there is no recording"):
        player.open(tmp_path / "gone.mcap")
    assert player.state.name == "a.mcap"


class Check:
    """Has as much to show as a test says."""

    verdict = RunVerdict("a.run", length_s=40.0)

    def __init__(self, path, changed):
        self._changed = changed
        self.is_closed = False
        self.part = EqualPart()

    def show(self, *files, until_s=10.0, grows=True):
        self.part = EqualPart(files, until_s, grows)
        self._changed(self)

    def fail(self, why):
        self.verdict = replace(self.verdict, text=why)

    def close(self):
        self.is_closed = True
        return "a.run: stopped"


@pytest.fixture
def checks():
    return []


@pytest.fixture
def run_player(sent, checks):
    def check_run(path, changed):
        checks.append(Check(path, changed))
        return checks[-1]

    player = Player(lambda: LIVE, sent.append, Reader, check_run)
    yield player
    player.close()


@pytest.fixture
def run_file(tmp_path):
    path = tmp_path / "a.run"
    path.write_bytes(MAGIC + bytes(13) + PROFILE)
    return path


def test_a_run_is_shown_once_a_part_of_it_is_equal_and_until_then_the_page_is_live(
    run_player, checks, run_file, file, sent
):
    run_player.open(run_file)
    run_player.send(MOVE)
    assert (run_player.state.name, run_player.state.run) == ("", Check.verdict)
    assert (run_player.latest(), sent) == (LIVE, [MOVE])
    checks[0].show(file)
    until(shows(run_player, 0))
    assert (run_player.state.name, run_player.state.run) == ("a.run", Check.verdict)
    run_player.send(MOVE)
    assert (sent, run_player.refusals) == ([MOVE], 1)
    run_player.set_marks(lambda marks: (Mark(2.0, "here"),))
    assert read_marks(run_file) == (Mark(2.0, "here"),)
    run_player.close()
    assert checks[0].is_closed
    assert (run_player.state.run, run_player.state.stopped) == (None, "a.run: stopped")


def test_a_run_is_shown_as_far_as_it_is_equal_and_further_when_there_is_more(
    run_player, checks, run_file, file, write_mcap
):
    more = write_mcap([("/a", 20_000_000_000, b"12345678")], name="more.mcap")
    run_player.open(run_file)
    checks[0].show(file)
    until(shows(run_player, 0))
    run_player.act(lambda playback: playback.seek(39.0))
    until(shows(run_player, 10_000_000_000))
    assert (run_player.state.open_s, run_player.state.length_s) == (10.0, 40.0)
    until(lambda: run_player.state.curve is not None and run_player.state.curve.curve is not None)
    before = run_player.state.curve.curve
    assert np.flatnonzero(~np.isnan(before.low)).tolist() == [0, 250], "columns of the whole run"
    checks[0].show(file, more, until_s=20.0, grows=False)
    until(lambda: run_player.state.curve.curve is not before)
    assert np.flatnonzero(~np.isnan(run_player.state.curve.curve.low)).tolist() == [0, 250, 500]
    run_player.act(lambda playback: playback.seek(39.0))
    until(shows(run_player, 20_000_000_000))


def test_a_part_that_cannot_be_read_says_so(run_player, checks, run_file, tmp_path):
    (tmp_path / "bad.mcap").write_bytes(b"no recording")
    run_player.open(run_file)
    checks[0].show(tmp_path / "bad.mcap")
    assert (run_player.state.name, run_player.latest()) == ("", LIVE)
    assert "bad.mcap cannot be read" in run_player.state.run.text


def test_a_run_that_is_left_is_not_shown_any_more(run_player, checks, run_file, file):
    run_player.open(run_file)
    run_player.open(file)
    until(shows(run_player, 0))
    checks[0].show(file)
    assert run_player.state.run is None
    assert run_player.state.name == "a.mcap"


def test_a_run_that_cannot_run_again_leaves_the_page_live(run_player, checks, run_file):
    run_player.open(run_file)
    checks[0].show(grows=False)
    assert run_player.latest() is LIVE
    assert run_player.state.run is not None
