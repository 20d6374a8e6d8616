"""The health report of controllers, hardware and the loop."""

import math
import threading
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from arm_control import ControllerManager, ControlLoop, LifecycleState, Pacer, SwitchRequest
from arm_control.hardware.driver import HardwareHealth
from arm_control.hardware.info import parse_hardware_info
from arm_control.hardware.mock_components import GenericSystem
from arm_control.manager.diagnostics import (
    CAPACITY,
    HealthReport,
    Level,
    ManagerDiagnostics,
    RefusedRequests,
    waiting_reports,
)
from arm_control.manager.introspection import ManagerSnapshot
from arm_control.manager.settings import (
    DiagnosticThresholds,
    ExecutionTimeThresholds,
    MeanTimeBand,
    PeriodicityThresholds,
    RateBand,
    RunThresholds,
    TimeDeviationBand,
)
from arm_control.testing import ManualClock

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")
PATIENT = RunThresholds(
    PeriodicityThresholds(),
    ExecutionTimeThresholds(MeanTimeBand(1e9, 1e9), TimeDeviationBand(1e9, 1e9)),
)
STRICT_RATE = PeriodicityThresholds(RateBand(0.001, 1.0), RateBand(0.001, 1e9))


class Ward:
    """The bench's manager under observation, its loop's pacer on a clock that moves by hand."""

    def __init__(self, bench: Any, period_s: float = 0.01) -> None:
        self.bench = bench
        self.clock = ManualClock()
        self.pacer = Pacer(period_s, clock=self.clock)
        self.loop = ControlLoop(lambda: None, self.pacer)
        self.refusals = RefusedRequests()
        self.thresholds = DiagnosticThresholds(controllers=PATIENT, hardware_components=PATIENT)
        self.watch()

    def watch(self) -> None:
        """Observe the manager that the bench has now."""
        snapshot = ManagerSnapshot(self.bench.manager)
        self.bench.manager.add_observer(snapshot)
        self._diagnostics = ManagerDiagnostics(
            self.bench.manager, snapshot, self.loop, self.refusals
        )

    def report(self, index: int) -> HealthReport:
        """Return one of the three reports."""
        return self._diagnostics.reports(self.thresholds)[index]

    @property
    def controllers(self) -> HealthReport:
        """The report on controllers."""
        return self.report(0)

    @property
    def components(self) -> HealthReport:
        """The report on hardware components."""
        return self.report(1)

    @property
    def manager(self) -> HealthReport:
        """The report on the loop."""
        return self.report(2)

    def pace(self, *periods_s: float, work_s: float = 0.001) -> None:
        """Let ticks begin this far apart."""
        for period_s in periods_s:
            self.pacer.begin()
            self.clock.advance(work_s)
            self.pacer.end()
            self.clock.advance(period_s - work_s)


@pytest.fixture
def ward(bench) -> Ward:
    """Return the bench under observation."""
    return Ward(bench)


@pytest.fixture
def running(ward) -> Iterator[Ward]:
    """Return the bench under observation, its loop's thread alive but waiting for its turn."""
    ready, go = threading.Event(), threading.Event()

    def wait() -> None:
        ready.set()
        go.wait(30.0)

    ward.loop.call(wait)
    ward.loop.start()
    assert ready.wait(30.0)
    yield ward
    ward.loop.stop()
    go.set()
    assert ward.loop.join(30.0)


class AilingSystem(GenericSystem):
    """Knows that it is too hot."""

    def health(self) -> HardwareHealth:
        return HardwareHealth("it is too hot", {"temperature": "81 C"})


def test_a_driver_tells_its_own_faults(bench):
    ward = Ward(bench)
    component = next(iter(bench.manager.resources.components.values()))
    assert component.name not in ward.components.message
    component.hardware = AilingSystem(component.hardware.info)
    report = ward.components
    assert (report.level, report.message) == (Level.ERROR, f"{component.name}: it is too hot")
    assert report.values[f"{component.name}.temperature"] == "81 C"


def test_a_manager_without_hardware_waits_for_its_description():
    assert [(r.level, r.message) for r in waiting_reports()] == [
        (Level.WARN, "Waiting for robot description....")
    ] * 3


def test_no_controller_at_all_is_worth_a_warning(ward):
    assert (ward.controllers.level, ward.controllers.message) == (
        Level.WARN,
        "No controllers are currently loaded",
    )


def test_states_and_a_sentence_on_all_of_them(ward):
    ward.bench.configure("a", commands=ALL)
    ward.bench.configure("b", states=("j0/position",))
    ward.bench.manager.switch_controller(SwitchRequest(("a",)))
    assert (ward.controllers.level, ward.controllers.message) == (
        Level.OK,
        "Not all controllers are active",
    )
    assert ward.controllers.values["a.state"] == "active"
    assert ward.controllers.values["b.state"] == "inactive"
    ward.bench.manager.switch_controller(SwitchRequest(("b",)))
    assert ward.controllers.message == "All controllers are active"


def test_controllers_without_active_hardware_are_an_error(ward):
    ward.bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.INACTIVE)
    assert ward.controllers.level is Level.ERROR
    assert ward.controllers.message == (
        "No hardware components are currently active to activate controllers"
    )
    assert (ward.components.level, ward.components.message) == (
        Level.WARN,
        "No hardware components are currently active",
    )
    assert ward.components.values == {"FakeSystem.state": "inactive"}


def test_hardware_that_is_well(ward):
    ward.bench.tick(5)
    assert (ward.components.level, ward.components.message) == (
        Level.OK,
        "All hardware components are active",
    )
    values = ward.components.values
    assert values["FakeSystem.read_cycle.periodicity"].startswith("Avg: 100.00 [100.00 - 100.00]")
    assert values["FakeSystem.write_cycle.periodicity"].endswith(
        "Hz, StdDev: 0.00 -> Desired : 100 Hz"
    )
    assert "us" in values["FakeSystem.read_cycle.execution_time"]


def test_a_joint_state_that_is_not_a_number_is_named_and_logged_once(ward, caplog):
    states, names = ward.bench.hardware.states, ward.bench.hardware.state_interfaces
    where = [names.index("j1/position"), names.index("j3/velocity")]
    states[where] = math.nan
    sentence = "Measured states j1/position, j3/velocity are not numbers"
    for _ in range(2):
        assert (ward.components.level, ward.components.message) == (Level.WARN, sentence)
    assert caplog.text.count(sentence) == 1

    states[where] = 0.0
    assert ward.components.level is Level.OK


def test_a_sensor_without_a_value_is_listed_among_the_values(bench):
    (info,) = parse_hardware_info(
        "<robot name='r'><ros2_control name='H' type='system'><hardware><plugin>"
        "mock_components/GenericSystem</plugin></hardware><joint name='j'><state_interface "
        "name='position'/></joint><sensor name='s'><state_interface name='force'/></sensor>"
        "</ros2_control></robot>"
    )
    bench.manager = ControllerManager([GenericSystem(info)], 100)
    bench.manager.bring_up()
    report = Ward(bench).components
    assert report.level is Level.OK
    assert report.values["states_that_are_not_numbers"] == "s/force"


@pytest.mark.parametrize(
    ("band", "level"),
    [
        (MeanTimeBand(1e9, 1e9), Level.OK),
        (MeanTimeBand(1e-6, 1e9), Level.WARN),
        (MeanTimeBand(1e-6, 1e-6), Level.ERROR),
    ],
)
def test_execution_times_are_judged_by_the_thresholds(ward, band, level):
    ward.bench.configure("a", commands=ALL)
    ward.bench.manager.switch_controller(SwitchRequest(("a",)))
    ward.bench.tick(3)
    runs = replace(PATIENT, execution_time=replace(PATIENT.execution_time, mean_error=band))
    ward.thresholds = DiagnosticThresholds(controllers=runs, hardware_components=runs)
    assert ward.controllers.level is level
    assert ("Controllers with high execution time : [ a ]" in ward.controllers.message) is bool(
        level
    )
    assert ward.components.level is level


def test_a_controller_with_its_own_rate_is_checked_against_it(ward):
    ward.bench.configure("slow", commands=ALL, rate_hz=50)
    ward.bench.manager.switch_controller(SwitchRequest(("slow",)))
    ward.bench.tick(20)
    assert "Avg: 50.00" in ward.controllers.values["slow.periodicity"]
    assert ward.controllers.level is Level.OK
    ward.bench.tick(20, period_s=0.025)
    ward.thresholds = replace(
        ward.thresholds, controllers=replace(PATIENT, periodicity=STRICT_RATE)
    )
    assert ward.controllers.level is Level.ERROR
    assert ward.controllers.message == "Controllers with bad periodicity : [ slow ]"


def test_a_refused_request_is_readable_until_it_succeeds(ward):
    ward.refusals.note("load_controller", "x", "The 'type' param was not\ndefined for 'x'.")
    ward.refusals.note("switch_controller", "", "Could not activate")
    values = ward.controllers.values
    assert values["x.load_controller"] == "The 'type' param was not defined for 'x'."
    assert values["switch_controller"] == "Could not activate"
    ward.refusals.clear("load_controller", "x")
    assert "x.load_controller" not in ward.controllers.values


def test_only_the_latest_refusals_are_kept():
    refusals = RefusedRequests()
    for i in range(CAPACITY + 5):
        refusals.note("load_controller", f"c{i}", "no")
    reasons = refusals.reasons()
    assert len(reasons) == CAPACITY
    assert "c4.load_controller" not in reasons
    assert f"c{CAPACITY + 4}.load_controller" in reasons


def test_a_loop_that_keeps_its_pace(running):
    running.bench.tick(30)
    running.pace(*[0.01] * 120)
    assert (running.manager.level, running.manager.message) == (
        Level.OK,
        "Controller Manager is running",
    )
    assert running.manager.values["periodicity.average"] == "100.00"
    assert running.manager.values["execution_time"].startswith("Avg: 1000.00")
    assert float(running.manager.values["real_time_factor"]) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("rate_hz", "level"), [(104.0, Level.OK), (94.0, Level.WARN), (80.0, Level.ERROR)]
)
def test_the_managers_rate_is_held_against_its_parameter(running, rate_hz, level):
    running.bench.tick(30, period_s=1.0 / rate_hz)
    assert running.manager.level is level
    assert (
        f"Controller Manager has bad periodicity : {rate_hz:.2f} Hz. Expected consistent 100 Hz"
        == running.manager.message
    ) is bool(level)


@pytest.mark.parametrize(
    ("asked", "period_s", "level"),
    [
        (1.0, 0.0125, Level.WARN),
        (0.5, 0.02, Level.OK),
        (0.5, 0.025, Level.WARN),
        (0.0, 0.025, Level.OK),
    ],
)
def test_a_loop_that_lags_behind_real_time_is_worth_a_warning(running, asked, period_s, level):
    running.pacer.real_time_factor = asked
    running.pace(*[period_s] * 200)
    assert running.manager.level is level
    assert ("cannot keep its pace" in running.manager.message) is bool(level)


def test_a_stuck_loop_is_an_error_after_a_while(running):
    running.pace(*[0.01] * 30)
    running.pacer.begin()
    running.clock.advance(0.9)
    assert running.manager.message == "Controller Manager is running"
    running.clock.advance(2.6)
    assert running.manager.level is Level.ERROR
    assert running.manager.message == "The control loop has been stuck for 3.5 s"


def test_a_paused_loop_is_not_blamed(bench):
    ward = Ward(bench)
    ward.pace(0.5, 0.5)
    ward.loop.start(paused=True)
    ward.clock.advance(60.0)
    report = ward.manager
    ward.loop.stop()
    assert ward.loop.join(30.0)
    assert (report.level, report.message) == (Level.OK, "Controller Manager is paused")
    assert ward.manager.message == "The control loop has ended"


def test_a_report_names_the_worst_it_found():
    report = HealthReport("x")
    report.merge(Level.OK, "fine")
    report.merge(Level.WARN, "slow")
    report.merge(Level.ERROR, "late")
    assert (report.level, report.message) == (Level.ERROR, "slow; late")


def test_there_can_be_no_hardware(bench):
    bench.manager = ControllerManager([], 100)
    assert Ward(bench).components.message == "No hardware components are loaded!"


def test_a_latched_emergency_stop_is_a_warning(ward):
    ward.bench.configure("mover", commands=("j0/position",))
    ward.bench.manager.set_emergency_stop(True)
    report = ward.controllers
    assert (report.level, report.message.split(";")[0]) == (
        *(Level.WARN, "The emergency stop is latched"),
    )
    ward.bench.manager.set_emergency_stop(False)
    assert ward.controllers.level is Level.OK
