"""States sent to child processes, which have a lower priority than the simulation."""

import gc
import os

import mujoco
import pytest

from arm_gazebo.feed.child_process import NICENESS, lower_priority
from arm_gazebo.feed.state_feed import StateFeed

MODEL = "<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"


class Reader:
    """A fake process."""

    def start(self, socket_fd: int) -> None:
        """Start nothing."""

    def start_again_due(self, _backends: object) -> bool:
        return False

    def end(self) -> None:
        """End nothing."""


@pytest.fixture
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(MODEL)


@pytest.fixture
def feed():
    made = StateFeed(Reader())
    yield made
    made.close()


def open_files() -> int:
    gc.collect()  # Nothing of earlier tests is closed between two counts.
    return len(os.listdir("/proc/self/fd"))


def test_one_model_after_another_keeps_one_file_open(feed, model):
    feed.set_model(model)
    before = open_files()
    for _ in range(5):
        feed.prepare(model).show()
    assert open_files() == before


def test_a_prepared_model_is_not_shown_before_show_is_called(feed, model):
    prepared = feed.prepare(model)
    assert not feed.flowing
    prepared.show()
    assert feed.flowing


def test_what_is_not_shown_leaves_nothing_behind(feed, model):
    before = open_files()
    feed.prepare(model).discard()
    prepared = feed.prepare(model)
    feed.close()
    closed = open_files()
    prepared.show()
    assert open_files() == closed - 1 < before


@pytest.mark.parametrize(("inherited", "niceness"), [(-20, NICENESS), (0, 5), (7, 12)])
def test_a_child_has_a_lower_priority_than_ordinary_processes(monkeypatch, inherited, niceness):
    asked = []
    monkeypatch.setattr(os, "getpriority", lambda _kind, _who: inherited)
    monkeypatch.setattr(os, "setpriority", lambda _kind, _who, value: asked.append(value))
    lower_priority()
    assert asked == [niceness]
