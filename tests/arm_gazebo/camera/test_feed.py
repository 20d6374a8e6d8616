"""The cameras' settings, and the simulation's side of their feed; the child process is a fake."""

import gc
import os
import subprocess
from collections.abc import Sequence

import mujoco
import numpy as np
import pytest

from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.camera.process import CameraProcess, CameraSettings
from arm_gazebo.errors import CameraError
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraEnd, CameraProgress, ModelMessage
from arm_gazebo.sensors.camera import CameraSensor

MJCF = """
<mujoco>
  <worldbody>
    <camera name="eye"/>
    <body name="hand" mocap="true" pos="1 2 3"><geom size="0.1"/></body>
    <body><joint type="slide"/><geom size="0.1"/></body>
  </worldbody>
</mujoco>
"""


class Child:
    """Replaces a camera process: a real end of the socket that the test reads."""

    pid = 1

    def __init__(self, command: list[str], pass_fds: Sequence[int], **_options: object) -> None:
        self.end = CameraEnd(os.dup(pass_fds[0]))
        self.returncode: int | None = None
        self.waited = False

    def poll(self) -> int | None:
        return self.returncode

    def wait(self, timeout: float | None) -> int:
        while (messages := self.end.receive()) is not None:
            if not messages:
                raise subprocess.TimeoutExpired("child", timeout or 0.0)
        self.waited = True
        return 0

    def terminate(self) -> None:
        raise AssertionError("the end of the stream is enough")

    kill = terminate

    def receive(self) -> tuple[list[ModelMessage], list[CameraSnapshot]]:
        messages = self.end.receive() or []
        models = [m for m in messages if isinstance(m, ModelMessage)]
        for model in models:
            os.close(model.file)
        return models, [m for m in messages if isinstance(m, CameraSnapshot)]


class World:
    """A feed with its clock, its children and a model."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.wall_s_per_publish = 0.01
        self.children: list[Child] = []
        self.model = mujoco.MjModel.from_xml_string(MJCF)
        self.data = mujoco.MjData(self.model)
        self.feed = CameraFeed(
            [CameraSensor("eye", "l", "f", rate_hz=10.0)],
            make_process=self.make_process,
            clock=lambda: self.now_s,
        )

    def make_process(self, settings: CameraSettings, arguments: Sequence[str]) -> CameraProcess:
        return CameraProcess(settings, arguments, {}, clock=lambda: self.now_s, spawn=self.spawn)

    def spawn(self, command: list[str], **options) -> Child:
        self.children.append(Child(command, **options))
        return self.children[-1]

    @property
    def child(self) -> Child:
        return self.children[-1]

    def publish(self, *times_s: float) -> None:
        for time_s in times_s:
            self.now_s += self.wall_s_per_publish
            self.feed.publish_due(time_s, self.data)


@pytest.fixture
def world():
    made = World()
    yield made
    made.feed.close()
    for child in made.children:
        child.end.close()


@pytest.fixture
def started(world):
    world.feed.start(world.model)
    world.child.receive()
    return world


def test_the_child_gets_the_model_and_then_states(world):
    world.feed.start()
    world.feed.set_model(world.model)
    world.data.qpos[0] = 0.5
    world.publish(0.0)
    (model,), (state,) = world.child.receive()
    assert model.version == state.model_version == 1
    np.testing.assert_array_equal(state.qpos, [0.5])
    np.testing.assert_array_equal(state.mocap_positions, [[1, 2, 3]])
    np.testing.assert_array_equal(state.mocap_quaternions, [[1, 0, 0, 0]])


def test_only_ticks_at_which_a_frame_is_due_send(started):
    started.publish(0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12)
    _, states = started.child.receive()
    assert [state.time_s for state in states] == [0.0, 0.1]
    assert [state.frames[0].number for state in states] == [0, 1]


def test_a_new_model_has_a_new_version_and_discards_older_states(started):
    started.publish(0.0)
    started.feed.set_model(started.model)
    started.publish(0.1)
    (model,), (state,) = started.child.receive()
    assert model.version == state.model_version == 2
    assert state.time_s == 0.1


def test_before_the_model_nothing_is_sent(world):
    world.feed.start()
    world.publish(0.0)
    assert world.child.receive() == ([], [])


def test_a_child_that_does_not_read_costs_frames_but_no_time(started):
    started.publish(*(0.1 * k for k in range(20000)))
    _, states = started.child.receive()
    assert 10 < len(states) < 20000
    started.publish(5000.0)
    _, (state,) = started.child.receive()
    assert state.frames[0].serial == 20000


def test_a_simulation_that_races_sends_at_most_500_states_a_second(started):
    started.wall_s_per_publish = 1 / 2048
    started.publish(*(0.1 * k for k in range(100)))
    _, states = started.child.receive()
    assert [state.frames[0].serial for state in states] == list(range(0, 100, 5))


def test_a_picture_is_awaited_until_the_child_has_dealt_with_it(started):
    assert started.feed.unpublished(0.0) == ()
    started.publish(0.0)
    assert started.feed.unpublished(0.0) == ("eye",)
    started.child.end.tell_progress([CameraProgress(0, 1, 0)])
    assert started.feed.unpublished(30.0) == ()
    (count,) = started.feed.counts()
    assert (count.rate_hz, count.due, count.published, count.dropped) == (10.0, 1, 1, 0)


def test_a_picture_of_the_model_before_is_not_awaited(started):
    started.publish(0.0)
    started.feed.set_model(started.model)
    assert started.feed.unpublished(0.0) == ()
    started.publish(0.1)
    assert started.feed.unpublished(0.0) == ("eye",)


def test_frames_that_are_not_sent_are_counted(started):
    started.wall_s_per_publish = 0.001
    started.publish(0.0, 0.1, 0.2)
    assert started.feed.missed() == {"eye": 1}
    # Once all pictures are out, the next one need not wait.
    started.feed.forget_pace()
    started.publish(0.3)
    assert started.feed.missed() == {"eye": 1}


def test_a_child_that_died_is_replaced_and_gets_the_model(started):
    started.publish(0.0)
    started.child.returncode = -9
    started.feed.supervise()
    assert len(started.children) == 1
    started.now_s += 1.0
    started.feed.supervise()
    assert len(started.children) == 2
    started.publish(0.1)
    (model,), (state,) = started.child.receive()
    assert model.version == 1
    assert state.time_s == 0.1


def test_a_living_child_is_left_alone(started):
    started.feed.supervise()
    assert len(started.children) == 1
    assert started.child.receive() == ([], [])


def test_a_backend_that_crashed_is_left_out(started):
    started.child.end.tell_backend("egl")
    started.child.returncode = -11
    started.feed.supervise()
    assert len(started.children) == 2


def test_closing_ends_the_child_by_the_end_of_the_stream(started):
    started.feed.close()
    assert started.child.waited
    started.publish(0.0)
    started.feed.supervise()
    started.feed.close()
    assert len(started.children) == 1


def test_nothing_stays_open():
    gc.collect()  # Nothing of earlier tests is closed meanwhile.
    before = sorted(os.listdir("/proc/self/fd"))
    world = World()
    world.feed.start(world.model)
    world.feed.set_model(world.model)
    world.child.receive()
    world.feed.close()
    world.child.end.close()
    assert sorted(os.listdir("/proc/self/fd")) == before


def test_a_model_without_the_camera_is_refused(world):
    with pytest.raises(CameraError, match="no camera 'eye'; it has none"):
        world.feed.set_model(mujoco.MjModel.from_xml_string("<mujoco/>"))


def test_a_state_too_large_to_send_is_refused(world, monkeypatch):
    monkeypatch.setattr("arm_gazebo.feed.state_feed.FRAMING_BYTES", 1 << 30)
    with pytest.raises(CameraError, match="too many for the cameras"):
        world.feed.set_model(world.model)


def test_an_unknown_backend_is_refused_at_once():
    with pytest.raises(CameraError, match="no render backend 'vulkan'"):
        CameraFeed([CameraSensor("eye", "l", "f")], render_backend="vulkan")


SETTINGS_SENSOR = CameraSensor(
    "c", "l", "f", image_topics=("a", "b"), info_topics=("i",), rpy=(0, 1, 2)
)


def test_settings_survive_as_text():
    settings = CameraSettings((SETTINGS_SENSOR,), seed=-3, backend="egl", excluded=("osmesa",))
    assert CameraSettings.from_json(settings.to_json()) == settings


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"cameras":[],"excluded":[],"colour":1}', '{"cameras":[{}]}']
)
def test_other_text_is_refused(text):
    with pytest.raises(CameraError, match="not settings of a camera process"):
        CameraSettings.from_json(text)
