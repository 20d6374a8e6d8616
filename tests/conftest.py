"""What tests of several packages share: a ROS domain of their own, patience with the machine."""

import fcntl
import os
import sys
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# How long an example takes says more about the machine than about the code.
settings.register_profile("patient", deadline=None)
settings.load_profile("patient")

DOMAIN_IDS = range(1, 102)
"""ROS domain ids whose ports no operating system hands out by itself."""

_held_lock: list[int] = []


def pytest_configure(config: pytest.Config) -> None:
    """Give the whole session a ROS domain of its own, before anything imports rclpy."""
    if "ROS_DOMAIN_ID" not in os.environ:
        os.environ["ROS_DOMAIN_ID"] = str(_lock_a_domain())
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if sys.prefix not in prefixes:
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([sys.prefix, *filter(None, prefixes)])


def _lock_a_domain() -> int:
    """Return a domain id that no other session of this machine uses while this one lasts."""
    folder = Path(tempfile.gettempdir()) / "ros-domains-in-tests"
    folder.mkdir(exist_ok=True)
    for offset in DOMAIN_IDS:
        domain = 1 + (os.getpid() + offset) % len(DOMAIN_IDS)
        lock = os.open(folder / str(domain), os.O_CREAT | os.O_RDWR | os.O_CLOEXEC)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(lock)
            continue
        _held_lock.append(lock)
        return domain
    raise RuntimeError(f"all ROS domains from {DOMAIN_IDS[0]} to {DOMAIN_IDS[-1]} are in use")
