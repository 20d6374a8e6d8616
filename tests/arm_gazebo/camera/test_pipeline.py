"""The camera process turns the simulation's messages into images."""

import gc
import os

import mujoco
import numpy as np
import pytest

from arm_gazebo.camera.pipeline import BACKLOG, CameraPipeline
from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import ModelMessage
from arm_gazebo.sensors.camera import CameraSensor

MJCF = """
<mujoco>
  <worldbody>
    <camera name="left"/>
    <camera name="right"/>
    <body name="hand" mocap="true"><geom size="0.1"/></body>
    <body><joint name="slide" type="slide"/><geom size="0.1"/></body>
  </worldbody>
</mujoco>
"""


class Sink:
    """Remembers what was published."""

    def __init__(self, sensor: CameraSensor) -> None:
        self.picture = np.zeros((sensor.height, sensor.width, 3), np.uint8)
        self.depth = np.zeros((sensor.height, sensor.width), np.float32)
        self.watched = True
        self.measured = False
        self.depths: list[tuple[float, np.ndarray]] = []
        self.infos_s: list[float] = []
        self.pictures: list[tuple[float, np.ndarray]] = []

    def wants_picture(self) -> bool:
        return self.watched

    def wants_depth(self) -> bool:
        return self.measured

    def publish_info(self, time_s: float) -> None:
        self.infos_s.append(time_s)

    def publish_picture(self, time_s: float) -> None:
        self.pictures.append((time_s, self.picture.copy()))

    def publish_depth(self, time_s: float) -> None:
        self.depths.append((time_s, self.depth.copy()))


class Renderer:
    """Draws the slider's position as the grey level, and as the distance."""

    backend = "fake"

    def __init__(self) -> None:
        self.models: list[mujoco.MjModel] = []
        self.mocap_positions: list[np.ndarray] = []
        self.closed = False

    def set_model(self, model: mujoco.MjModel) -> None:
        self.models.append(model)

    def render(
        self,
        data: mujoco.MjData,
        sensor: CameraSensor,
        picture: np.ndarray | None,
        depth: np.ndarray | None,
    ) -> None:
        if picture is not None:
            picture[:] = int(data.qpos[0])
        if depth is not None:
            depth[:] = data.qpos[0]
        self.mocap_positions.append(data.mocap_pos[0].copy())

    def close(self) -> None:
        self.closed = True


class Process:
    """A pipeline with everything around it."""

    def __init__(self, **fields: float) -> None:
        self.sensors = [
            CameraSensor(name, "l", "f", width=40, height=30, **fields)
            for name in ("left", "right")
        ]
        self.sinks = [Sink(sensor) for sensor in self.sensors]
        self.renderer = Renderer()
        self.opened = 0
        self.pipeline = CameraPipeline(self.sensors, self.sinks, self._open, seed=3)
        self._serials = [0, 0]

    def _open(self) -> Renderer:
        self.opened += 1
        return self.renderer

    def state(
        self, time_s: float, *cameras: int, version: int = 1, level: int = 100
    ) -> CameraSnapshot:
        frames = []
        for camera in cameras or (0,):
            serial = self._serials[camera]
            frames.append(FrameDue(camera, serial, serial))
            self._serials[camera] += 1
        qpos, at, upright = np.array([float(level)]), np.array([[time_s, 0, 0]]), np.eye(1, 4)
        return CameraSnapshot(version, time_s, tuple(frames), qpos, at, upright)


@pytest.fixture
def process():
    made = Process()
    yield made
    made.pipeline.close()


def model_message(version: int = 1, mjcf: str = MJCF) -> ModelMessage:
    model = mujoco.MjModel.from_xml_string(mjcf)
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    file = os.memfd_create("model")
    os.write(file, content)
    return ModelMessage(version, file)


def test_a_state_becomes_a_picture_with_its_stamp(process):
    process.pipeline.handle([model_message(), process.state(1.5, level=77)])
    ((time_s, picture),) = process.sinks[0].pictures
    assert time_s == 1.5
    assert (picture == 77).all()
    assert process.sinks[0].infos_s == [1.5]
    assert process.pipeline.time_s == 1.5


def test_mocap_bodies_are_placed(process):
    process.pipeline.handle([model_message(), process.state(0.25)])
    np.testing.assert_allclose(process.renderer.mocap_positions, [[0.25, 0, 0]])


def test_without_a_viewer_infos_flow_and_nothing_is_loaded(process):
    process.sinks[0].watched = False
    process.pipeline.handle([model_message()])
    for k in range(5):
        process.pipeline.handle([process.state(0.1 * k)])
    assert len(process.sinks[0].infos_s) == 5
    assert process.sinks[0].pictures == []
    assert process.opened == 0
    assert process.pipeline.backend == "none"


def test_the_renderer_is_opened_once(process):
    process.pipeline.handle([model_message()])
    process.pipeline.handle([process.state(0.1)])
    process.pipeline.handle([process.state(0.2)])
    assert process.opened == 1
    assert len(process.renderer.models) == 1
    assert process.pipeline.backend == "fake"


def test_only_the_camera_that_is_watched_is_drawn(process):
    process.sinks[0].watched = False
    process.pipeline.handle([model_message(), process.state(0.1, 0, 1)])
    assert [len(sink.pictures) for sink in process.sinks] == [0, 1]


def test_when_behind_the_newest_frames_are_drawn_and_the_rest_is_counted(process):
    process.pipeline.handle([model_message(), process.state(0.0)])
    process.pipeline.handle([process.state(0.1 * k) for k in range(1, 6)])
    times_s = [time_s for time_s, _ in process.sinks[0].pictures]
    assert times_s == pytest.approx([0.0, 0.4, 0.5])
    assert process.pipeline.statistics[0].report().dropped == 5 - BACKLOG


def test_each_camera_keeps_its_own_newest_frames(process):
    states = [process.state(0.0, 1), *(process.state(0.1 * k) for k in range(1, 6))]
    process.pipeline.handle([model_message(), *states])
    assert [time_s for time_s, _ in process.sinks[1].pictures] == [0.0]


def test_states_before_the_model_are_left_out(process):
    process.pipeline.handle([process.state(0.0)])
    assert process.sinks[0].infos_s == []


def test_states_of_an_older_model_are_left_out(process):
    process.pipeline.handle([model_message(1)])
    process.pipeline.handle(
        [process.state(0.1), model_message(2), process.state(0.2), process.state(0.3, version=2)]
    )
    assert [time_s for time_s, _ in process.sinks[0].pictures] == [0.3]


def test_a_new_model_is_drawn_from_then_on(process):
    process.pipeline.handle([model_message(1), process.state(0.1)])
    process.pipeline.handle([model_message(2), process.state(0.2, version=2)])
    assert len(process.renderer.models) == 2


def test_depth_is_rendered_only_for_its_subscribers(process):
    sink = process.sinks[0]
    sink.watched, sink.measured = False, True
    process.pipeline.handle([model_message(), process.state(0.5, level=3)])
    ((time_s, depth),) = sink.depths
    assert time_s == 0.5
    assert (depth == 3).all()
    assert sink.pictures == []


def test_distances_out_of_range_say_on_which_side():
    ranged = Process(near=0.2, far=5.0, depth_topics=("d",))
    ranged.sinks[0].measured = True
    ranged.pipeline.handle([model_message(), ranged.state(0.0, level=0)])
    ranged.pipeline.handle([ranged.state(0.1, level=6)])
    (_, near), (_, far) = ranged.sinks[0].depths
    assert (near == -np.inf).all()
    assert (far == np.inf).all()
    ranged.pipeline.close()


def test_noise_of_a_camera_without_picture_is_in_metres_and_repeatable():
    depths = []
    for _ in range(2):
        noisy = Process(noise_mean=0.1, noise_stddev=0.02, depth_topics=("d",))
        noisy.sinks[0].measured = True
        noisy.pipeline.handle([model_message(), noisy.state(0.0, level=4)])
        depths.append(noisy.sinks[0].depths[0][1])
        noisy.pipeline.close()
    assert depths[0].mean() == pytest.approx(4.1, abs=0.005)
    assert depths[0].std() == pytest.approx(0.02, rel=0.1)
    np.testing.assert_array_equal(*depths)


def test_noise_is_added_and_repeatable():
    pictures = []
    for _ in range(2):
        noisy = Process(noise_stddev=0.02)
        noisy.pipeline.handle([model_message(), noisy.state(0.0)])
        pictures.append(noisy.sinks[0].pictures[0][1])
        noisy.pipeline.close()
    assert pictures[0].std() > 3
    np.testing.assert_array_equal(*pictures)


def test_a_state_that_does_not_fit_its_model_is_refused(process):
    other = MJCF.replace('<joint name="slide" type="slide"/>', "<freejoint/>")
    with pytest.raises(CameraError, match="1 positions does not belong to this model, which has 7"):
        process.pipeline.handle([model_message(mjcf=other), process.state(0.0)])


def test_a_file_that_holds_no_model_is_refused(process, tmp_path, monkeypatch):
    # MuJoCo writes a log file into the working folder.
    monkeypatch.chdir(tmp_path)
    file = os.memfd_create("garbage")
    os.write(file, b"garbage" * 100)
    with pytest.raises(CameraError, match="cannot load the compiled model"):
        process.pipeline.handle([ModelMessage(1, file), process.state(0.0)])


def test_closing_frees_the_renderer_and_the_model(process):
    gc.collect()  # Nothing of earlier tests is closed meanwhile.
    before = len(os.listdir("/proc/self/fd"))
    process.pipeline.handle([model_message(1), process.state(0.1), model_message(2)])
    process.pipeline.handle([process.state(0.2, version=2)])
    process.pipeline.close()
    assert process.renderer.closed
    assert len(os.listdir("/proc/self/fd")) == before
