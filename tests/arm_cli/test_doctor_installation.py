"""`arm doctor` before anything runs: each check, with the thing broken for real."""

import contextlib
import fcntl
import os
import socket
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from types import SimpleNamespace

import pytest

from arm_cli.doctor.client_library import ClientLibrary
from arm_cli.doctor.compiler import Compiler
from arm_cli.doctor.discovery import LARGEST_DOMAIN, Discovery
from arm_cli.doctor.finding import Severity
from arm_cli.doctor.interface_packages import InterfacePackages
from arm_cli.doctor.page_port import PagePort
from arm_cli.doctor.ports import Ports
from arm_cli.doctor.python_version import PythonVersion
from arm_cli.doctor.rendering import Rendering
from arm_cli.doctor.shared_memory import SharedMemory
from arm_cli.doctor.trial import try_python
from arm_cli.doctor.wheels import Wheels

LONG_AGO_S = 1.0e9


@pytest.fixture
def environ():
    """This process's environment, without a sourced ROS."""
    sourced = ("PYTHONPATH", "ROS_DISTRO")
    return {name: value for name, value in os.environ.items() if name not in sourced}


@pytest.fixture
def shadow(tmp_path, environ):
    """Return a function that puts a package before the installed ones, as a sourced ROS does."""

    def put(package: str, code: str) -> dict[str, str]:
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").write_text(code)
        return {**environ, "PYTHONPATH": str(tmp_path), "ROS_DISTRO": "humble"}

    return put


def test_a_child_that_fails_leaves_its_last_line(environ):
    trial = try_python(["-c", "print('half'); raise OSError('no luck')"], environ)
    assert (trial.worked, trial.out, trial.complaint) == (False, "half\n", "OSError: no luck")
    silent = try_python(["-c", "import os; os.abort()"], environ)
    assert silent.complaint.endswith("ended with code -6")


def test_this_python_is_right():
    assert PythonVersion().examine().severity is Severity.OK


@pytest.mark.parametrize(
    ("version", "machine", "sentence"),
    [((3, 10), "x86_64", "no ROS wheels"), ((3, 12), "aarch64", "runs on Linux aarch64")],
)
def test_a_python_without_wheels_is_an_error(version, machine, sentence):
    finding = PythonVersion(version, "Linux", machine).examine()
    assert finding.severity is Severity.ERROR
    assert sentence in finding.sentence
    assert finding.fix


def test_rclpy_of_the_wheels_is_right(environ):
    finding = ClientLibrary(environ).examine()
    assert finding.severity is Severity.OK, finding


def test_a_sourced_ros_that_does_not_load_is_an_error(shadow, tmp_path):
    finding = ClientLibrary(shadow("rclpy", "raise ImportError('librcl.so')")).examine()
    assert finding.severity is Severity.ERROR
    assert f"rclpy comes from {tmp_path / 'rclpy'}" in finding.sentence
    assert "ROS humble is sourced in this shell" in finding.sentence
    assert "ImportError: librcl.so" in finding.sentence
    assert "unset PYTHONPATH" in finding.fix


def test_a_sourced_ros_that_loads_is_a_warning(shadow, tmp_path):
    environ = shadow("rclpy", "")
    (tmp_path / "rclpy" / "node.py").touch()
    assert ClientLibrary(environ).examine().severity is Severity.WARNING


def test_another_ros_in_the_shell_is_a_warning(environ):
    finding = ClientLibrary({**environ, "ROS_DISTRO": "humble"}).examine()
    assert finding.severity is Severity.WARNING
    assert "ROS humble is sourced" in finding.sentence


@pytest.mark.parametrize(
    ("requirement", "severity", "sentence"),
    [
        ("other>=1", Severity.OK, "arm-suite 0.1 and its 1 requirements"),
        ("other[fast]==1.5", Severity.OK, "1 requirements"),
        ("other==2.0", Severity.ERROR, "other is 1.5 instead of 2.0"),
        ("gone>=1", Severity.ERROR, "gone is not installed"),
        ("gone>=1; extra == 'test'", Severity.OK, "0 requirements"),
    ],
)
def test_wheels(tmp_path, requirement, severity, sentence):
    _install(tmp_path, "arm_suite", "0.1", requirement)
    _install(tmp_path, "other", "1.5")
    finding = Wheels([str(tmp_path)]).examine()
    assert finding.severity is severity
    assert sentence in finding.sentence


def _install(folder: Path, name: str, version: str, *requirements: str) -> None:
    info = folder / f"{name}-{version}.dist-info"
    info.mkdir()
    lines = [f"Name: {name}", f"Version: {version}", *(f"Requires-Dist: {r}" for r in requirements)]
    (info / "METADATA").write_text("Metadata-Version: 2.1\n" + "\n".join(lines) + "\n")


def test_a_suite_that_is_not_installed_is_a_warning(tmp_path):
    assert Wheels([str(tmp_path)]).examine().severity is Severity.WARNING


def test_the_interface_packages_load(environ):
    finding = InterfacePackages(environ).examine()
    assert finding.severity is Severity.OK, finding


def test_an_interface_package_that_does_not_load_is_an_error(shadow):
    finding = InterfacePackages(shadow("control_msgs", "")).examine()
    assert finding.severity is Severity.ERROR
    assert "No module named 'control_msgs.msg'" in finding.sentence
    assert "pip install ./arm_interfaces" in finding.fix


def test_the_compilers_work(environ):
    assert Compiler(environ).examine().severity is Severity.OK


@pytest.mark.parametrize("variable", ["CC", "CXX"])
def test_a_missing_compiler_is_named(environ, variable):
    finding = Compiler({**environ, variable: "/no/such/compiler"}).examine()
    assert finding.severity is Severity.WARNING
    assert finding.sentence.startswith("/no/such/compiler cannot compile")
    assert "apt install gcc g++ python3-dev" in finding.fix


def test_a_search_path_without_compilers_is_a_warning(environ, tmp_path):
    environ = {**environ, "PATH": str(tmp_path)}
    assert Compiler(environ).examine().severity is Severity.WARNING


def test_a_picture_is_drawn_with_something(environ):
    finding = Rendering(environ).examine()
    assert finding.severity is not Severity.ERROR, finding


def test_without_opengl_it_is_drawn_by_ray_casting(environ, tmp_path):
    names = ("libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
    for name in names:
        (tmp_path / name).write_text("no library")
    path = os.pathsep.join([str(tmp_path), environ.get("LD_LIBRARY_PATH", "")])
    finding = Rendering({**environ, "LD_LIBRARY_PATH": path}).examine()
    assert finding.severity is Severity.WARNING
    assert finding.sentence.startswith("no OpenGL: pictures are ray-cast")
    assert "apt install libegl1" in finding.fix


def test_a_driver_that_crashes_is_left_out(environ, tmp_path):
    for name in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):
        _crashing_library(tmp_path / name)
    path = os.pathsep.join([str(tmp_path), environ.get("LD_LIBRARY_PATH", "")])
    finding = Rendering({**environ, "LD_LIBRARY_PATH": path}).examine()
    assert finding.severity is Severity.WARNING
    assert "(egl, osmesa failed)" in finding.sentence


def _crashing_library(file: Path) -> None:
    source = file.with_suffix(".c")
    source.write_text(
        "#include <stdlib.h>\n__attribute__((constructor)) void start(void) { abort(); }\n"
    )
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", file, source], check=True)


def test_rendering_without_mujoco_is_an_error(shadow):
    finding = Rendering(shadow("mujoco", "raise ImportError('mujoco is broken')")).examine()
    assert finding.severity is Severity.ERROR
    assert "mujoco is broken" in finding.sentence


def test_shared_memory_that_is_not_there_is_an_error(tmp_path):
    finding = SharedMemory(tmp_path / "gone").examine()
    assert finding.severity is Severity.ERROR
    assert "cannot be written to" in finding.sentence


def test_leftovers_of_the_dead_are_told_from_the_living(tmp_path):
    assert SharedMemory(tmp_path).examine().severity is Severity.OK
    for name in ("fastrtps_dead", "fastrtps_alive", "fastrtps_new"):
        (tmp_path / f"{name}_el").touch()
    for name in ("fastrtps_dead", "fastrtps_alive"):
        os.utime(tmp_path / f"{name}_el", (LONG_AGO_S, LONG_AGO_S))
    with open(tmp_path / "fastrtps_alive_el") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        finding = SharedMemory(tmp_path).examine()
    assert finding.severity is Severity.WARNING
    assert "1 segments of killed ROS processes are left there, such as fastrtps_dead" in (
        finding.sentence
    )


@pytest.mark.parametrize(
    ("free_bytes", "severity", "sentence"),
    [
        (1 << 20, Severity.ERROR, "only 1 MiB free"),
        (64 << 20, Severity.WARNING, "large pictures may be lost"),
    ],
)
def test_little_shared_memory(tmp_path, monkeypatch, free_bytes, severity, sentence):
    full = SimpleNamespace(f_bavail=free_bytes >> 12, f_frsize=1 << 12)
    monkeypatch.setattr(os, "statvfs", lambda _folder: full)
    finding = SharedMemory(tmp_path).examine()
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert "--shm-size=1g" in finding.fix


@pytest.mark.parametrize(
    ("variables", "severity", "sentence"),
    [
        ({}, Severity.OK, "ROS_DOMAIN_ID 0, range not set"),
        ({"ROS_DOMAIN_ID": "42"}, Severity.OK, "ROS_DOMAIN_ID 42"),
        ({"ROS_DOMAIN_ID": "150"}, Severity.WARNING, "0 to 101 are safe"),
        ({"ROS_DOMAIN_ID": "233"}, Severity.ERROR, "no number from 0 to 232"),
        ({"ROS_DOMAIN_ID": "mine"}, Severity.ERROR, "'mine'"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, Severity.ERROR, "nobody finds anybody"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "HERE"}, Severity.ERROR, "there are SUBNET"),
        ({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}, Severity.ERROR, "rmw_fastrtps_cpp only"),
    ],
)
def test_discovery(variables, severity, sentence):
    finding = Discovery(variables).examine()
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert bool(finding.fix) is (severity is not Severity.OK)


@pytest.fixture
def taken_domain():
    """Return a domain whose port for announcements somebody has for himself."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        for domain in range(LARGEST_DOMAIN, 101, -1):
            with contextlib.suppress(OSError):
                stranger.bind(("", 7400 + 250 * domain))
                yield str(domain)
                return
        pytest.fail("no domain has a port left")


@pytest.mark.parametrize(
    ("reach", "severity", "sentence"),
    [
        ("", Severity.WARNING, "programs without ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST do not"),
        ("SUBNET", Severity.ERROR, "nobody finds anybody"),
        ("LOCALHOST", Severity.OK, "on this machine it is not needed"),
    ],
)
def test_a_port_that_another_program_has(taken_domain, reach, severity, sentence):
    variables = {"ROS_DOMAIN_ID": taken_domain, "ROS_AUTOMATIC_DISCOVERY_RANGE": reach}
    finding = Ports(variables).examine()
    assert finding.severity is severity
    assert f"for announcements in domain {taken_domain}, is taken" in finding.sentence
    assert sentence in finding.sentence
    assert ("ss -ulpn" in finding.fix) is (severity is not Severity.OK)


def test_ports_that_are_shared_as_fast_dds_does_are_right():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
        participant.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        participant.bind(("", 7400 + 250 * LARGEST_DOMAIN))
        finding = Ports({"ROS_DOMAIN_ID": str(LARGEST_DOMAIN)}).examine()
    assert finding.severity is Severity.OK, finding
    assert str(7400 + 250 * LARGEST_DOMAIN) in finding.sentence


def test_a_domain_that_is_none_has_no_port():
    finding = Ports({"ROS_DOMAIN_ID": "mine"}).examine()
    assert finding.severity is Severity.OK, finding
    assert "127.0.0.1" in finding.sentence


@pytest.mark.parametrize(
    ("addresses", "severity", "sentence"),
    [
        # Addresses for documentation, which no machine has, and for no use at all.
        ({"here": "192.0.2.1"}, Severity.ERROR, "what is sent to 192.0.2.1 does not arrive"),
        ({"group": "240.0.0.1"}, Severity.WARNING, "multicast to 240.0.0.1 does not arrive"),
    ],
)
def test_a_network_that_lets_nothing_pass(addresses, severity, sentence):
    variables = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_DOMAIN_ID": str(LARGEST_DOMAIN)}
    finding = Ports(variables, **addresses).examine()
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert finding.fix


@pytest.fixture
def serve():
    """Return a function that serves a text by HTTP and returns the port."""
    with contextlib.ExitStack() as servers:

        def start(text: str) -> int:
            class Page(BaseHTTPRequestHandler):
                def do_GET(self) -> None:
                    self.send_response(200)
                    self.end_headers()
                    self.wfile.write(text.encode())

                def log_message(self, format: str, *args: object) -> None:
                    pass

            server = servers.enter_context(HTTPServer(("127.0.0.1", 0), Page))
            thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
            thread.start()
            servers.callback(thread.join)
            servers.callback(server.shutdown)
            return server.server_port

        yield start


def test_the_pages_port_is_free_or_a_pages(serve):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    assert PagePort(port).examine().sentence == f"port {port} is free for it"
    page = PagePort(serve("<title>Viser</title>")).examine()
    assert page.severity is Severity.OK
    assert "there is one on http://127.0.0.1:" in page.sentence


def test_a_page_port_that_another_program_has_is_a_warning(serve):
    finding = PagePort(serve("<title>My notes</title>")).examine()
    assert finding.severity is Severity.WARNING
    assert "is taken by another program" in finding.sentence
    assert "ss -tlpn" in finding.fix


def test_a_page_port_where_nothing_speaks_http_is_a_warning():
    with socket.socket() as stranger:
        stranger.bind(("127.0.0.1", 0))
        # Bound, not listening: whoever connects is turned away.
        assert PagePort(stranger.getsockname()[1]).examine().severity is Severity.WARNING


def test_the_command_says_it_with_the_fix_and_an_exit_code(environ):
    done = subprocess.run(
        [sys.executable, "-m", "arm_cli", "doctor"],
        env={**environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 1, done.stderr
    assert "error    discovery: ROS_AUTOMATIC_DISCOVERY_RANGE is OFF" in done.stdout
    assert "-> export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in done.stdout
    assert "simulation: not looked at" in done.stdout
    assert done.stdout.splitlines()[-1].startswith("1 error, ")
