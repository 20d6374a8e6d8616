"""What tests of several packages share: a ROS domain of their own, patience with the machine."""

import fcntl
import os
import signal
import sys
import tempfile
from functools import cache
from pathlib import Path

import pytest
from hypothesis import settings

# How long an example takes says more about the machine than about the code. The same examples each
# time: what a change breaks is told by its tests, not by luck. `--hypothesis-profile search` tries
# others each time.
settings.register_profile("search", deadline=None)
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")

DOMAIN_IDS = range(1, 102)
"""ROS domain ids whose ports no operating system hands out by itself."""

DOMAIN_PORTS = (7400, 250)
"""The first UDP port of domain 0, and how many ports each domain has (DDSI-RTPS 2.5, 9.6.2.3)."""

DISCOVERY_OVER_TRANSPORTS = """\
<?xml version="1.0" encoding="UTF-8" ?>
<dds xmlns="http://www.eprosima.com">
  <library_settings><intraprocess_delivery>USER_DATA_ONLY</intraprocess_delivery></library_settings>
</dds>
"""

_held_lock: list[int] = []


def pytest_configure(config: pytest.Config) -> None:
    """Give the whole session a ROS domain of its own, before anything imports rclpy."""
    # A session under nohup ignores SIGHUP, one in a script's background SIGINT and SIGQUIT, and
    # would hand that on to the programs under test.
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if "ROS_DOMAIN_ID" not in os.environ:
        os.environ["ROS_DOMAIN_ID"] = str(_lock_a_domain())
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if sys.prefix not in prefixes:
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([sys.prefix, *filter(None, prefixes)])


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Have participants of this process find each other as those of several processes do."""
    if item.get_closest_marker("ros") is not None:
        _discover_over_transports()


@cache
def _discover_over_transports() -> None:
    """Make the process's first participant, and end it: then Fast DDS reads its settings.

    By itself it hands what participants of one process have to each other, past all transports.
    Where one has just ended, 2.14.5 may leave a new one without another's subscriptions for ever:
    seen in 4 of 1000 tests with three participants on a busy machine, each in this one process.
    What is started here does not inherit the setting.
    """
    import rclpy
    from rclpy.context import Context
    from rclpy.signals import SignalHandlerOptions

    with (
        tempfile.NamedTemporaryFile("w", suffix=".xml") as profile,
        pytest.MonkeyPatch.context() as m,
    ):
        profile.write(DISCOVERY_OVER_TRANSPORTS)
        profile.flush()
        m.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", profile.name)
        context = Context()
        rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
        rclpy.create_node("first", context=context).destroy_node()
        context.try_shutdown()


def _busy_domains() -> set[int]:
    """Return the domains in which something on this machine listens now."""
    first, count = DOMAIN_PORTS
    table = Path("/proc/net/udp")
    lines = table.read_text().splitlines()[1:] if table.exists() else []
    ports = (int(line.split()[1].rpartition(":")[2], 16) for line in lines)
    return {(port - first) // count for port in ports if port >= first}


def _lock_a_domain() -> int:
    """Return a domain id that no other session of this machine uses while this one lasts."""
    folder = Path(tempfile.gettempdir()) / "ros-domains-in-tests"
    folder.mkdir(exist_ok=True)
    busy = _busy_domains()
    for offset in DOMAIN_IDS:
        domain = 1 + (os.getpid() + offset) % len(DOMAIN_IDS)
        if domain in busy:
            continue
        lock = os.open(folder / str(domain), os.O_CREAT | os.O_RDWR | os.O_CLOEXEC)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(lock)
            continue
        _held_lock.append(lock)
        return domain
    raise RuntimeError(f"all ROS domains from {DOMAIN_IDS[0]} to {DOMAIN_IDS[-1]} are in use")
