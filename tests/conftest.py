"""What tests of several packages share: a ROS domain of their own, patience with the machine."""

import atexit
import gc
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Generator, Iterator
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from arm_node.ros_domain import domain_of_its_own
from arm_node.workarounds.local_profile import profile_variable
from arm_node.workarounds.ports import remove_torn_ports
from arm_node.workarounds.switch import is_off_by_hand

# How long an example takes says more about the machine than about the code. The same examples each
# time: what a change breaks is told by its tests, not by luck. `--hypothesis-profile search` tries
# others each time.
settings.register_profile("search", deadline=None)
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")

DISCOVERY_OVER_TRANSPORTS = """\
<?xml version="1.0" encoding="UTF-8" ?>
<dds xmlns="http://www.eprosima.com">
  <library_settings><intraprocess_delivery>USER_DATA_ONLY</intraprocess_delivery></library_settings>
</dds>
"""

DDS_SETTINGS = (profile_variable(), "ROS_AUTOMATIC_DISCOVERY_RANGE")

_held_domain = ExitStack()
atexit.register(_held_domain.close)


def pytest_configure(config: pytest.Config) -> None:
    """Give the whole session a ROS domain of its own, before anything imports rclpy."""
    # A session under nohup ignores SIGHUP, one in a script's background SIGINT and SIGQUIT, and
    # would hand that on to the programs under test.
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # Each worker of pytest-xdist takes a domain, though the user has set one: two would meet in it.
    is_above_workers = getattr(config.option, "dist", "no") != "no"
    is_worker = hasattr(config, "workerinput")
    if is_worker or ("ROS_DOMAIN_ID" not in os.environ and not is_above_workers):
        os.environ["ROS_DOMAIN_ID"] = str(_lock_a_domain())
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
    if is_above_workers:
        threading.Thread(target=_free_hung_workers, daemon=True).start()
    # pytest-xdist would give the files with the fewest tests last, and those are the longest.
    config.option.loadscopereorder = False
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if sys.prefix not in prefixes:
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([sys.prefix, *filter(None, prefixes)])


def _free_hung_workers() -> None:
    """Remove torn ports: a worker that waits at one does not even notice that its time is over."""
    while True:
        remove_torn_ports()
        time.sleep(5.0)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without looking for garbage, then or later: what is collected stays until the end."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Let each worker begin with other folders: one finds what another has compiled.

    Else all of them would compile each file at the same time. They agree on the order afterwards.
    """
    report = yield
    worker = getattr(collector.config, "workerinput", None)
    if worker is not None and collector.path == Path(__file__).parent:
        start = int(worker["workerid"][2:]) * len(report.result) // worker["workercount"]
        report.result[:] = report.result[start:] + report.result[:start]
    return report


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let workers begin with the slow files, then those that start processes.

    Each has small ones left in the end: one worker would else be idle while another one does the
    last long file. Files with a browser are far from each other: three at once, each with its own
    launch, take all that two cores have before a test has done anything.
    """
    if not hasattr(config, "workerinput"):
        return
    items.sort(key=lambda item: item.path.parts)
    slow, ros = (
        {item.path for item in items if item.get_closest_marker(mark)} for mark in ("slow", "ros")
    )
    shown = {item.path: 0.0 for item in items if "browser" in getattr(item, "fixturenames", ())}
    others = [path for path in dict.fromkeys(i.path for i in items) if path in ros - shown.keys()]
    places = {path: float(place) for place, path in enumerate(others)}
    places |= {path: place * len(others) / len(shown) for place, path in enumerate(shown)}
    items.sort(
        key=lambda item: (item.path not in slow, item.path not in ros, places.get(item.path, 0.0))
    )


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give a folder whose files share a launch to one worker: it has an `__init__.py`."""
    from xdist.scheduler import LoadFileScheduling

    class FolderScheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            folder = os.path.dirname(file)
            return folder if (config.rootpath / folder / "__init__.py").exists() else file

    return FolderScheduling(config, log) if config.option.dist == "loadfile" else None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    call: pytest.CallInfo[None],
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Show what a failed program said."""
    report = yield
    error = call.excinfo.value if call.excinfo else None
    if isinstance(error, subprocess.CalledProcessError | subprocess.TimeoutExpired):
        for name in ("stdout", "stderr"):
            report.sections.append((f"{name} of the program", f"{getattr(error, name)}"))
    return report


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip tests of what is switched off; let participants of this process find each other.

    They do so as those of several processes do. What a test that killed a program has left is
    removed, because any program of the next one would hang at it.
    """
    for mark in item.iter_markers("workaround"):
        if is_off_by_hand(mark.args[0]):
            pytest.skip(f"ARM_WITHOUT switches {mark.args[0]} off")
    if item.get_closest_marker("ros") is not None:
        remove_torn_ports()
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
        m.setenv(profile_variable(), profile.name)
        context = Context()
        rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
        rclpy.create_node("first", context=context).destroy_node()
        context.try_shutdown()


@pytest.fixture(autouse=True)
def _keep_dds_settings() -> Iterator[None]:
    """Undo changes by verbs in this process: later tests' programs would inherit them."""
    before = {name: os.environ.get(name) for name in DDS_SETTINGS}
    yield
    for name, value in before.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value


def _lock_a_domain() -> int:
    """Return a domain id that no other session of this machine uses while this one lasts."""
    return _held_domain.enter_context(domain_of_its_own())
