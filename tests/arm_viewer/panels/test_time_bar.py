"""What the time bar shows, what it makes impossible, and which requests its buttons become."""

import math

import pytest
from fake_channel import FakeChannel

from arm_viewer.channel import Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.time_bar import TimeBar, bar_fields, clock_fields, free_name, run_request
from arm_viewer.requests import ResetRun, SetPlaying, SetSpeed, SnapshotDeed, StepRun, UseSnapshot
from arm_viewer.snapshot import ControlAnswer, NamedSnapshot, RunStatus, SimulationTime, Snapshot

NOW_S = 100.0
SAVED = NamedSnapshot("before", "1.000 s in the world empty")


def snapshot(state="playing", speed=1.0, factor=1.0, lag_s=0.0, heard_s=NOW_S, **more):
    return Snapshot(
        made_s=NOW_S,
        run=RunStatus(state, speed, more.pop("snapshots", ())),
        time=SimulationTime(12.25, factor, lag_s, heard_s),
        **more,
    )


def impossible(snapshot):
    return {name for name, reason in bar_fields(snapshot, NOW_S)["reasons"].items() if reason}


def test_a_running_simulation_can_be_paused_but_not_stepped():
    assert bar_fields(snapshot(), NOW_S)["state"] == "playing"
    assert impossible(snapshot()) == {"step", "restore", "stop", "release"}


def test_a_paused_simulation_takes_steps():
    assert impossible(snapshot("paused", snapshots=(SAVED,), stops={"": False})) == {"release"}


def test_without_a_simulation_everything_says_why():
    reasons = bar_fields(Snapshot(made_s=NOW_S), NOW_S)["reasons"]
    assert reasons["play"] == "No simulation: time cannot be paused"
    assert all(reasons.values())


def test_a_recording_is_no_simulation_that_could_be_played_or_paused():
    replayed = Snapshot(made_s=0.0, replay="bag", stops={"": False}, time=snapshot().time)
    fields = bar_fields(replayed, NOW_S)
    assert (fields["state"], fields["stale"], fields["reasons"]["stop"]) == ("recording", False, "")
    assert fields["reasons"]["play"] == "This is a recording: go back to live first"
    assert clock_fields(replayed, NOW_S + 60.0)["silent_s"] is None


def test_a_driver_without_a_simulation_can_be_stopped():
    driver = Snapshot(made_s=NOW_S, stops={"/left": True, "/right": False})
    fields = bar_fields(driver, NOW_S)
    assert fields["stopped"] == ["/left"]
    assert not fields["reasons"]["stop"]
    assert not fields["reasons"]["release"]
    assert fields["reasons"]["play"]


def test_a_world_that_is_unloaded_cannot_play():
    assert {"play", "reset", "save"} <= impossible(snapshot("no world"))


def test_a_speed_that_is_not_known_yet_is_not_shown():
    fields = bar_fields(snapshot(speed=math.nan), NOW_S)
    assert fields["speed"] is None
    assert fields["reasons"]["speed"]


def test_what_the_node_has_not_renewed_for_two_seconds_is_stale():
    assert not bar_fields(snapshot(), NOW_S + 1.9)["stale"]
    assert bar_fields(snapshot(), NOW_S + 2.1)["stale"]


def test_lag_is_shown_while_real_time_is_wanted_and_missed():
    assert clock_fields(snapshot(lag_s=0.5), NOW_S)["lag_s"] == 0.5
    assert clock_fields(snapshot(lag_s=0.01), NOW_S)["lag_s"] is None
    assert clock_fields(snapshot(speed=0.5, lag_s=5.0), NOW_S)["lag_s"] is None


def test_a_pause_has_neither_factor_nor_lag_nor_silence():
    shown = clock_fields(snapshot("paused", lag_s=5.0, heard_s=0.0), NOW_S)
    assert shown == {"time_s": 12.25, "factor": None, "lag_s": None, "silent_s": None}


def test_a_clock_that_falls_silent_while_it_should_run_is_told():
    assert clock_fields(snapshot(heard_s=NOW_S - 1.0), NOW_S)["silent_s"] is None
    assert clock_fields(snapshot(heard_s=NOW_S - 5.0), NOW_S)["silent_s"] == 5


def test_the_first_free_name_is_proposed():
    assert free_name({}) == "snapshot-1"
    assert free_name({"snapshot-1": None, "snapshot-3": None}) == "snapshot-2"


@pytest.mark.parametrize(
    ("fields", "request_"),
    [
        ({"do": "play"}, SetPlaying(True)),
        ({"do": "pause"}, SetPlaying(False)),
        ({"do": "step", "count": 100}, StepRun(100)),
        ({"do": "speed", "factor": 0}, SetSpeed(0.0)),
        ({"do": "reset", "keeps_clock": True}, ResetRun(True)),
        ({"do": "save", "name": ""}, UseSnapshot(SnapshotDeed.SAVE, "snapshot-1")),
        ({"do": "save", "name": " a_b-1.2 "}, UseSnapshot(SnapshotDeed.SAVE, "a_b-1.2")),
        ({"do": "restore", "name": "before"}, UseSnapshot(SnapshotDeed.RESTORE, "before")),
        ({"do": "remove", "name": "before"}, UseSnapshot(SnapshotDeed.REMOVE, "before")),
    ],
)
def test_a_button_becomes_a_request(fields, request_):
    assert run_request(Message("run", fields), snapshot()) == request_


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({}, "'do' of 'run' is not a text"),
        ({"do": "explode"}, "does not have 'explode'"),
        ({"do": "step", "count": 0}, "'count' goes from 1 to 10000, not 0"),
        ({"do": "step"}, "'count' of 'run' is not a finite number"),
        ({"do": "speed", "factor": -1}, "'factor' goes from 0 to 1000"),
        ({"do": "reset", "keeps_clock": 1}, "neither true nor false"),
        ({"do": "restore", "name": ""}, "'' is not a name"),
        # Each of these would be a file of the simulation's machine.
        ({"do": "save", "name": "/etc/passwd"}, "is not a name"),
        ({"do": "save", "name": "x.snapshot"}, "is not a name"),
        ({"do": "remove", "name": "../x"}, "is not a name"),
    ],
)
def test_anything_else_is_refused_with_a_sentence(fields, problem):
    with pytest.raises(BrowserMessageError, match=problem.replace("(", r"\(")):
        run_request(Message("run", fields), snapshot())


def test_only_what_has_changed_is_sent():
    listener = FakeChannel()
    bar = TimeBar(listener, send=lambda request: None)
    bar.update(snapshot())
    bar.update(snapshot())
    assert listener.kinds == ["time_bar", "clock"]
    bar.update(snapshot("paused", control_answer=ControlAnswer(1, "no", False)))
    assert listener.sent[2][0] == "time_bar"
    assert listener.sent[2][1]["answer"] == {"number": 1, "text": "no", "done": False}


def test_nothing_is_sent_without_a_browser_and_the_next_one_gets_everything():
    listener = FakeChannel()
    bar = TimeBar(listener, send=lambda request: None)
    bar.update(snapshot())
    listener.is_used = False
    listener.sent.clear()
    bar.update(snapshot("paused"))
    assert not listener.sent
    listener.is_used = True
    bar.update(snapshot("paused"))
    assert listener.kinds == ["time_bar", "clock"]
