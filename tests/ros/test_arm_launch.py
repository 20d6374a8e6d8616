"""`arm launch`, as an ordinary user's rclpy node sees it."""

import contextlib
import fcntl
import itertools
import os
import re
import signal
import threading
import time
from pathlib import Path

import numpy as np
import psutil
import pytest
from controller_manager_msgs.msg import ControllerManagerActivity
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage

from launch_py.fast_dds.shared_memory import PREFIXES, lock_files, lock_owners

POSE = [0.5, 0.3, -0.4, 0.2]
FIRST_PORT = 7400
"""The first UDP port of domain 0."""


def positions_by_name(message) -> dict[str, float]:
    return dict(zip(message.name, message.position, strict=True))


def tick_ns(message) -> int:
    return message.clock.sec * 10**9 + message.clock.nanosec


def mapped_files(process: psutil.Process) -> set[Path]:
    try:
        return {Path(mapped.path) for mapped in process.memory_maps()}
    except psutil.NoSuchProcess:  # The launcher's look at the graph has ended meanwhile.
        return set()


def shared_memory(launched) -> set[Path]:
    """Return the middleware's files that the launcher and all below it have mapped.

    But for the ports from 7000 on: they are those of other domains, too, and stay where a process
    of another one was killed. And but for the mutexes of ports: one that a process made anew, to
    tell an ended one something, stays while any participant on this machine lives.
    """
    processes = [psutil.Process(launched.process.pid), *launched.processes()]
    paths = {path for process in processes for path in mapped_files(process)}
    ports = {path: re.search(r"_port(\d+)", path.name) for path in paths}
    return {
        path
        for path, port in ports.items()
        if path.parent == Path("/dev/shm")
        and path.name.startswith(PREFIXES)
        and (port is None or int(port[1]) >= FIRST_PORT)
    }


def owned(files: set[Path], pids: set[int]) -> set[Path]:
    """Return the files whose lock one of the processes holds."""
    locks, owners = lock_files("/dev/shm"), lock_owners("/dev/shm")
    return {file for file in files if owners.get(locks.get(file.name, 0), set()) & pids}


def readable_by_others(files: set[Path]) -> list[Path]:
    """Return the files that still exist and are readable by other users."""
    readable: list[Path] = []
    for file in files:
        with contextlib.suppress(FileNotFoundError):
            if file.stat().st_mode & 0o077:
                readable.append(file)
    return readable


def is_abandoned(file: Path) -> bool:
    """Return whether a shared-memory file exists and nobody holds its lock."""
    try:
        lock = os.open(f"{file}_el", os.O_RDONLY)
    except OSError:
        return file.exists()
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(lock)
    return file.exists()


@pytest.fixture(scope="class")
def arm(launch_for_class):
    """`arm launch` with something to see, for tests that change nothing of it."""
    launch_for_class("world:=objects").wait_until_ready()


@pytest.mark.usefixtures("arm")
class TestAsItStarts:
    def test_a_float64_multi_array_moves_the_arm_and_nothing_overrides_it(self, client):
        """The controller node has no pose of its own, so the first command stands."""
        topic = "/position_controller/commands"
        states = client.subscribe(JointState, "/joint_states")
        commands = client.subscribe(Float64MultiArray, topic)
        # The controller's subscription, and the one above.
        client.publisher(Float64MultiArray, topic, matches=2).publish(Float64MultiArray(data=POSE))
        reached = states.wait_until(
            lambda m: bool(m) and np.allclose(m[-1].position, POSE, atol=0.005),
            "the pose is reached",
        )
        assert reached[-1].name == ["j0", "j1", "j2", "j3"]
        assert reached[-1].header.frame_id == "base_link"
        assert len(reached[-1].velocity) == len(reached[-1].effort) == 4
        states.clear()
        held = states.wait_for(100)
        assert np.allclose([m.position for m in held], POSE, atol=0.01)
        assert len(commands.wait_for(1)) == 1

    def test_stamps_are_simulation_time_and_follow_the_clock(self, client, latched):
        clock = client.subscribe(Clock, "/clock")
        states = client.subscribe(JointState, "/joint_states")
        # A subscription may be matched later than the other one.
        clock.wait_for(100)
        states.clear()
        samples = states.wait_for(100)
        state_ns = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in samples]
        ticks = clock.wait_until(
            lambda m: tick_ns(m[-1]) >= state_ns[-1], "the clock of the states"
        )
        clock_ns = [tick_ns(m) for m in ticks]
        assert all(b > a for a, b in itertools.pairwise(clock_ns))
        steps_ns = [b - a for a, b in itertools.pairwise(state_ns)]
        # A subscription may miss one on a busy machine.
        assert min(steps_ns) == 10_000_000
        assert not any(step % 10_000_000 for step in steps_ns)
        assert set(state_ns) & set(clock_ns)
        # The manager's own messages use the same clock.
        reports = client.subscribe(DiagnosticArray, "/diagnostics")
        activity = client.subscribe(
            ControllerManagerActivity, "/controller_manager/activity", latched
        ).wait_for(1)
        stamps_s = [m.header.stamp.sec for m in (*activity, *reports.wait_for(1))]
        clock.wait_until(
            lambda m: m[-1].clock.sec >= max(stamps_s), "the clock reaches the reports"
        )

    def test_the_frames_of_the_arm_are_in_tf(self, client):
        latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        static = client.subscribe(TFMessage, "/tf_static", latched)
        moving = client.subscribe(TFMessage, "/tf")
        fixed = {t.child_frame_id for m in static.wait_for(1) for t in m.transforms}
        assert {"base_link", "camera_link", "camera_optical_frame", "crawer_left"} <= fixed
        frames = moving.wait_for(2)[-1].transforms
        assert {t.child_frame_id for t in frames} == {"base_turn_rot", "dyn2_r", "dyn3_r", "dyn4_r"}

    def test_the_camera_sends_pictures_and_a_matching_camera_info(self, client):
        images = client.subscribe(Image, "/videocamera")
        infos = client.subscribe(CameraInfo, "/camera_info")
        paired = client.subscribe(CameraInfo, "/videocamera/camera_info")
        image = images.wait_for(3)[-1]
        info = infos.wait_for(3)[-1]
        paired.wait_for(3)
        assert (image.width, image.height, image.encoding, image.step) == (320, 240, "rgb8", 960)
        assert image.header.frame_id == info.header.frame_id == "camera_optical_frame"
        assert info.k[0] == pytest.approx(160 / np.tan(1.047 / 2), rel=1e-3)
        assert (info.width, info.height) == (320, 240)
        pixels = np.frombuffer(image.data, np.uint8).reshape(240, 320, 3)
        assert pixels.std() > 10, "the picture shows something"


def test_a_stop_signal_ends_everything_with_exit_code_0(launch):
    launched = launch()
    launched.wait_until_ready()
    children = launched.processes()
    assert len(children) >= 3
    files = shared_memory(launched)
    assert files
    own = owned(files, {launched.process.pid, *(child.pid for child in children)})
    assert own
    # Fast DDS makes each file readable for all; a moment later its process changes that.
    # No node of this process waits for that: its ports would be among the files looked at below.
    deadline = time.monotonic() + 30.0
    while readable_by_others(own) and time.monotonic() < deadline:
        threading.Event().wait(0.02)
    assert readable_by_others(own) == []
    assert launched.stop(signal.SIGTERM) == 0, launched.output
    _, alive = psutil.wait_procs(children, timeout=60.0)
    assert alive == []
    # The traceback of a test that failed before keeps its nodes here, and with them others' ports.
    files -= mapped_files(psutil.Process())
    assert [file for file in files if is_abandoned(file)] == []


def test_a_simulation_killed_with_its_cameras_leaves_no_shared_memory(launch, client):
    """What the simulation and its cameras share has no name; the middleware's files are removed."""
    launched = launch()
    launched.wait_until_ready()
    client.subscribe(Image, "/videocamera").wait_for(1)
    # Not the files of ports: this process, which still answers ended ones, may create them again.
    files = {file for file in shared_memory(launched) if "_port" not in file.name}
    assert files
    victims = launched.processes("arm_gazebo.camera_node", "arm_gazebo_node")
    assert len(victims) == 2
    for victim in victims:
        # The cameras end with the simulation, perhaps before their turn.
        with contextlib.suppress(psutil.NoSuchProcess):
            victim.kill()
    assert launched.wait() == 128 + signal.SIGKILL, launched.output
    assert [file for file in files if is_abandoned(file)] == []


def test_the_mock_arm_follows_commands_at_once(launch, client):
    launched = launch("arm_control", "arm_mock.launch.py")
    launched.wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    commands.publish(Float64MultiArray(data=[0.1, 0.2, 0.3, 0.4]))
    states.wait_until(
        lambda m: bool(m) and list(m[-1].position) == [0.1, 0.2, 0.3, 0.4], "the pose"
    )
    assert states.messages[-1].name == ["j0", "j1", "j2", "j3"]
    assert launched.stop() == 0
