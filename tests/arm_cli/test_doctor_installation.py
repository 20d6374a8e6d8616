"""`arm doctor` before anything runs: each check, with the thing broken for real."""

import fcntl
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from arm_cli.doctor.client_library import ClientLibrary
from arm_cli.doctor.compiler import Compiler
from arm_cli.doctor.discovery import Discovery
from arm_cli.doctor.finding import Severity
from arm_cli.doctor.interface_packages import InterfacePackages
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
