"""`arm doctor` before anything runs: each check, with a real fault."""

import fcntl
import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest
from run_python import run_python

from arm_cli.doctor.diagnosis import Severity
from arm_cli.doctor.installation import (
    PLANNING_SAMPLES,
    check_compilers,
    check_interfaces,
    check_planning_interfaces,
    check_python,
    check_rclpy,
    check_rendering,
    check_shared_memory,
    check_wheels,
    try_python,
)
from arm_node.ros_distribution import ros_distribution

LONG_AGO_S = 1.0e9


@pytest.fixture
def environ():
    """This process's environment, without a sourced ROS."""
    sourced = ("PYTHONPATH", "ROS_DISTRO")
    return {name: value for name, value in os.environ.items() if name not in sourced}


@pytest.fixture
def shadow(tmp_path, environ):
    """Return a function that shadows an installed package by another, as a sourced ROS does."""

    def put(package: str, code: str) -> dict[str, str]:
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").write_text(code)
        return {**environ, "PYTHONPATH": str(tmp_path), "ROS_DISTRO": "humble"}

    return put


def test_a_failed_child_s_last_line_is_kept(environ):
    trial = try_python(["-c", "print('half'); raise OSError('no luck')"], environ)
    assert (trial.worked, trial.out, trial.complaint) == (False, "half\n", "OSError: no luck")
    silent = try_python(["-c", "import os; os.abort()"], environ)
    assert silent.complaint.endswith("ended with code -6")


def test_a_module_in_the_current_folder_takes_no_library_s_place(environ, tmp_path, monkeypatch):
    (tmp_path / "mujoco.py").write_text("raise SystemExit('the user's own')")
    monkeypatch.chdir(tmp_path)
    assert try_python(["-c", "import mujoco; print(mujoco.mj_step is not None)"], environ).worked


def test_this_python_is_supported():
    assert check_python().severity is Severity.OK


@pytest.mark.parametrize(
    ("version", "machine", "sentence"),
    [((3, 10), "x86_64", "no ROS wheels"), ((3, 12), "aarch64", "runs on Linux aarch64")],
)
def test_a_python_without_wheels_is_an_error(version, machine, sentence):
    finding = check_python(version, "Linux", machine)
    assert finding.severity is Severity.ERROR
    assert sentence in finding.sentence
    assert finding.fix


def test_rclpy_of_the_wheels_is_ok(environ):
    finding = check_rclpy(environ)
    assert finding.severity is Severity.OK, finding


def test_a_sourced_ros_that_does_not_load_is_an_error(shadow, tmp_path):
    finding = check_rclpy(shadow("rclpy", "raise ImportError('librcl.so')"))
    assert finding.severity is Severity.ERROR
    assert f"rclpy comes from {tmp_path / 'rclpy'}" in finding.sentence
    assert "ROS humble is sourced in this shell" in finding.sentence
    assert "ImportError: librcl.so" in finding.sentence
    assert "unset PYTHONPATH" in finding.fix


def test_a_sourced_ros_that_loads_is_a_warning(shadow, tmp_path):
    environ = shadow("rclpy", "")
    (tmp_path / "rclpy" / "node.py").touch()
    assert check_rclpy(environ).severity is Severity.WARNING


def test_the_distribution_is_named(environ):
    finding = check_rclpy({**environ, "ROS_DISTRO": ros_distribution()})
    assert finding.severity is Severity.OK
    assert f"rclpy of ROS 2 {ros_distribution().capitalize()} loads" in finding.sentence


def test_another_ros_in_the_shell_is_a_warning(environ):
    finding = check_rclpy({**environ, "ROS_DISTRO": "humble"})
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
    finding = check_wheels([str(tmp_path)])
    assert finding.severity is severity
    assert sentence in finding.sentence


def _install(folder: Path, name: str, version: str, *requirements: str) -> None:
    info = folder / f"{name}-{version}.dist-info"
    info.mkdir()
    lines = [f"Name: {name}", f"Version: {version}", *(f"Requires-Dist: {r}" for r in requirements)]
    (info / "METADATA").write_text("Metadata-Version: 2.1\n" + "\n".join(lines) + "\n")


def test_a_suite_that_is_not_installed_is_a_warning(tmp_path):
    assert check_wheels([str(tmp_path)]).severity is Severity.WARNING


def test_the_interface_packages_load(environ):
    finding = check_interfaces(environ)
    assert finding.severity is Severity.OK, finding


def test_an_interface_package_that_does_not_load_is_an_error(shadow):
    finding = check_interfaces(shadow("control_msgs", ""))
    assert finding.severity is Severity.ERROR
    assert "No module named 'control_msgs.msg'" in finding.sentence
    assert "pip install ./arm_interfaces" in finding.fix


def test_the_interface_packages_of_motion_planning_load(environ):
    finding = check_planning_interfaces(environ)
    assert finding.severity is Severity.OK, finding
    assert "moveit_msgs" in finding.sentence


def test_one_of_motion_planning_that_does_not_load_is_an_error(shadow):
    finding = check_planning_interfaces(shadow("moveit_msgs", ""))
    assert finding.severity is Severity.ERROR
    assert "pip install ./arm_moveit_interfaces" in finding.fix


def test_without_those_of_motion_planning_all_else_works(shadow):
    hide = "import sys; sys.modules.update(dict.fromkeys(" + repr(list(PLANNING_SAMPLES)) + "))"
    environ = shadow("hidden", "")
    Path(environ["PYTHONPATH"], "sitecustomize.py").write_text(hide)
    finding = check_planning_interfaces(environ)
    assert finding.severity is Severity.OK
    assert "only motion planning needs it" in finding.sentence


def test_the_compilers_work(environ):
    assert check_compilers(environ).severity is Severity.OK


@pytest.mark.parametrize("variable", ["CC", "CXX"])
def test_a_missing_compiler_is_named(environ, variable):
    finding = check_compilers({**environ, variable: "/no/such/compiler"})
    assert finding.severity is Severity.WARNING
    assert finding.sentence.startswith("/no/such/compiler cannot compile")
    assert "apt install gcc g++ python3-dev" in finding.fix


def test_a_search_path_without_compilers_is_a_warning(environ, tmp_path):
    environ = {**environ, "PATH": str(tmp_path)}
    assert check_compilers(environ).severity is Severity.WARNING


def test_a_picture_can_be_drawn(environ):
    finding = check_rendering(environ)
    assert finding.severity is not Severity.ERROR, finding


def test_without_opengl_it_is_drawn_by_ray_casting(environ, tmp_path):
    names = ("libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
    for name in names:
        (tmp_path / name).write_text("no library")
    path = os.pathsep.join([str(tmp_path), environ.get("LD_LIBRARY_PATH", "")])
    finding = check_rendering({**environ, "LD_LIBRARY_PATH": path})
    assert finding.severity is Severity.WARNING
    assert finding.sentence.startswith("no OpenGL: pictures are ray-cast")
    assert "apt install libegl1" in finding.fix


def test_a_driver_that_crashes_is_left_out(environ, tmp_path):
    for name in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):
        _crashing_library(tmp_path / name)
    path = os.pathsep.join([str(tmp_path), environ.get("LD_LIBRARY_PATH", "")])
    finding = check_rendering({**environ, "LD_LIBRARY_PATH": path})
    assert finding.severity is Severity.WARNING
    assert "(egl, osmesa failed)" in finding.sentence


def _crashing_library(file: Path) -> None:
    source = file.with_suffix(".c")
    source.write_text(
        "#include <stdlib.h>\n__attribute__((constructor)) void start(void) { abort(); }\n"
    )
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", file, source], check=True)


def test_rendering_without_mujoco_is_an_error(shadow):
    finding = check_rendering(shadow("mujoco", "raise ImportError('mujoco is broken')"))
    assert finding.severity is Severity.ERROR
    assert "mujoco is broken" in finding.sentence


def test_missing_shared_memory_is_an_error(tmp_path):
    finding = check_shared_memory(tmp_path / "gone")
    assert finding.severity is Severity.ERROR
    assert "cannot be written to" in finding.sentence


@pytest.mark.parametrize("prefix", ["fastrtps_", "fastdds_"])
def test_segments_of_dead_processes_are_told_from_those_of_living_ones(tmp_path, prefix):
    assert check_shared_memory(tmp_path).severity is Severity.OK
    for name in (f"{prefix}dead", f"{prefix}alive", f"{prefix}new"):
        (tmp_path / f"{name}_el").touch()
    for name in (f"{prefix}dead", f"{prefix}alive"):
        os.utime(tmp_path / f"{name}_el", (LONG_AGO_S, LONG_AGO_S))
    with open(tmp_path / f"{prefix}alive_el") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        finding = check_shared_memory(tmp_path)
    assert finding.severity is Severity.WARNING
    assert f"killed ROS processes left 1 segments there, such as {prefix}dead" in finding.sentence
    assert finding.fix.endswith(f"rm -f {tmp_path}/{prefix}* {tmp_path}/sem.{prefix}*")


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
    finding = check_shared_memory(tmp_path)
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert "--shm-size=1g" in finding.fix


def test_the_command_prints_findings_fixes_and_an_exit_code(environ):
    done = run_python(
        "-m", "arm_cli", "doctor", env={**environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    )
    assert done.returncode == 1, done.stderr
    assert "error    discovery: ROS_AUTOMATIC_DISCOVERY_RANGE is OFF" in done.stdout
    assert "-> export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in done.stdout
    assert "simulation: not checked" in done.stdout
    assert done.stdout.splitlines()[-1].startswith("1 error, ")


@pytest.mark.ros
@pytest.mark.parametrize(
    ("variable", "value", "fix"),
    [
        ("ROS_LOG_DIR", "/dev/null/logs", "set ROS_LOG_DIR to a folder that can be written to"),
        ("ROS_STATIC_PEERS", "no such host", "correct or unset ROS_STATIC_PEERS"),
    ],
)
def test_what_keeps_ros_from_starting_has_a_fix(environ, variable, value, fix):
    done = run_python("-m", "arm_cli", "doctor", env={**environ, variable: value})
    assert done.returncode == 1, done.stderr
    assert "error    simulation: cannot start ROS: " in done.stdout
    assert f"-> {fix}\n" in done.stdout
