"""Sets the environment variables that rclpy from pip needs, within the process."""

import importlib.util
import os
import sys
from collections.abc import Mapping, MutableMapping, Sequence
from pathlib import Path

from arm_node.workarounds.lazy_messages import import_messages_lazily
from arm_node.workarounds.ports import remove_torn_ports

INTERFACE_PACKAGES = (
    "tf2_msgs",
    "control_msgs",
    "controller_manager_msgs",
    "simulation_interfaces",
)
"""Interface packages that the rclpy wheels lack and the distribution arm-interfaces provides."""

PLANNING_PACKAGES = ("moveit_msgs", "octomap_msgs", "object_recognition_msgs")
"""Those of motion planning, which the distribution arm-moveit-interfaces provides."""

SEEING_PACKAGES = (*PLANNING_PACKAGES, "mycobot_interfaces")
"""The same with that of the myCobot's depth camera."""

MIDDLEWARE = "rmw_fastrtps_cpp"
PACKAGES = Path("share", "ament_index", "resource_index", "packages")
"""Where a prefix has a file for each of its packages."""
LOGGING_SWITCHES = (
    "RCUTILS_COLORIZED_OUTPUT",
    "RCUTILS_LOGGING_USE_STDOUT",
    "RCUTILS_LOGGING_BUFFERED_STREAM",
)
"""Variables of ROS's logging that are 0, 1 or empty."""
LAST_DOMAIN = 232
"""Higher DDS domains would need port numbers that do not exist."""


class UnusableEnvironmentError(Exception):
    """ROS cannot start in this environment; the message says how to fix it."""


class MissingInterfacesError(UnusableEnvironmentError):
    """An interface package that the nodes need is not installed."""


class MissingMiddlewareError(UnusableEnvironmentError):
    """RMW_IMPLEMENTATION names a middleware that is not installed."""


class InvalidDomainError(UnusableEnvironmentError):
    """ROS_DOMAIN_ID is not a valid domain."""


class InvalidLoggingError(UnusableEnvironmentError):
    """A variable of ROS's logging has a value that ROS does not know."""


class MissingSecurityError(UnusableEnvironmentError):
    """The environment enforces SROS2, which the ROS wheels are built without."""


def prepare_environment(
    environ: MutableMapping[str, str] = os.environ, packages: Sequence[str] = ()
) -> None:
    """Make rclpy usable in this process, however it was started.

    Must run before rclpy is imported. Adds this Python's prefix to AMENT_PREFIX_PATH, which the
    wheels do not set and ament_index needs for every look-up. Sets ROS_LOG_DIR if the process has
    no HOME, because rclpy would not start. Removes files that would hang rclpy; see `torn_ports`.

    Args:
        environ: the process's environment.
        packages: interface packages that the process needs besides `INTERFACE_PACKAGES`, such as
            `PLANNING_PACKAGES`.

    Raises:
        MissingInterfacesError: an interface package is not installed.
        InvalidDomainError: ROS_DOMAIN_ID is not a number from 0 to 232.
        InvalidLoggingError: one of `LOGGING_SWITCHES` is neither 0 nor 1.
        MissingMiddlewareError: the package that RMW_IMPLEMENTATION names is not installed.
        MissingSecurityError: SROS2 is enforced, and rclpy is that of the wheels.
    """
    _check_domain(environ.get("ROS_DOMAIN_ID", ""))
    _check_logging(environ)
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    if sys.prefix not in prefixes:
        prefixes.append(sys.prefix)
        environ["AMENT_PREFIX_PATH"] = os.pathsep.join(prefixes)
    _check_middleware(environ.get("RMW_IMPLEMENTATION", ""), prefixes)
    _check_security(environ)
    if "HOME" not in environ and "ROS_LOG_DIR" not in environ and "ROS_HOME" not in environ:
        from tempfile import gettempdir

        environ["ROS_LOG_DIR"] = str(Path(gettempdir()) / f"ros-log-{os.getuid()}")
    check_interfaces((*INTERFACE_PACKAGES, *packages))
    remove_torn_ports()
    import_messages_lazily()


def check_interfaces(packages: Sequence[str]) -> None:
    """Check that interface packages are installed.

    Raises:
        MissingInterfacesError: one is not installed; the message names the pip command.
    """
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        planning = {name in SEEING_PACKAGES for name in missing}
        folders = ["./arm_interfaces"] * (False in planning)
        folders += ["./arm_moveit_interfaces"] * (True in planning)
        raise MissingInterfacesError(
            f"the ROS interface package{'s' if len(missing) > 1 else ''} {', '.join(missing)} "
            f"{'are' if len(missing) > 1 else 'is'} not installed for {sys.executable}; "
            f"run 'pip install {' '.join(folders)}' from the arm suite's folder, "
            "or source a ROS 2 Jazzy that has them"
        )


def _check_domain(text: str) -> None:
    # ROS would read '1e1' as 1, and treat '-1' as unset.
    word = text.strip()
    if word and not (word.isascii() and word.isdigit() and int(word) <= LAST_DOMAIN):
        raise InvalidDomainError(
            f"ROS_DOMAIN_ID is {text!r}; it must be a whole number from 0 to {LAST_DOMAIN}"
        )


def _check_logging(environ: Mapping[str, str]) -> None:
    # rcl would start with another value, and print several lines of errors for each log call.
    for name in LOGGING_SWITCHES:
        value = environ.get(name, "")
        if value not in ("", "0", "1"):
            raise InvalidLoggingError(f"{name} is {value!r}; it must be 0 or 1")


def _check_security(environ: Mapping[str, str]) -> None:
    # rcl would say "error not set".
    enable, strategy = environ.get("ROS_SECURITY_ENABLE"), environ.get("ROS_SECURITY_STRATEGY")
    if enable == "true" and strategy == "Enforce" and _uses_wheels():
        raise MissingSecurityError(
            "ROS_SECURITY_STRATEGY is 'Enforce', but the Fast DDS of the ROS wheels is built "
            "without security: unset ROS_SECURITY_ENABLE"
        )


def _uses_wheels() -> bool:
    """Return whether rclpy is that of this Python, not of a sourced ROS, which has security."""
    spec = importlib.util.find_spec("rclpy")
    return spec is not None and Path(spec.origin or "").is_relative_to(sys.prefix)


def _check_middleware(name: str, prefixes: Sequence[str]) -> None:
    # rcl would end the process with exit code 102.
    if name and not any((Path(prefix) / PACKAGES / name).exists() for prefix in prefixes):
        raise MissingMiddlewareError(
            f"RMW_IMPLEMENTATION is {name!r}, which is not installed; the ROS wheels have "
            f"{MIDDLEWARE} only: unset RMW_IMPLEMENTATION"
        )
