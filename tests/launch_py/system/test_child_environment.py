"""The environment of launched processes."""

import os
import sys
from pathlib import Path

import pytest

from launch_py.system.child_environment import default_environment, for_program
from launch_py.system.dds_profile import OF_FAST_DDS_2, profile_variables

VARIABLE, *_ = profile_variables(os.environ)
STEM = "dds_profile" if VARIABLE == OF_FAST_DDS_2 else "dds_profile_fast_dds_3"
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


def test_variables_of_the_user_are_kept():
    environ = {
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
        VARIABLE: "/mine.xml",
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
    profile = Path(defaults(dict(os.environ))[VARIABLE])
    assert profile.name == f"{STEM}.xml"
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


def _network(program: str, **environ: str) -> tuple[str, str]:
    adapted = for_program(program, environ)
    return adapted["ROS_AUTOMATIC_DISCOVERY_RANGE"], Path(adapted[VARIABLE]).name


def test_localhost_means_the_profile_that_listens_on_loopback_only():
    given = defaults(dict(os.environ) | {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"})
    given["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    for program in (sys.executable, "/usr/bin/other"):
        assert _network(program, **given) == ("SYSTEM_DEFAULT", f"{STEM}_localhost.xml")


@pytest.mark.parametrize(
    "wish",
    [
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"},
        {"ROS_STATIC_PEERS": "192.0.2.7"},
        {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"},
    ],
)
def test_any_other_range_keeps_the_general_profile(wish):
    given = {**defaults({}), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **wish}
    assert _network(sys.executable, **given) == (
        given["ROS_AUTOMATIC_DISCOVERY_RANGE"],
        f"{STEM}.xml",
    )


@pytest.mark.parametrize("names", ["local_profile", "discovery, local_profile", "all"])
def test_the_profile_for_this_host_can_be_switched_off(names):
    given = {**defaults({}), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ARM_WITHOUT": names}
    assert _network(sys.executable, **given) == ("LOCALHOST", f"{STEM}.xml")


def test_a_profile_of_the_users_own_stays(tmp_path):
    mine = tmp_path / "mine.xml"
    given = {**defaults({}), VARIABLE: str(mine)}
    assert _network(sys.executable, **given) == ("LOCALHOST", "mine.xml")
