"""The nodes of arm_description in processes of their own, one robot for all of them."""

import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

WAIT_TIMEOUT_S = 40.0
ESCAPES = re.compile("\x1b\\[[0-9;]*m")

LIMIT = "<limit lower='-3' upper='3' effort='1' velocity='1'/>"
URDF = f"""<robot name='r'>
  <link name='base'/> <link name='arm'/> <link name='slide'/> <link name='finger'/>
  <link name='tool'/> <link name='table'/> <link name='ball'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/>
    <origin xyz='0 0 1'/><axis xyz='0 0 1'/>{LIMIT}</joint>
  <joint name='push' type='prismatic'><parent link='arm'/><child link='slide'/>
    <origin rpy='0 0 1.5707963267948966'/><axis xyz='1 0 0'/>{LIMIT}</joint>
  <joint name='grip' type='prismatic'><parent link='slide'/><child link='finger'/>
    <axis xyz='0 0 1'/>{LIMIT}<mimic joint='push' multiplier='-2' offset='0.5'/></joint>
  <joint name='mount' type='fixed'><parent link='slide'/><child link='tool'/>
    <origin xyz='1 2 3' rpy='0 0 3.141592653589793'/></joint>
  <joint name='floor' type='planar'><parent link='base'/><child link='table'/>
    <origin xyz='0 0 -1'/></joint>
  <joint name='free' type='floating'><parent link='base'/><child link='ball'/></joint>
</robot>"""


class NodeProcess:
    """A running executable and all that it printed."""

    def __init__(self, module: str, arguments: list[str], log_folder: Path) -> None:
        self._changed = threading.Condition()
        self._output = ""
        self._ended = False
        self.process = subprocess.Popen(
            [sys.executable, "-m", f"arm_description.{module}", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "ROS_LOG_DIR": str(log_folder)},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._changed:
                self._output += line
                self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    @property
    def output(self) -> str:
        """All that was printed so far."""
        with self._changed:
            return self._output

    @property
    def own_words(self) -> list[str]:
        """The lines so far that are not Fast DDS's own, which complains on a loaded machine."""
        return [line for line in self.output.splitlines() if "[RTPS" not in ESCAPES.sub("", line)]

    def wait_for(self, text: str) -> None:
        """Block until this text was printed."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended or text in self._output, WAIT_TIMEOUT_S)
            assert text in self._output, f"{text!r} was not printed:\n{self._output}"

    def stop(self, number: int) -> int:
        """Send a signal and return the exit code."""
        self.process.send_signal(number)
        return self.wait()

    def wait(self) -> int:
        """Wait for the end and return the exit code."""
        code = self.process.wait(WAIT_TIMEOUT_S)
        self._reader.join(WAIT_TIMEOUT_S)
        print(self.output)  # Shown if the test fails.
        return code

    def close(self) -> None:
        """Make sure that nothing stays behind, whatever the test did."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(WAIT_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait(WAIT_TIMEOUT_S)
        self._reader.join(WAIT_TIMEOUT_S)
        if self.process.stdout is not None:
            self.process.stdout.close()


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., NodeProcess]]:
    """Start a node by its module with command-line arguments and ROS parameters by name."""
    started: list[NodeProcess] = []

    def start_one(module: str, *arguments: str, **parameters: Any) -> NodeProcess:
        file = tmp_path / f"parameters{len(started)}.yaml"
        named = {name.replace("__", "."): value for name, value in parameters.items()}
        file.write_text(yaml.safe_dump({"/**": {"ros__parameters": named}}))
        ros = ["--ros-args", "--params-file", str(file)] if parameters else []
        node = NodeProcess(module, [*arguments, *ros], tmp_path / "log")
        started.append(node)
        return node

    yield start_one
    for node in started:
        node.close()


@pytest.fixture
def urdf() -> str:
    """Return a robot with a joint of every type."""
    return URDF


@pytest.fixture
def set_parameters(client) -> Callable[..., list]:
    """Set parameters of a node together; return the reasons of refusals, empty where taken."""
    from rcl_interfaces.srv import SetParametersAtomically
    from rclpy.parameter import Parameter

    def set_together(node: str, **values: Any) -> str:
        request = SetParametersAtomically.Request(
            parameters=[
                Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
            ]
        )
        service = f"/{node}/set_parameters_atomically"
        result = client.call(SetParametersAtomically, service, request).result
        assert result.successful == (not result.reason), result
        return result.reason

    return set_together


@pytest.fixture
def latched() -> Any:
    """Return the QoS of a topic whose last message late subscribers get."""
    from rclpy.qos import DurabilityPolicy, QoSProfile

    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def send(client) -> Callable[..., None]:
    """Publish a joint state: stamp in seconds, positions by name."""
    from sensor_msgs.msg import JointState

    publishers = []

    def send_one(stamp_s: float, positions: Any = None, **by_name: float) -> None:
        if not publishers:
            publishers.append(client.publisher(JointState, "joint_states"))
        if isinstance(positions, bytes):
            publishers[0].publish(positions)
            return
        values = list(by_name.values()) if positions is None else positions
        message = JointState(name=list(by_name), position=values)
        nanoseconds = round(stamp_s * 1e9)
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(nanoseconds, 10**9)
        publishers[0].publish(message)

    return send_one


@pytest.fixture
def tf(client, start, urdf):
    """Start the node and return a function that collects /tf, matched."""
    from tf2_msgs.msg import TFMessage

    def collect(**parameters):
        node = start("robot_state_publisher_node", robot_description=urdf, **parameters)
        collector = client.subscribe(TFMessage, "/tf", 100)
        client.wait_until(lambda: client.node.count_publishers("/tf"), "a publisher of /tf")
        return node, collector

    return collect
