"""Checks of the installation and the machine: from Python and the wheels to free resources."""

import os
import platform
import re
import shlex
import socket
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException
from importlib.metadata import Distribution
from pathlib import Path

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.names import this_domain
from arm_node.ros_distribution import ros_distribution
from launch_py.fast_dds.shared_memory import lock_files, lock_names, locked_segments

TIMEOUT_S = 60.0
OLDEST, NEWEST = (3, 11), (3, 13)
SYSTEM, MACHINE = "Linux", "x86_64"
SUITE = "arm-suite"
INSTALL = "pip install . from the arm suite's folder"
REQUIREMENT = re.compile(r"(?P<name>[\w.-]+)(\[[^]]*\])?\s*(==\s*(?P<version>[\w.]+))?")
IMPORT_RCLPY = (
    "import importlib.util as u; s = u.find_spec('rclpy'); print(s.origin if s else ''); "
    "import rclpy.node"
)
OPEN_ANOTHER = (
    "use a terminal in which no setup.bash was sourced, or: "
    "unset PYTHONPATH AMENT_PREFIX_PATH LD_LIBRARY_PATH ROS_DISTRO; "
    "also look for `source /opt/ros/...` in ~/.bashrc"
)
IMPORT_INTERFACES = """
import importlib, sys
for name, member in zip(sys.argv[1::2], sys.argv[2::2]):
    getattr(importlib.import_module(name), member).__class__.__import_type_support__()
"""
SAMPLES = {
    "tf2_msgs": ("tf2_msgs.msg", "TFMessage"),
    "control_msgs": ("control_msgs.msg", "DynamicJointState"),
    "controller_manager_msgs": ("controller_manager_msgs.srv", "ListControllers"),
    "simulation_interfaces": ("simulation_interfaces.msg", "Result"),
    "pal_statistics_msgs": ("pal_statistics_msgs.msg", "Statistics"),
}
"""One type of each interface package that is missing in the ROS wheels."""
PLANNING_SAMPLES = {
    "moveit_msgs": ("moveit_msgs.msg", "PlanningScene"),
    "octomap_msgs": ("octomap_msgs.msg", "Octomap"),
    "object_recognition_msgs": ("object_recognition_msgs.msg", "ObjectType"),
}
"""The same of those that only motion planning needs."""
COMPILERS = (("CC", "gcc", "part.c"), ("CXX", "g++", "part.cpp"))
INSTALL_COMPILERS = (
    "needed only to reinstall arm_interfaces; on Debian and Ubuntu: apt install gcc g++ python3-dev"
)
PYTHON_SOURCE = "#include <Python.h>\n"
RENDERING_PROBE = "arm_gazebo.rendering.backend_selection"
RAYCAST = "raycast"
INSTALL_OPENGL = "apt install libegl1 libgl1-mesa-dri (or libosmesa6)"


@dataclass(frozen=True, slots=True)
class Trial:
    """The result of a command that was tried in a child process.

    The complaint is its last line on stderr, or how it ended.
    """

    worked: bool
    out: str
    complaint: str


def try_command(command: Sequence[str], environ: Mapping[str, str]) -> Trial:
    """Run a command and wait for its end. It may crash without affecting this process."""
    try:
        done = subprocess.run(
            command,
            env=dict(environ),
            capture_output=True,
            text=True,
            errors="replace",
            stdin=subprocess.DEVNULL,
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Trial(False, "", f"{command[0]} did not end within {TIMEOUT_S:g} s")
    except OSError as error:
        return Trial(False, "", f"{command[0]}: {error.strerror}")
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    ended = f"{command[0]} ended with code {done.returncode}"
    return Trial(done.returncode == 0, done.stdout, lines[-1].strip() if lines else ended)


def try_python(words: Sequence[str], environ: Mapping[str, str]) -> Trial:
    """Run this Python with some arguments. Modules of the current folder do not count."""
    return try_command([sys.executable, "-P", *words], environ)


def check_python(
    version: tuple[int, int] = sys.version_info[:2], system: str = "", machine: str = ""
) -> Diagnosis:
    """Check that ROS wheels exist for this interpreter and machine."""
    name = "python"
    system, machine = system or platform.system(), machine or platform.machine()
    here = f"Python {version[0]}.{version[1]} at {sys.executable}"
    if (system, machine) != (SYSTEM, MACHINE):
        return Diagnosis.error(
            name,
            f"{here} runs on {system} {machine}; the ROS wheels exist for {SYSTEM} {MACHINE} only",
            "use such a machine, a virtual machine or a container",
        )
    if not OLDEST <= version <= NEWEST:
        return Diagnosis.error(
            name,
            f"there are no ROS wheels for {here}, only for Python 3.11 to 3.13",
            "python3.12 -m venv .venv && source .venv/bin/activate, and install again",
        )
    return Diagnosis.ok(name, here)


def check_rclpy(environ: Mapping[str, str]) -> Diagnosis:
    """Check that rclpy can be imported, and that a sourced ROS does not hide the wheels' rclpy."""
    name = "rclpy"
    trial = try_python(["-c", IMPORT_RCLPY], environ)
    origin = trial.out.strip()
    if not origin:
        return Diagnosis.error(name, "rclpy is not installed for this Python", INSTALL)
    folder = Path(origin).parent
    which = _describe_sourced(environ)
    if _is_sourced(origin, environ):
        sourced = f"rclpy comes from {folder}, by PYTHONPATH: {which}"
        if trial.worked:
            return Diagnosis.warning(name, f"{sourced}; the wheels are not used", OPEN_ANOTHER)
        return Diagnosis.error(
            name, f"{sourced}, which does not load: {trial.complaint}", OPEN_ANOTHER
        )
    if not trial.worked:
        return Diagnosis.error(
            name,
            f"rclpy from {folder} does not load: {trial.complaint}",
            OPEN_ANOTHER if environ.get("ROS_DISTRO") else f"{INSTALL}, again",
        )
    distribution = ros_distribution()
    if environ.get("ROS_DISTRO", distribution) != distribution:
        return Diagnosis.warning(
            name,
            f"rclpy loads from {folder}, but {which}: its libraries may interfere, and its "
            "messages differ",
            OPEN_ANOTHER,
        )
    return Diagnosis.ok(name, f"rclpy of ROS 2 {distribution.capitalize()} loads from {folder}")


def check_wheels(path: Sequence[str] | None = None) -> Diagnosis:
    """Check that distributions, by default this Python's, meet the suite's requirements."""
    name = "wheels"
    folders = list(sys.path) if path is None else list(path)
    suite = _find(SUITE, folders)
    if suite is None:
        return Diagnosis.warning(
            name, f"{SUITE} is not installed by pip but runs from a folder", INSTALL
        )
    wanted = [r for r in suite.requires or [] if "extra ==" not in r]
    faults = [fault for requirement in wanted if (fault := _unmet(requirement, folders))]
    if faults:
        return Diagnosis.error(name, "; ".join(faults), INSTALL)
    return Diagnosis.ok(name, f"{SUITE} {suite.version} and its {len(wanted)} requirements")


def check_interfaces(environ: Mapping[str, str]) -> Diagnosis:
    """Load a type of each interface package with its compiled part, in a child process."""
    return _check_samples("arm_interfaces", SAMPLES, environ)


def check_planning_interfaces(environ: Mapping[str, str]) -> Diagnosis:
    """Load those of motion planning likewise; the suite does without them otherwise."""
    name = "arm_moveit_interfaces"
    find = f"from importlib.util import find_spec as f; print(*map(f, {tuple(PLANNING_SAMPLES)!r}))"
    if set(try_python(["-c", find], environ).out.split()) == {"None"}:
        return Diagnosis.ok(name, "not installed; only motion planning needs it")
    return _check_samples(name, PLANNING_SAMPLES, environ)


def _check_samples(
    name: str, samples: Mapping[str, tuple[str, str]], environ: Mapping[str, str]
) -> Diagnosis:
    words = [word for sample in samples.values() for word in sample]
    trial = try_python(["-c", IMPORT_INTERFACES, *words], environ)
    if not trial.worked:
        return Diagnosis.error(
            name,
            f"the interface packages do not load: {trial.complaint}",
            f"pip install ./{name} from the arm suite's folder; it compiles for a minute",
        )
    return Diagnosis.ok(name, f"{', '.join(samples)} load")


def check_compilers(environ: Mapping[str, str]) -> Diagnosis:
    """Compile a file that includes Python.h as C and as C++, with `CC` and `CXX` if set."""
    name = "compiler"
    names: list[str] = []
    for variable, usual, file in COMPILERS:
        command = shlex.split(environ.get(variable) or usual)
        trial = _compile(command, file, environ)
        if not trial.worked:
            sentence = f"{command[0]} cannot compile against Python.h: {trial.complaint}"
            return Diagnosis.warning(name, sentence, INSTALL_COMPILERS)
        names.append(command[0])
    return Diagnosis.ok(name, f"{' and '.join(names)} compile against Python.h")


def check_rendering(environ: Mapping[str, str]) -> Diagnosis:
    """Draw one picture in a child process, as the camera process does.

    The child chooses a backend. A backend that fails is left out of the next try, as with cameras.
    """
    failed: list[str] = []
    while True:
        trial = try_python(["-m", RENDERING_PROBE, *failed], {**environ, "MUJOCO_GL": "off"})
        tried = trial.out.split()
        if trial.worked and tried:
            return _describe_backend(tried[-1], failed, trial.complaint)
        if not tried or tried[-1] in (*failed, RAYCAST):
            return Diagnosis.error(
                "rendering",
                f"no picture can be drawn: {trial.complaint}",
                "pip install . from the arm suite's folder; without cameras: camera:=none",
            )
        failed.append(tried[-1])


def _is_sourced(origin: str, environ: Mapping[str, str]) -> bool:
    folders = environ.get("PYTHONPATH", "").split(os.pathsep)
    return any(f and Path(origin).is_relative_to(f) for f in folders)


def _describe_sourced(environ: Mapping[str, str]) -> str:
    distribution = environ.get("ROS_DISTRO")
    return f"ROS {distribution} is sourced in this shell" if distribution else "not from a wheel"


def _unmet(requirement: str, path: list[str]) -> str | None:
    """Return why a requirement is not met, or None if it is."""
    match = REQUIREMENT.match(requirement)
    if match is None:
        return None
    found, version = _find(match["name"], path), match["version"]
    if found is None:
        return f"{match['name']} is not installed"
    if version and found.version != version:
        return f"{match['name']} is {found.version} instead of {version}"
    return None


def _find(name: str, path: list[str]) -> Distribution | None:
    return next(iter(Distribution.discover(name=name, path=path)), None)


def _compile(command: list[str], file: str, environ: Mapping[str, str]) -> Trial:
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / file
        source.write_text(PYTHON_SOURCE)
        include = f"-I{sysconfig.get_path('include')}"
        words = [*command, include, "-c", str(source), "-o", f"{source}.o"]
        return try_command(words, environ)


def _describe_backend(backend: str, failed: list[str], complaint: str) -> Diagnosis:
    if backend == RAYCAST:
        why = f"{', '.join(failed)} failed" if failed else complaint
        return Diagnosis.warning(
            "rendering",
            f"no OpenGL: pictures are ray-cast, slower and plainer ({why})",
            INSTALL_OPENGL,
        )
    return Diagnosis.ok("rendering", f"a picture was drawn with {backend}")


SHARED_MEMORY = Path("/dev/shm")
NEEDED_BYTES = 8 << 20
ROOMY_BYTES = 128 << 20
"""Below this, cameras use smaller buffers. Docker's default is 64 MiB."""
LEAST_AGE_S = 30.0
"""Younger segments are ignored, because a process locks its segment a moment after creating it."""
HOST, PORT = "127.0.0.1", 8080
HTTP_TIMEOUT_S = 2.0
OWNER_HEADER = "Arm-Suite-Page"
"""A header of the page's answers: its user id and ROS domain, and its address if it has tokens."""


def check_shared_memory(folder: Path = SHARED_MEMORY) -> Diagnosis:
    """Check the shared-memory folder of Fast DDS and the cameras.

    It must be writable and have enough space. Segments left by killed processes are reported.
    """
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"0")
        status = os.statvfs(folder)
    except OSError as error:
        return Diagnosis.error(
            "shared memory",
            f"{folder} cannot be written to: {error.strerror}",
            f"sudo mount -o remount,rw,mode=1777 {folder}; in a container: --shm-size=1g",
        )
    return _judge_space(folder, status.f_bavail * status.f_frsize, _abandoned_segments(folder))


def _judge_space(folder: Path, free_bytes: int, abandoned: list[str]) -> Diagnosis:
    free = f"{free_bytes >> 20} MiB free in {folder}"
    more = f"sudo mount -o remount,size=1g {folder}; in a container: --shm-size=1g"
    if free_bytes < NEEDED_BYTES:
        return Diagnosis.error("shared memory", f"only {free}", more)
    if free_bytes < ROOMY_BYTES:
        return Diagnosis.warning("shared memory", f"{free}: large pictures may be lost", more)
    if abandoned:
        prefix = f"{abandoned[0].partition('_')[0]}_"
        return Diagnosis.warning(
            "shared memory",
            f"{free}; killed ROS processes left {len(abandoned)} segments there, "
            f"such as {abandoned[0]}",
            f"when no ROS program runs: rm -f {folder}/{prefix}* {folder}/sem.{prefix}*",
        )
    return Diagnosis.ok("shared memory", free)


def _abandoned_segments(folder: Path) -> list[str]:
    """Return the segments that no process owns."""
    free = lock_files(str(folder)).keys() - locked_segments(str(folder))
    return sorted(s for s in free if any(_is_old(folder / name) for name in lock_names(s)))


def _is_old(lock: Path) -> bool:
    with suppress(OSError):
        return time.time() - lock.stat().st_mtime >= LEAST_AGE_S
    return False


def check_page_port(port: int = PORT) -> Diagnosis:
    """Check that the page's TCP port is free, or taken by a page of this user and domain."""
    if _is_free(port):
        return Diagnosis.ok("page", f"port {port} is free for the page")
    other = "arm view --port 8081, arm launch viewer:=true viewer_port:=8081"
    owner = _page_owner(port)
    if owner is None:
        return Diagnosis.warning(
            "page",
            f"port {port} is taken by another program",
            f"ss -tlpn 'sport = :{port}' shows which; end it, or use another port for the page: "
            f"{other}",
        )
    user, domain, host = [*owner.split(" "), "", ""][:3]
    strange = [f"user {user}"] * (user != str(os.getuid()))
    strange += [f"ROS_DOMAIN_ID={domain}"] * (f"ROS_DOMAIN_ID={domain}" != this_domain())
    if strange:
        return Diagnosis.warning(
            "page",
            f"the page on http://{HOST}:{port} is that of {' and '.join(strange)}, not of "
            f"user {os.getuid()} on {this_domain()}",
            f"use another port for a page of your own: {other}",
        )
    reach = f"; on {host} it serves other machines, with a token" if host else ""
    return Diagnosis.ok("page", f"a page is running on http://{HOST}:{port}{reach}")


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        # Ignore remaining connections of a page that has ended.
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError:
            return False
        return True


def _page_owner(port: int) -> str | None:
    """Return the user id and the ROS domain of a page, or None if there is no page."""
    connection = HTTPConnection(HOST, port, timeout=HTTP_TIMEOUT_S)
    try:
        connection.request("GET", "/")
        return connection.getresponse().getheader(OWNER_HEADER)
    except (OSError, HTTPException):
        return None
    finally:
        connection.close()
