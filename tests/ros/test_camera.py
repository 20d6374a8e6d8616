"""The camera process, as an rclpy node sees it, with a fake simulation."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import cv2
import mujoco
import numpy as np
import psutil
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import qos_profile_sensor_data
from run_python import run_python
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, PointCloud2

from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.camera.process import CameraProcess
from arm_gazebo.sensors.camera import CameraSensor
from launch_py.fast_dds.shared_memory import PREFIXES

MJCF = """
<mujoco>
  <worldbody>
    <light pos="0 0 3"/>
    <camera name="eye" pos="0 0 1" xyaxes="0 -1 0 0 0 1"/>
    <geom type="plane" size="0 0 1" rgba=".5 .5 .5 1"/>
    <body pos="2 0.3 1.2">
      <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.1" rgba="1 0 0 1"/>
    </body>
  </worldbody>
</mujoco>
"""
SENSOR = CameraSensor(
    "eye",
    "camera_link",
    "camera_optical_frame",
    rate_hz=30.0,
    image_topics=("videocamera", "camera/image_raw"),
    info_topics=("camera_info", "videocamera/camera_info"),
)
TICK_S = 0.01


class Simulation:
    """A feed whose time advances tick by tick in a thread."""

    def __init__(self, feed: CameraFeed, process: CameraProcess) -> None:
        self.feed = feed
        self.process = process
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)
        model = mujoco.MjModel.from_xml_string(MJCF)
        self._data = mujoco.MjData(model)
        mujoco.mj_forward(model, self._data)
        # Later on this process maps the camera's as well, to read from it.
        self._foreign = segments_of(psutil.Process())
        feed.start(model)
        self._thread.start()

    def _run(self) -> None:
        tick = 0
        while not self._stop.wait(TICK_S):
            tick += 1
            self.feed.publish_due(tick * TICK_S, self._data)

    @property
    def child(self) -> psutil.Process:
        """The running camera process."""
        assert self.process.pid is not None
        return psutil.Process(self.process.pid)

    def kill_child(self, number: int) -> int:
        """End the camera process with a signal, remove its shared memory and return its id."""
        child = self.child
        segments = self.segments()
        child.send_signal(number)
        for segment in segments:
            segment.unlink(missing_ok=True)
        return child.pid

    def segments(self) -> set[Path]:
        """Return the shared memory of the camera process, which did not exist before it."""
        return segments_of(self.child) - self._foreign

    def replaced(self, pid: int) -> bool:
        """Supervise the camera process once; return whether it has been replaced."""
        self.feed.supervise()
        return self.process.pid not in (None, pid)

    def close(self) -> None:
        """Stop time, then the cameras."""
        self._stop.set()
        self._thread.join()
        self.feed.close()


def segments_of(process: psutil.Process) -> set[Path]:
    """Return the shared memory that a process maps, its own and that of others.

    A port's file is left out: it belongs to both sides, and goes with the last of them.
    """
    paths = (mapped.path for mapped in process.memory_maps())
    return {
        Path(path) for path in paths if Path(path).name.startswith(PREFIXES) and "_port" not in path
    }


Simulate = Callable[..., Simulation]


@pytest.fixture
def simulate() -> Iterator[Simulate]:
    """Start a simulation with one camera, which ends with the test at the latest."""
    yield from simulator()


@pytest.fixture(scope="class")
def simulation() -> Iterator[None]:
    """A simulation with one camera for the tests of a class."""
    for simulate in simulator():
        simulate()
        yield


def simulator() -> Iterator[Simulate]:
    running: list[Simulation] = []

    def start(sensor: CameraSensor = SENSOR, environ: dict | None = None, **options) -> Simulation:
        made: list[CameraProcess] = []

        def make_process(settings, ros_arguments) -> CameraProcess:
            made.append(CameraProcess(settings, ros_arguments, {**os.environ, **(environ or {})}))
            return made[0]

        feed = CameraFeed([sensor], make_process=make_process, **options)
        running.append(Simulation(feed, made[0]))
        return running[-1]

    yield start
    for simulation in running:
        simulation.close()


def pixels(image) -> np.ndarray:
    return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)


def stamp_s(message) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


def values(array) -> dict[str, str]:
    return {pair.key: pair.value for pair in array.status[0].values}


def red_centre(picture: np.ndarray) -> tuple[float, float]:
    wide = picture.astype(int)
    rows, columns = np.nonzero(wide[..., 0] > wide[..., 1] + 40)
    return float(columns.mean()) + 0.5, float(rows.mean()) + 0.5


@pytest.mark.usefixtures("simulation")
class TestOneCamera:
    def test_the_intrinsics_project_the_ball_to_its_pixels(self, client):
        images = client.subscribe(Image, "/videocamera")
        infos = client.subscribe(CameraInfo, "/camera_info")
        image, info = images.wait_for(1)[0], infos.wait_for(1)[0]
        assert (image.width, image.height, image.step, image.encoding) == (320, 240, 960, "rgb8")
        assert image.is_bigendian == 0
        assert image.header.frame_id == info.header.frame_id == "camera_optical_frame"
        # The ball is 0.3 m to the left, 0.2 m above and 2 m ahead.
        u, v, w = np.reshape(info.p, (3, 4)) @ [-0.3, -0.2, 2.0, 1.0]
        assert red_centre(pixels(image)) == pytest.approx((u / w, v / w), abs=1.0)

    def test_every_picture_has_a_camera_info_with_the_same_stamp_on_every_topic(self, client):
        names = ("/camera_info", "/videocamera/camera_info")
        topics = [client.subscribe(CameraInfo, name) for name in names]
        images = client.subscribe(Image, "/camera/image_raw")
        stamps = [stamp_s(image) for image in images.wait_for(10)]
        for topic in topics:
            infos = topic.wait_until(
                lambda m: set(stamps[-3:]) <= {stamp_s(info) for info in m}, "infos of the pictures"
            )
            assert len({stamp_s(info) for info in infos}) == len(infos)

    def test_stamps_are_those_of_the_ticks_at_which_frames_are_due(self, client):
        infos = client.subscribe(CameraInfo, "/camera_info").wait_for(10)
        for info in infos:
            time_s = stamp_s(info)
            assert time_s * 100 == pytest.approx(round(time_s * 100), abs=1e-6)
            assert (time_s * 30) % 1 < TICK_S * 30

    def test_compressed_pictures_show_the_same_image(self, client):
        compressed = client.subscribe(CompressedImage, "/videocamera/compressed").wait_for(1)[0]
        image = client.subscribe(Image, "/videocamera").wait_for(1)[0]
        assert compressed.format == "rgb8; jpeg compressed bgr8"
        assert compressed.header.frame_id == "camera_optical_frame"
        decoded = cv2.imdecode(np.frombuffer(compressed.data, np.uint8), cv2.IMREAD_COLOR)
        decoded = cv2.cvtColor(decoded, cv2.COLOR_BGR2RGB)
        assert np.abs(decoded.astype(int) - pixels(image)).mean() < 3
        assert len(compressed.data) < len(image.data) / 5


def test_a_lens_is_in_camera_info_in_the_picture_and_in_the_points(simulate, client):
    lens = replace(
        SENSOR,
        intrinsics=(350.0, 300.0, 150.0, 125.0, 0.0),
        distortion=(-0.4, 0.1, 0.01, -0.01, 0.0),
        depth_topics=("depth_image",),
        points_topics=("points",),
    )
    simulate(lens)
    images = client.subscribe(Image, "/videocamera")
    clouds = client.subscribe(PointCloud2, "/points")
    info = client.subscribe(CameraInfo, "/camera_info").wait_for(1)[0]
    image, cloud = images.wait_for(1)[0], clouds.wait_for(1)[0]
    np.testing.assert_array_equal(np.reshape(info.k, (3, 3)), lens.lens.matrix)
    assert (info.distortion_model, list(info.d)) == ("plumb_bob", list(lens.distortion))
    k, d = np.reshape(info.k, (3, 3)), np.array(info.d)

    def project(points: np.ndarray) -> np.ndarray:
        return cv2.projectPoints(points, np.zeros(3), np.zeros(3), k, d)[0].reshape(-1, 2)

    ball = project(np.array([[-0.3, -0.2, 2.0]]))[0]
    assert red_centre(pixels(image)) == pytest.approx(tuple(ball), abs=1.0)
    points = np.frombuffer(cloud.data, np.float32).reshape(240, 320, 4)[..., :3].astype(float)
    rows, columns = np.nonzero(np.isfinite(points[..., 2]))
    assert rows.size > 1000
    centres = np.stack([columns, rows], axis=1) + 0.5
    np.testing.assert_allclose(project(points[rows, columns]), centres, atol=1e-2)


def test_best_effort_subscribers_get_large_noisy_pictures(simulate, client):
    large = CameraSensor(
        *("eye", "camera_link", "camera_optical_frame", 800, 800),
        noise_stddev=0.007,
        image_topics=("videocamera",),
        info_topics=("camera_info",),
    )
    simulate(large)
    images = client.subscribe(Image, "/videocamera", qos_profile_sensor_data).wait_for(20)
    first, second = (pixels(image)[600:].astype(int) for image in images[-2:])
    # A plain floor: what differs between two frames is noise, twice.
    noise = np.std(first - second)
    assert noise == pytest.approx(np.sqrt(2 * ((0.007 * 255) ** 2 + 1 / 12)), rel=0.05)


def test_without_subscribers_camera_infos_are_published_and_nothing_is_rendered(simulate, client):
    simulate()
    client.subscribe(CameraInfo, "/camera_info").wait_for(40)
    report = client.subscribe(DiagnosticArray, "/diagnostics").wait_for(1)[0]
    assert values(report)["frames rendered"] == "0"
    assert values(report)["backend"] == "none"
    assert report.status[0].level == b"\x00"
    assert report.status[0].message == "no subscribers"


def test_diagnostics_tell_rate_backend_and_viewers(simulate, client):
    simulate(render_backend="raycast")
    client.subscribe(Image, "/videocamera")
    reports = client.subscribe(DiagnosticArray, "/diagnostics").wait_until(
        lambda m: len(m) >= 3 and int(values(m[-1])["frames rendered"]) > 30, "a busy camera"
    )
    report = values(reports[-1])
    assert reports[-1].status[0].name == "camera: eye"
    assert report["nominal rate (Hz of simulation time)"] == "30"
    assert 0 < float(report["achieved rate (Hz of simulation time)"]) <= 30
    assert report["backend"] == "raycast"
    assert report["subscribers"] == "1"
    assert report["size"] == "320x240"
    assert float(report["render time (ms)"]) > 0


def test_a_simulation_too_fast_for_the_camera_is_a_warning(simulate, client):
    # Every tick of 10 ms passes five of these frames.
    fast = CameraSensor("eye", "l", "f", rate_hz=500.0, image_topics=("videocamera",))
    simulate(fast)
    client.subscribe(Image, "/videocamera")
    reports = client.subscribe(DiagnosticArray, "/diagnostics").wait_until(
        lambda m: bool(m) and m[-1].status[0].level == b"\x01", "a warning"
    )
    assert "of 500 Hz" in reports[-1].status[0].message


def test_the_cameras_are_in_the_simulation_s_namespace(simulate, client):
    simulate(ros_arguments=("-r", "__ns:=/lab"))
    (info, *_) = client.subscribe(CameraInfo, "/lab/videocamera/camera_info").wait_for(1)
    assert info.width > 0
    assert client.node.count_publishers("/videocamera/camera_info") == 0


@pytest.mark.parametrize("profile", ["dds_images.xml", "dds_images_small.xml"])
def test_pictures_arrive_with_either_profile(simulate, client, profile):
    file = Path(sys.prefix) / "share/arm_gazebo/config" / profile
    simulate(environ={"FASTRTPS_DEFAULT_PROFILES_FILE": str(file)})
    pictures = client.subscribe(Image, "/videocamera").wait_for(5)
    assert all(len(picture.data) == picture.step * picture.height > 0 for picture in pictures)


@pytest.mark.gl
def test_after_a_crash_while_drawing_the_next_backend_is_used(simulate, client):
    simulation = simulate(render_backend="egl")
    images = client.subscribe(Image, "/videocamera")
    images.wait_for(1)
    crashed = simulation.kill_child(signal.SIGSEGV)
    client.wait_until(lambda: simulation.replaced(crashed), "a new process")
    assert simulation.process.settings.excluded == ("egl",)
    images.clear()
    images.wait_for(1)
    # A last picture of the old process may have come late: until it draws, the new one has none.
    reports = client.subscribe(DiagnosticArray, "/diagnostics").wait_until(
        lambda m: bool(m) and values(m[-1])["backend"] != "none", "it draws"
    )
    assert values(reports[-1])["backend"] == "raycast"


def test_a_killed_camera_process_is_restarted(simulate, client):
    simulation = simulate()
    infos = client.subscribe(CameraInfo, "/camera_info")
    infos.wait_for(1)
    killed = simulation.kill_child(signal.SIGKILL)
    client.wait_until(lambda: simulation.replaced(killed), "a new process")
    infos.clear()
    infos.wait_for(1)
    assert simulation.process.settings.excluded == ()


def test_stopping_leaves_no_process_and_no_shared_memory(simulate, client):
    simulation = simulate()
    client.subscribe(Image, "/videocamera").wait_for(2)
    child = simulation.child
    segments = simulation.segments()
    assert segments
    simulation.close()
    assert not child.is_running()
    assert not [segment for segment in segments if segment.exists()]


def test_the_camera_process_ends_with_a_killed_simulation():
    parent = subprocess.Popen(
        [
            *(sys.executable, "-c"),
            "import sys, threading\n"
            "from arm_gazebo.camera.feed import CameraFeed\n"
            "from arm_gazebo.sensors.camera import CameraSensor\n"
            "feed = CameraFeed([CameraSensor('eye', 'l', 'f')])\n"
            "feed.start()\n"
            "import psutil\n"
            "print(psutil.Process().children()[0].pid, flush=True)\n"
            "threading.Event().wait()\n",
        ],
        stdout=subprocess.PIPE,
        text=True,
    )
    with parent, contextlib.ExitStack() as stack:
        stack.callback(parent.kill)
        assert parent.stdout is not None
        child = psutil.Process(int(parent.stdout.readline()))
        parent.kill()
        _, alive = psutil.wait_procs([child], timeout=60.0)
        assert alive == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--socket", "0", "--parent", "1", "--settings", "{}"], "not settings of a camera"),
        (
            ["--socket", "0", "--parent", "1", "--settings", '{"cameras":[],"excluded":[]}'],
            "has ended",
        ),
        ([], "--socket"),
    ],
)
def test_a_camera_process_started_by_hand_explains_why_it_does_not_run(arguments, said):
    run = run_python("-m", "arm_gazebo.camera_node", *arguments)
    assert run.returncode == 2
    assert said in run.stderr
    assert "Traceback" not in run.stderr
