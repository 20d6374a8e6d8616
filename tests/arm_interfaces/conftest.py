"""Two processes of one ROS domain, and the record of what each type must be.

The test process holds a client and spins it itself; the other end is a program from `peers/`.
Nothing sleeps: every wait is on a condition, with a generous timeout.
"""

import importlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

FOLDER = Path(__file__).parent
EXPECTED_TYPES: dict[str, str] = yaml.safe_load((FOLDER / "expected_types.yaml").read_bytes())
WAIT_TIMEOUT_S = 30.0


def pytest_configure(config: pytest.Config) -> None:
    """Let the first type support be imported: its wheel imports a parser that is of age."""
    config.addinivalue_line("filterwarnings", "ignore:module 'sre_:DeprecationWarning")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that asks for `recorded` once for the recorded types of every package."""
    if "recorded" in metafunc.fixturenames:
        packages = sorted({name.split("/")[0] for name in EXPECTED_TYPES})
        of = {
            p: {n: r for n, r in EXPECTED_TYPES.items() if n.startswith(f"{p}/")} for p in packages
        }
        metafunc.parametrize("recorded", of.values(), ids=of)


@pytest.fixture
def expected_types() -> dict[str, str]:
    """The recorded hash of each type by its name, such as `tf2_msgs/msg/TFMessage`."""
    return EXPECTED_TYPES


@pytest.fixture
def load_type() -> Callable[[str], type]:
    """Import the class of a type by its ROS name."""

    def load(name: str) -> type:
        package, kind, class_name = name.split("/")
        return getattr(importlib.import_module(f"{package}.{kind}"), class_name)

    return load


@pytest.fixture
def domain_id() -> int:
    """The domain of the whole session."""
    return int(os.environ["ROS_DOMAIN_ID"])


@pytest.fixture
def ros_environment(
    domain_id: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> dict[str, str]:
    """Settings of both processes, already applied to this one."""
    settings = {
        "ROS_DOMAIN_ID": str(domain_id),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_LOG_DIR": str(tmp_path / "log"),
        "ROS_PYTHON_CHECK_FIELDS": "1",
        "AMENT_PREFIX_PATH": sys.prefix,
    }
    for name, value in settings.items():
        monkeypatch.setenv(name, value)
    return settings


class Client:
    """A node of this process, spun only while a test waits."""

    def __init__(self, domain_id: int) -> None:
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from rclpy.signals import SignalHandlerOptions

        from arm_node.workarounds.discovery import first_node

        self.context = Context()
        rclpy.init(
            context=self.context,
            domain_id=domain_id,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.node = first_node(lambda: Node("test_client", context=self.context))
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)

    def spin_until(
        self, condition: Callable[[], object], what: str, timeout_s: float = WAIT_TIMEOUT_S
    ) -> None:
        """Spin until the condition is true; fail the test if that takes too long."""
        deadline_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > deadline_s:
                pytest.fail(f"not within {timeout_s} s: {what}")
            self.executor.spin_once(timeout_sec=0.05)

    def be_known_to_server(self, service: str) -> None:
        """Spin until the process that serves a service knows of all that this node has."""
        from arm_node.testing import DiscoveryCheck

        check = DiscoveryCheck.with_server(self.node, service)
        self.spin_until(lambda: check.complete, f"known to the server of {service}")
        check.close()

    def wait_for(self, future: Any, what: str) -> Any:
        """Spin until a future is done; return its result."""
        self.spin_until(future.done, what)
        return future.result()

    def close(self) -> None:
        """End the executor, then the node, then the context."""
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture
def client(ros_environment: dict[str, str], domain_id: int) -> Iterator[Client]:
    """Return a client of this process."""
    connected = Client(domain_id)
    yield connected
    connected.close()


@pytest.fixture
def start_peer(ros_environment: dict[str, str]) -> Iterator[Callable[..., subprocess.Popen]]:
    """Start a program from `peers/`; it must end well at the end of the test."""
    peers: list[subprocess.Popen] = []

    def start(program: str, *arguments: str) -> subprocess.Popen:
        peer = subprocess.Popen(
            [sys.executable, str(FOLDER / "peers" / f"{program}.py"), *arguments],
            env={**os.environ, **ros_environment},
        )
        peers.append(peer)
        return peer

    yield start
    for peer in peers:
        peer.send_signal(signal.SIGTERM)
    codes = [end(peer) for peer in peers]
    assert codes == [0] * len(peers)


def end(process: subprocess.Popen, timeout_s: float = WAIT_TIMEOUT_S) -> int:
    """Wait for a process that was told to end; kill it if it does not."""
    try:
        return process.wait(timeout_s)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait(timeout_s)
