"""What the processes get for an environment."""

import os
import sys
from pathlib import Path

from launch_py.child_environment import default_environment, for_program

GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
OWN_LIBRARIES = os.path.join(sys.prefix, "lib")


def defaults(environ, colours=False):
    return default_environment(environ, Path("/logs"), "@socket", colours)


def test_the_defaults():
    added = defaults({})
    assert added["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert added["AMENT_PREFIX_PATH"] == sys.prefix
    assert added["ROS_LOG_DIR"] == "/logs"
    assert added["PYTHONUNBUFFERED"] == "1"
    assert added["NOTIFY_SOCKET"] == "@socket"
    assert "RCUTILS_COLORIZED_OUTPUT" not in added


def test_what_the_user_has_set_stands():
    environ = {
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
        "FASTRTPS_DEFAULT_PROFILES_FILE": "/mine.xml",
        "ROS_LOG_DIR": "/my/logs",
    }
    assert not environ.keys() & defaults(environ).keys()


def test_an_inherited_notify_socket_is_replaced():
    assert defaults({"NOTIFY_SOCKET": "/run/systemd/notify"})["NOTIFY_SOCKET"] == "@socket"


def test_the_prefixes_of_the_user_come_first():
    added = defaults({"AMENT_PREFIX_PATH": "/ws/install"})
    assert added["AMENT_PREFIX_PATH"] == f"/ws/install:{sys.prefix}"


def test_colours_on_a_terminal():
    assert defaults({}, colours=True)["RCUTILS_COLORIZED_OUTPUT"] == "1"


def test_the_shipped_dds_profile_is_given():
    profile = Path(defaults(dict(os.environ))["FASTRTPS_DEFAULT_PROFILES_FILE"])
    assert profile.name == "dds_profile.xml"
    assert profile.is_file()


def test_this_python_keeps_the_guard_and_the_libraries():
    environ = {GUARD: "1", "LD_LIBRARY_PATH": OWN_LIBRARIES}
    assert for_program(sys.executable, environ) == environ


def test_another_program_gets_neither():
    environ = {GUARD: "1", "LD_LIBRARY_PATH": f"{OWN_LIBRARIES}:/opt/lib", "A": "1"}
    assert for_program("/usr/bin/python3", environ) == {"LD_LIBRARY_PATH": "/opt/lib", "A": "1"}


def test_without_the_guard_the_library_path_is_the_users():
    environ = {"LD_LIBRARY_PATH": OWN_LIBRARIES}
    assert for_program("/bin/true", environ) == environ
