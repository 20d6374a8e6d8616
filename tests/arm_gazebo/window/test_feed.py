"""The simulation's side of its window, over the real sockets; the child is a stand-in."""

import os
import subprocess
from collections.abc import Iterator, Sequence

import mujoco
import pytest

from arm_gazebo.feed.socket_pair import CameraEnd, ModelMessage
from arm_gazebo.window.process import (
    EXIT_CLOSED,
    EXIT_FAILED,
    EXIT_NEW_MODEL,
    WindowFeed,
    WindowProcess,
)

MJCF = "<mujoco><worldbody><body><joint/><geom size='0.1'/></body></worldbody></mujoco>"


class Child:
    """Replaces a window process: a real end of the socket that the test reads."""

    pid = 1

    def __init__(self, _command: list[str], pass_fds: Sequence[int], env: dict, **_rest) -> None:
        self.end = CameraEnd(os.dup(pass_fds[0]))
        self.environ = env
        self.returncode: int | None = None

    def poll(self) -> int | None:
        return self.returncode

    def wait(self, timeout: float | None) -> int:
        while (said := self.receive()) is not None:
            if not said:
                raise subprocess.TimeoutExpired("child", timeout or 0.0)
        return 0

    def terminate(self) -> None:
        raise AssertionError("the end of the stream is enough")

    kill = terminate

    def receive(self) -> list[str] | None:
        """What has come: "model" and times of states; None after the end."""
        messages = self.end.receive()
        if messages is None:
            return None
        said: list[str] = []
        for message in messages:
            if isinstance(message, ModelMessage):
                os.close(message.file)
                said.append("model")
            else:
                said.append(f"{message.time_s:g}")
        return said


class World:
    """A feed with its clock, its children and a model."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.children: list[Child] = []
        self.model = mujoco.MjModel.from_xml_string(MJCF)
        self.data = mujoco.MjData(self.model)
        environ = {"DISPLAY": ":7", "NOTIFY_SOCKET": "/run/notify"}
        self.feed = WindowFeed(WindowProcess(environ, self.spawn), lambda: self.now_s)
        self.feed.start(self.model)

    def spawn(self, command: list[str], **options) -> Child:
        self.children.append(Child(command, **options))
        return self.children[-1]

    def publish(self, *times_s: float) -> None:
        for time_s in times_s:
            self.now_s = time_s
            self.feed.publish_due(time_s, self.data)

    def end_child(self, code: int) -> None:
        self.children[-1].returncode = code
        self.feed.supervise()


@pytest.fixture
def world() -> Iterator[World]:
    made = World()
    yield made
    made.feed.close()
    for child in made.children:
        child.end.close()


def test_the_window_gets_the_model_and_then_states_as_a_screen_shows_them(world):
    world.publish(*(tick * 0.005 for tick in range(9)))
    assert world.children[0].receive() == ["model", "0", "0.02", "0.04"]


def test_the_window_knows_the_display_and_does_not_speak_for_the_simulation(world):
    assert world.children[0].environ["DISPLAY"] == ":7"
    assert "NOTIFY_SOCKET" not in world.children[0].environ


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (EXIT_CLOSED, "the window was closed; the simulation continues"),
        (EXIT_FAILED, "there is no window; the simulation continues"),
        (1, "the window ended with exit code 1; the simulation continues"),
        (-11, "the window ended (Segmentation fault); the simulation continues"),
    ],
)
def test_a_window_that_is_gone_stays_away_and_gets_nothing_more(world, caplog, code, said):
    caplog.set_level("INFO")
    world.children[0].receive()
    world.end_child(code)
    assert said in caplog.text
    world.publish(1.0)
    world.feed.supervise()
    assert len(world.children) == 1
    assert world.children[0].receive() is None
    assert caplog.text.count("the simulation continues") == 1


def test_a_window_with_an_old_model_reopens(world):
    world.end_child(EXIT_NEW_MODEL)
    assert len(world.children) == 2
    world.publish(1.0)
    assert world.children[1].receive() == ["model", "1"]


def test_a_window_that_cannot_start_does_no_harm(caplog):
    def no_memory(*_arguments: object, **_options: object) -> None:
        raise OSError("Cannot allocate memory")

    feed = WindowFeed(WindowProcess({}, no_memory))
    model = mujoco.MjModel.from_xml_string(MJCF)
    feed.start(model)
    feed.supervise()
    feed.publish_due(0.0, mujoco.MjData(model))
    feed.close()
    assert "cannot be started (Cannot allocate memory)" in caplog.text
