"""Recording by a process beside the page, with a script in its place."""

import sys
import time

import pytest

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.recorder import ENDED_EARLY, Recorder

TIMEOUT_S = 60.0
SCRIPT = """
import pathlib, signal, sys, time
folder = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
folder.mkdir()
(folder / "bag_0.mcap").write_bytes(bytes(1000))
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    print("Listening for topics...", file=sys.stderr, flush=True)
    print("3 messages were dropped (7 in all)", file=sys.stderr, flush=True)
    while True:
        time.sleep(0.05)
except KeyboardInterrupt:
    print("Recording stopped", "5 messages of 2 topics", sep="\\n", file=sys.stderr)
"""


@pytest.fixture
def recorder(tmp_path):
    recorder = Recorder(tmp_path, (sys.executable, "-c", SCRIPT))
    yield recorder
    recorder.close()


def until(condition):
    deadline_s = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline_s
        time.sleep(0.01)


def test_size_and_drops_are_told_while_it_records(recorder, tmp_path):
    assert not recorder.state.is_recording
    recorder.start(())
    until(lambda: recorder.state.dropped == 7)
    state = recorder.state
    assert (state.is_recording, state.is_starting) == (True, False)
    assert (state.size_bytes, state.said) == (1000, "")
    assert state.path.parent == tmp_path
    with pytest.raises(PageRecordingError, match="stop it first"):
        recorder.start(())
    recorder.stop()
    until(lambda: not recorder.state.is_recording)
    assert recorder.state.said == "5 messages of 2 topics."
    with pytest.raises(PageRecordingError, match="no recording is running"):
        recorder.stop()


def test_a_run_is_recorded_by_the_simulation_into_a_file(tmp_path):
    script = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    print("recording to", sys.argv[-1], flush=True)
    while True:
        time.sleep(0.05)
except KeyboardInterrupt:
    print(*sys.argv[1:3], sys.argv[-1].endswith(".run"))
"""
    recorder = Recorder(tmp_path, (sys.executable, "-c", script))
    recorder.start_run()
    until(lambda: not recorder.state.is_starting)
    recorder.stop()
    until(lambda: not recorder.state.is_recording)
    assert recorder.state.said == "sim record True."


def test_a_recorder_that_fails_says_why(tmp_path):
    words = (sys.executable, "-c", "import sys; sys.exit('the disk is full')")
    recorder = Recorder(tmp_path, words)
    recorder.start(("/joint_states",))
    until(lambda: not recorder.state.is_recording)
    assert recorder.state.said == "the disk is full."


def test_a_recording_that_is_stopped_before_it_begins_says_so(tmp_path):
    recorder = Recorder(tmp_path, ("sh", "-c", "exec sleep 600"))
    recorder.start(())
    assert recorder.state.is_starting
    recorder.stop()
    until(lambda: not recorder.state.is_recording)
    assert recorder.state.said == ENDED_EARLY


def test_what_is_not_a_topic_never_becomes_an_option(recorder):
    with pytest.raises(PageRecordingError, match="'--all' is not a topic's name"):
        recorder.start(("/a", "--all"))
    assert not recorder.state.is_recording


def test_a_program_that_cannot_be_started_is_named(tmp_path):
    with pytest.raises(PageRecordingError, match="cannot start /no/such"):
        Recorder(tmp_path, ("/no/such",)).start(())


def test_closing_waits_for_the_bag(recorder):
    recorder.start(("/a",))
    until(lambda: recorder.state.dropped)
    recorder.close()
    until(lambda: not recorder.state.is_recording)
    assert recorder.state.dropped
