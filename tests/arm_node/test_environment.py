"""What `prepare_environment` does to the environment of a process."""

import importlib.util
import sys

import pytest

from arm_node.environment import (
    LOGGING_SWITCHES,
    PLANNING_PACKAGES,
    InvalidDomainError,
    InvalidLoggingError,
    MissingInterfacesError,
    MissingMiddlewareError,
    MissingSecurityError,
    prepare_environment,
)


def test_this_pythons_prefix_is_searched_for_packages():
    environment = {"HOME": "/home/me"}
    prepare_environment(environment)
    assert environment["AMENT_PREFIX_PATH"] == sys.prefix


def test_what_the_user_sourced_is_kept_and_comes_first():
    environment = {"HOME": "/home/me", "AMENT_PREFIX_PATH": "/opt/ros/jazzy"}
    prepare_environment(environment)
    assert environment["AMENT_PREFIX_PATH"] == f"/opt/ros/jazzy:{sys.prefix}"


def test_a_process_without_home_gets_a_log_folder():
    environment: dict[str, str] = {}
    prepare_environment(environment)
    assert environment["ROS_LOG_DIR"]


def test_a_missing_interface_package_is_named_with_the_fix(monkeypatch):
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "tf2_msgs" else found(name)
    )
    with pytest.raises(MissingInterfacesError, match=r"tf2_msgs is not.*pip install"):
        prepare_environment({"HOME": "/home/me"})


def test_further_interface_packages_are_named_with_their_own_fix(monkeypatch):
    found = importlib.util.find_spec
    hidden = {"moveit_msgs"}
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name in hidden else found(name)
    )
    prepare_environment({"HOME": "/home/me"})
    with pytest.raises(MissingInterfacesError) as missing:
        prepare_environment({"HOME": "/home/me"}, PLANNING_PACKAGES)
    assert "package moveit_msgs is not" in str(missing.value)
    assert "'pip install ./arm_moveit_interfaces'" in str(missing.value)
    hidden.add("tf2_msgs")
    with pytest.raises(MissingInterfacesError, match=r"\./arm_interfaces \./arm_moveit_interfaces"):
        prepare_environment({"HOME": "/home/me"}, PLANNING_PACKAGES)


@pytest.mark.parametrize("text", ["abc", "-1", "233", "1e1", "0x5", "1.0", "\u0663", "4294967296"])
def test_an_invalid_domain_is_refused(text):
    with pytest.raises(InvalidDomainError) as refused:
        prepare_environment({"HOME": "/home/me", "ROS_DOMAIN_ID": text})
    assert str(refused.value) == (
        f"ROS_DOMAIN_ID is {text!r}; it must be a whole number from 0 to 232"
    )


@pytest.mark.parametrize("text", ["", "0", " 7 ", "007", "232"])
def test_what_ros_takes_for_a_domain_is_left_as_it_is(text):
    environment = {"HOME": "/home/me", "ROS_DOMAIN_ID": text}
    prepare_environment(environment)
    assert environment["ROS_DOMAIN_ID"] == text


@pytest.mark.parametrize("name", LOGGING_SWITCHES)
def test_a_logging_switch_that_ros_does_not_know_is_refused(name):
    with pytest.raises(InvalidLoggingError) as refused:
        prepare_environment({"HOME": "/home/me", name: "true"})
    assert str(refused.value) == f"{name} is 'true'; it must be 0 or 1"


@pytest.mark.parametrize("value", ["", "0", "1"])
def test_a_logging_switch_that_ros_knows_is_left_as_it_is(value):
    environment = {"HOME": "/home/me", "RCUTILS_COLORIZED_OUTPUT": value}
    prepare_environment(environment)
    assert environment["RCUTILS_COLORIZED_OUTPUT"] == value


ENFORCED = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Enforce"}


def test_security_that_the_wheels_lack_is_refused():
    with pytest.raises(MissingSecurityError) as refused:
        prepare_environment({"HOME": "/home/me"} | ENFORCED)
    assert str(refused.value).endswith("is built without security: unset ROS_SECURITY_ENABLE")


@pytest.mark.parametrize(
    "changed", [{"ROS_SECURITY_STRATEGY": ""}, {"ROS_SECURITY_ENABLE": "TRUE"}]
)
def test_security_that_ros_does_not_enforce_is_left_as_it_is(changed):
    environment = {"HOME": "/home/me"} | ENFORCED | changed
    prepare_environment(environment)
    assert environment.items() >= (ENFORCED | changed).items()


def test_the_security_of_a_sourced_ros_is_left_as_it_is(monkeypatch, tmp_path):
    (tmp_path / "rclpy.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    # Another test of this process may have imported it.
    monkeypatch.delitem(sys.modules, "rclpy", raising=False)
    environment = {"HOME": "/home/me"} | ENFORCED
    prepare_environment(environment)
    assert environment.items() >= ENFORCED.items()


def test_a_middleware_that_is_not_installed_is_refused():
    with pytest.raises(MissingMiddlewareError, match="'rmw_made_up_cpp', which is not installed"):
        prepare_environment({"HOME": "/home/me", "RMW_IMPLEMENTATION": "rmw_made_up_cpp"})


def test_a_middleware_of_a_sourced_ros_is_left_as_it_is(tmp_path):
    index = tmp_path / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "rmw_made_up_cpp").touch()
    environment = {
        "HOME": "/home/me",
        "AMENT_PREFIX_PATH": str(tmp_path),
        "RMW_IMPLEMENTATION": "rmw_made_up_cpp",
    }
    prepare_environment(environment)
    assert environment["RMW_IMPLEMENTATION"] == "rmw_made_up_cpp"


@pytest.mark.parametrize("name", ["", "rmw_fastrtps_cpp"])
def test_the_middleware_of_the_wheels_is_accepted(name):
    environment = {"HOME": "/home/me", "RMW_IMPLEMENTATION": name}
    prepare_environment(environment)
    assert environment["RMW_IMPLEMENTATION"] == name
