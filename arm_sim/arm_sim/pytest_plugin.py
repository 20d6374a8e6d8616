"""The pytest plugin: fixtures `arm_sim` and `arm_ros`, and their markers.

Every pytest run in an environment with this package loads this module, so it imports the rest only
when a test needs it.
"""

import os
import re
import shutil
import warnings
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import pytest

if TYPE_CHECKING:
    from arm_sim.bench.processes import LoggedProcess
    from arm_sim.bench.ros_bench import RosBench
    from arm_sim.bench.simulation import BenchSimulation, SimulationPool

MARKERS = (
    "arm_sim(robot, world, controllers, ...): what the fixture arm_sim simulates; the arguments of "
    "arm_sim.Simulation by name",
    "arm_ros(robot, world, controllers, launch, arguments): what the fixture arm_ros launches",
)
ARTIFACTS = "arm-artifacts"
SECTION = "arm"
MAX_NAME = 120


class Evidence(Protocol):
    """A fixture's value that can explain a failure."""

    def report(self, folder: Path) -> Iterator[str]:
        """Write files into a folder, and yield lines; may raise OSError or GazeboError."""
        ...


_evidence = pytest.StashKey[list[Evidence]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options."""
    parser.getgroup("arm", "simulated robots").addoption(
        "--arm-artifacts",
        metavar="DIR",
        default=ARTIFACTS,
        help="folder for plots, recordings and logs of failed tests; default: %(default)s, "
        "relative to the root directory",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Declare the markers."""
    for line in MARKERS:
        config.addinivalue_line("markers", line)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    """Explain a failure while the simulation still exists."""
    report: pytest.TestReport = yield  # pyright: ignore
    if report.failed and report.when == "call":
        for value in item.stash.get(_evidence, []):
            _explain(item, report, value)
    return report  # pyright: ignore


def _explain(item: pytest.Item, report: pytest.TestReport, value: Evidence) -> None:
    """Add a fixture's evidence to the report of a failed test, and its files to the folder."""
    from arm_gazebo.errors import GazeboError

    folder = item.config.rootpath / str(item.config.getoption("--arm-artifacts"))
    lines: list[str] = []
    try:
        mine = _folder_of(item, folder)
        lines.extend(value.report(mine))
    except (OSError, GazeboError) as error:
        lines.append(f"the report cannot be written: {error}")
    else:
        # JUnit XML takes the properties from a later report, at the end of the test.
        item.user_properties.append((SECTION, str(mine)))
    report.sections.append((SECTION, "\n".join(lines)))


def _folder_of(item: pytest.Item, folder: Path) -> Path:
    """Return an empty folder for a test."""
    folder.mkdir(parents=True, exist_ok=True)
    # As in pytest's own cache: nobody should commit the files by mistake.
    (folder / ".gitignore").write_text("*\n", encoding="utf-8")
    name = re.sub(r"[^\w.-]+", "-", item.nodeid).strip("-")[-MAX_NAME:]
    mine = folder / name
    shutil.rmtree(mine, ignore_errors=True)
    mine.mkdir(parents=True)
    return mine


@pytest.fixture(scope="session")
def _arm_sim_pool() -> "Iterator[SimulationPool]":
    from arm_sim.bench.simulation import SimulationPool

    pool = SimulationPool()
    yield pool
    pool.close()


@pytest.fixture
def arm_sim(request: pytest.FixtureRequest, _arm_sim_pool: "SimulationPool") -> "BenchSimulation":
    """Return a simulation without ROS, in its initial state: see `arm_sim.bench.simulation`.

    The marker `arm_sim` says what it simulates; by default it is the 4-DOF arm.
    """
    simulation = _simulation(request.node, _arm_sim_pool)
    if isinstance(simulation, str):
        pytest.fail(simulation, pytrace=False)
    request.node.stash.setdefault(_evidence, []).append(simulation)
    return simulation


def _simulation(item: pytest.Item, pool: "SimulationPool") -> "BenchSimulation | str":
    """Return a simulation, or a sentence that says why there is none."""
    from arm_sim.bench.configuration import arguments_of, marked_arguments
    from arm_sim.simulation import Simulation
    from arm_sim.user_traceback import USER_ERRORS

    try:
        # The bench records each test itself.
        known = ["robot", *(name for name in arguments_of(Simulation.__init__) if name != "record")]
        return pool.take(marked_arguments(item, "arm_sim", known))
    except USER_ERRORS as error:
        return str(error)


@pytest.fixture
def arm_ros(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> "Iterator[RosBench]":
    """Return a launch in a ROS domain of its own: see `arm_sim.bench.ros_bench`.

    The marker `arm_ros` says what it launches; by default it is the 4-DOF arm.
    """
    from arm_node.environment import UnusableEnvironmentError, prepare_environment
    from arm_node.ros_domain import NoFreeDomainError, domain_of_its_own
    from arm_sim.bench.configuration import arguments_of, marked_arguments
    from arm_sim.bench.processes import LoggedProcess, launch_command
    from arm_sim.errors import ArmSimError

    refusal, problems = "", list[str]()
    with ExitStack() as ending:
        try:
            known = [name for name in arguments_of(launch_command) if name != "record_to"]
            arguments = marked_arguments(request.node, "arm_ros", known)
            recording = tmp_path / "recording" / "test.run"
            command = launch_command(**arguments, record_to=recording)
            domain_id = ending.enter_context(domain_of_its_own())
            # A test's own nodes are in the same domain.
            monkeypatch.setenv("ROS_DOMAIN_ID", str(domain_id))
            monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
            prepare_environment()
            environment = {**os.environ, "ROS_LOG_DIR": str(tmp_path / "ros_log")}
            launch = LoggedProcess("the launch", command, environment)
            bench = _ros_bench(launch, domain_id, recording)
        except (ArmSimError, NoFreeDomainError, UnusableEnvironmentError) as error:
            refusal = str(error)
        else:
            request.node.stash.setdefault(_evidence, []).append(bench)
            yield bench
            problems = bench.close()
    if refusal or problems:
        pytest.fail("\n".join([refusal, *problems]).strip(), pytrace=False)


def _ros_bench(launch: "LoggedProcess", domain_id: int, recording: Path) -> "RosBench":
    """Return a launch as objects; ROS is imported while the launch starts."""
    with warnings.catch_warnings():
        # Modules that rclpy imports emit warnings, which must not fail a run that turns them into
        # errors.
        warnings.simplefilter("ignore", DeprecationWarning)
        try:
            from arm_sim.bench.ros_bench import RosBench
        except BaseException:
            launch.end()
            raise
    return RosBench(launch, domain_id, recording)
