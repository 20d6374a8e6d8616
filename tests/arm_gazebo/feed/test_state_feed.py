import os

import mujoco
import pytest

from arm_gazebo.feed.state_feed import StateFeed

MODEL = "<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"


class Reader:
    """A process that is none."""

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
    return len(os.listdir("/proc/self/fd"))


def test_one_model_after_another_keeps_one_file_open(feed, model):
    feed.set_model(model)
    before = open_files()
    for _ in range(5):
        feed.prepare(model).show()
    assert open_files() == before


def test_a_prepared_model_is_not_shown_before_it_is_told_to(feed, model):
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
