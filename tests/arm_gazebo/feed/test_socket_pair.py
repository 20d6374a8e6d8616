"""The sockets between simulation and camera process."""

import gc
import os

import numpy as np
import pytest

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraEnd, CameraProgress, FeedEnd, ModelMessage


def snapshot(time_s: float = 0.0, positions: int = 4) -> CameraSnapshot:
    due = (FrameDue(0, 0, 0),)
    qpos, no_positions, no_quaternions = np.zeros(positions), np.zeros((0, 3)), np.zeros((0, 4))
    return CameraSnapshot(1, time_s, due, qpos, no_positions, no_quaternions)


@pytest.fixture
def feed():
    end = FeedEnd()
    yield end
    end.close()


@pytest.fixture
def camera(feed):
    end = CameraEnd(os.dup(feed.remote_fd))
    yield end
    end.close()


@pytest.fixture
def memory_file():
    file = os.memfd_create("test")
    os.write(file, b"content")
    yield file
    os.close(file)


def open_files() -> int:
    gc.collect()  # Nothing of earlier tests is closed between two counts.
    return len(os.listdir("/proc/self/fd"))


def test_snapshots_arrive_in_order(feed, camera):
    for time_s in (0.1, 0.2, 0.3):
        assert feed.send_snapshot(snapshot(time_s))
    assert [message.time_s for message in camera.receive()] == [0.1, 0.2, 0.3]


def test_a_model_arrives_as_a_separate_file(feed, camera, memory_file):
    assert feed.send_model(7, memory_file)
    (message,) = camera.receive()
    assert isinstance(message, ModelMessage)
    assert message.version == 7
    assert message.file != memory_file
    assert os.pread(message.file, 100, 0) == b"content"
    os.close(message.file)


def test_waiting_for_nothing_gives_nothing(camera):
    assert camera.receive() == []


def test_a_full_connection_refuses_and_does_not_wait(feed, camera):
    sent = 0
    while feed.send_snapshot(snapshot(sent, positions=1000)):
        sent += 1
    assert sent >= 10
    assert not feed.send_snapshot(snapshot())
    assert len(camera.receive()) == sent


def test_discarding_makes_room_and_leaves_no_files_open(feed, memory_file):
    before = open_files()
    assert feed.send_model(1, memory_file)
    while feed.send_snapshot(snapshot(positions=1000)):
        pass
    feed.discard_unread()
    assert feed.send_snapshot(snapshot(positions=1000))
    assert open_files() == before


def test_nothing_to_read_after_discarding_is_not_the_end(feed, camera):
    feed.send_snapshot(snapshot())
    feed.discard_unread()
    assert camera.receive() == []


def test_the_end_is_read_after_the_last_message(feed, camera):
    feed.send_snapshot(snapshot())
    feed.shut_down()
    assert len(camera.receive()) == 1
    assert camera.receive() is None


def test_sending_after_the_end_is_refused(feed):
    feed.shut_down()
    assert not feed.send_snapshot(snapshot())
    feed.close()
    assert not feed.send_snapshot(snapshot())


def test_backends_are_announced_to_the_simulation(feed, camera):
    camera.tell_backend("egl")
    camera.tell_backend("osmesa")
    assert feed.answers().backends == ["egl", "osmesa"]
    assert feed.answers().backends == []


def test_the_latest_progress_of_each_camera_arrives(feed, camera):
    camera.tell_progress([CameraProgress(0, 1, 0), CameraProgress()])
    camera.tell_progress([CameraProgress(7, 5, 2), CameraProgress(3, 0, 1)])
    feed.wait_for_answers(30.0)
    assert feed.answers().progress == (CameraProgress(7, 5, 2), CameraProgress(3, 0, 1))
    assert feed.answers().progress == ()


def test_the_largest_message_fits(feed, camera):
    positions = (feed.largest_message - 4096) // 8
    assert feed.send_snapshot(snapshot(positions=positions))
    (message,) = camera.receive()
    assert message.qpos.size == positions


def test_a_descriptor_that_is_not_a_socket_is_refused(memory_file):
    file = os.dup(memory_file)
    with pytest.raises(CameraError, match=f"descriptor {file} is not a simulation's socket"):
        CameraEnd(file)
    os.close(file)
