"""A controller manager with fake hardware in a separate process."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from builtin_interfaces.msg import Duration
from programs import Program, RosProgram
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter

from launch_py.system.dds_profile import shipped_profile

TIMEOUT_S = 60.0

PARAMETERS = {
    "controller_manager": {
        "ros__parameters": {
            "update_rate": 100,
            "joint_state_broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
            "position_controller": {"type": "position_controllers/JointGroupPositionController"},
            "second_controller": {"type": "position_controllers/JointGroupPositionController"},
        }
    },
    "position_controller": {"ros__parameters": {"joints": ["j0", "j1", "j2", "j3"]}},
    "second_controller": {"ros__parameters": {"joints": ["j3"]}},
}


Run = Callable[..., Program]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    """Return a function that runs Python with arguments; ended with the module at the latest."""
    programs: list[Program] = []

    def start(*arguments: str) -> Program:
        log = tmp_path_factory.mktemp("log")
        environment = {
            **os.environ,
            "ROS_LOG_DIR": str(log),
            # Spawners lock the machine there: not that of other sessions.
            "ROS_HOME": str(log.parent),
            **shipped_profile(os.environ),
        }
        programs.append(RosProgram([sys.executable, *arguments], environment, subprocess.PIPE))
        return programs[-1]

    yield start
    for program in programs:
        program.close(signal.SIGTERM)


@pytest.fixture(scope="module")
def run_manager(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Return a function that starts a manager and, by default, waits until it serves."""

    def start(
        *arguments: str,
        parameters: dict[str, Any] | None = None,
        ros_arguments: Sequence[str] = (),
        wait: bool = True,
    ) -> Program:
        file = tmp_path_factory.mktemp("parameters") / "controllers.yaml"
        file.write_text(yaml.safe_dump(PARAMETERS if parameters is None else parameters))
        script = str(Path(__file__).parent / "fake_manager.py")
        program = run(script, *arguments, "--ros-args", "--params-file", str(file), *ros_arguments)
        if wait:
            program.wait_for_line("ready")
        return program

    return start


@pytest.fixture(scope="module")
def manager(run_manager: Run) -> Program:
    """Return the module's manager; tests leave it without controllers."""
    return run_manager()


@pytest.fixture
def spawn(run: Run) -> Run:
    """Return a function that starts a spawner."""
    return lambda *arguments: run("-m", "arm_control.spawner.spawner_node", *arguments)


@pytest.fixture
def unspawn(run: Run) -> Run:
    """Return a function that starts an unspawner."""
    return lambda *arguments: run("-m", "arm_control.spawner.unspawner_node", *arguments)


@pytest.fixture
def file(tmp_path: Path) -> Callable[..., str]:
    """Return a function that writes a parameter file and returns its path."""

    def write(content: dict[str, Any], name: str = "extra") -> str:
        path = tmp_path / f"{name}.yaml"
        path.write_text(yaml.safe_dump(content))
        return str(path)

    return write


SERVICES = {
    "cleanup_controller": "CleanupController",
    "configure_controller": "ConfigureController",
    "list_controller_types": "ListControllerTypes",
    "list_controllers": "ListControllers",
    "list_hardware_components": "ListHardwareComponents",
    "list_hardware_interfaces": "ListHardwareInterfaces",
    "load_controller": "LoadController",
    "reload_controller_libraries": "ReloadControllerLibraries",
    "set_hardware_component_state": "SetHardwareComponentState",
    "switch_controller": "SwitchController",
    "unload_controller": "UnloadController",
}


class Control:
    """A client of a controller manager."""

    def __init__(self, client: Any, namespace: str = "") -> None:
        self._client = client
        self._prefix = f"{namespace}/controller_manager"
        self._services: dict[str, Any] = {}

    def call(self, service: str, **fields: Any) -> Any:
        """Call one of its services; a list is asked for again where no answer comes."""
        self.connect()
        client = self._services[service]
        attempts = 6 if service.startswith("list_") else 1
        for _ in range(attempts):
            answered = threading.Event()
            future = client.call_async(client.srv_type.Request(**fields))
            future.add_done_callback(lambda _, answered=answered: answered.set())
            if answered.wait(TIMEOUT_S / attempts):
                return future.result()
        pytest.fail(f"no answer from {self._prefix}/{service}")

    def ask(self, service: str, **fields: Any) -> Any:
        """Call one of its services, and do not wait; return the future of the answer."""
        self.connect()
        client = self._services[service]
        return client.call_async(client.srv_type.Request(**fields))

    def connect(self) -> None:
        """Make clients of its services, unless there are some; wait until it knows them."""
        if self._services:
            return
        import controller_manager_msgs.srv

        last = "list_controllers"
        for service in (*(name for name in SERVICES if name != last), last):
            type_ = getattr(controller_manager_msgs.srv, SERVICES[service])
            self._services[service] = self._client.node.create_client(
                type_, f"{self._prefix}/{service}"
            )
        for service, client in self._services.items():
            self._client.wait_until(client.service_is_ready, f"{self._prefix}/{service}")
        # If the server has not discovered its client yet, the answer is lost. It discovers them in
        # their order, so one who answers the last, which is asked again, knows all.
        self.call(last)

    def load(self, name: str) -> bool:
        return self.call("load_controller", name=name).ok

    def configure(self, name: str) -> bool:
        return self.call("configure_controller", name=name).ok

    def unload(self, name: str) -> bool:
        return self.call("unload_controller", name=name).ok

    def switch(
        self,
        activate: Sequence[str] = (),
        deactivate: Sequence[str] = (),
        strictness: int = 2,
        timeout_s: int = 30,
    ) -> Any:
        return self.call(
            "switch_controller",
            activate_controllers=list(activate),
            deactivate_controllers=list(deactivate),
            strictness=strictness,
            timeout=Duration(sec=timeout_s),
        )

    def start(self, *names: str) -> None:
        """Load, configure and activate."""
        for name in names:
            assert self.load(name)
            assert self.configure(name)
        answer = self.switch(names)
        assert answer.ok, answer.message

    def list(self) -> list[Any]:
        return list(self.call("list_controllers").controller)

    def states(self) -> dict[str, str]:
        return {controller.name: controller.state for controller in self.list()}

    def wait_for_states(self, **expected: str) -> None:
        self._client.wait_until(lambda: self.states() == expected, f"states {expected}")

    def unload_all(self) -> None:
        """Take every controller out."""
        states = self.states()
        self.switch((), [name for name, state in states.items() if state == "active"])
        for name in states:
            assert self.unload(name)


@pytest.fixture(scope="session")
def services() -> dict[str, str]:
    """Return the services of a controller manager and their types."""
    return SERVICES


@pytest.fixture
def client(client_for_file: Any) -> Iterator[Any]:
    """Return the file's client, from which each test's end points are gone after it."""
    with client_for_file.tidied():
        yield client_for_file


@pytest.fixture(scope="module")
def control_for_file(client_for_file: Any, manager: Program) -> Control:
    """Return a client of the module's manager."""
    control = Control(client_for_file)
    control.connect()
    return control


@pytest.fixture
def control(control_for_file: Control) -> Iterator[Control]:
    """Return a client of the module's manager, which is without controllers before and after."""
    yield control_for_file
    control_for_file.unload_all()


@pytest.fixture
def control_of(client: Any) -> Callable[[str], Control]:
    """Return a function that makes a client of the manager in a namespace."""
    return lambda namespace: Control(client, namespace)


@pytest.fixture
def get_parameter(client: Any) -> Callable[[str, str], Any]:
    """Return a function that returns a node's parameter, None where it has no such one."""
    return client.get_parameter


@pytest.fixture
def set_parameter(client: Any) -> Callable[..., Any]:
    """Return a function that sets a parameter of a node and returns the result."""

    def set_(node: str, name: str, value: Any) -> Any:
        kind = Parameter.Type.STRING_ARRAY if value == [] else None
        message = Parameter(name, kind, value).to_parameter_msg()
        request = SetParameters.Request(parameters=[message])
        return client.call(SetParameters, f"{node}/set_parameters", request).results[0]

    return set_
