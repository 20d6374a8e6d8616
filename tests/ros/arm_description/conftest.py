"""The nodes of arm_description in processes of their own, one robot for all of them."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from programs import Program, RosProgram
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

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


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Start a node by its module with command-line arguments and ROS parameters by name."""
    started: list[Program] = []

    def start_one(module: str, *arguments: str, **parameters: Any) -> Program:
        file = tmp_path / f"parameters{len(started)}.yaml"
        named = {name.replace("__", "."): value for name, value in parameters.items()}
        file.write_text(yaml.safe_dump({"/**": {"ros__parameters": named}}))
        ros = ["--ros-args", "--params-file", str(file)] if parameters else []
        command = [sys.executable, "-m", f"arm_description.{module}", *arguments, *ros]
        started.append(RosProgram(command, {**os.environ, "ROS_LOG_DIR": str(tmp_path / "log")}))
        return started[-1]

    yield start_one
    for node in started:
        node.close(signal.SIGTERM)


@pytest.fixture
def urdf() -> str:
    """Return a robot with a joint of every type."""
    return URDF


@pytest.fixture
def set_parameters(client) -> Callable[..., str]:
    """Set parameters of a node together; return why they were refused, "" where taken."""
    return lambda node, **values: client.set_parameters(f"/{node}", **values)


@pytest.fixture
def send(client) -> Callable[..., None]:
    """Publish a joint state: stamp in seconds, positions by name."""
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

    def collect(**parameters):
        node = start("robot_state_publisher_node", robot_description=urdf, **parameters)
        collector = client.subscribe(TFMessage, "/tf", 100)
        client.wait_until(lambda: client.node.count_publishers("/tf"), "a publisher of /tf")
        return node, collector

    return collect
