"""Assesses the health of a controller manager, like ros2_control's /diagnostics."""

import logging
import threading
from dataclasses import dataclass, field
from enum import IntEnum

from arm_control.controllers.loaned_interfaces import describe_unmeasured
from arm_control.hardware.driver import SelfDiagnosing
from arm_control.lifecycle import LifecycleState
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.supervision import RunRecord, Spread
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.introspection import ManagerSnapshot
from arm_control.manager.settings import (
    DiagnosticThresholds,
    ExecutionTimeThresholds,
    PeriodicityThresholds,
    RunThresholds,
)
from arm_control.status import ControllerStatus


class Level(IntEnum):
    """Severity, numbered as in diagnostic_msgs/msg/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(slots=True)
class HealthReport:
    """The health of one task, built up step by step.

    Attributes:
        task: name of the task.
        level: the worst level so far.
        message: the findings at that level.
        values: figures and states by name.
    """

    task: str
    level: Level = Level.OK
    message: str = ""
    values: dict[str, str] = field(default_factory=dict)

    def merge(self, level: Level, message: str) -> None:
        """Add a finding: the worst level wins, and problems replace messages of level OK."""
        if self.message and (level > Level.OK) == (self.level > Level.OK):
            self.message += f"; {message}"
        elif level > self.level or not self.message:
            self.message = message
        self.level = max(self.level, level)


CAPACITY = 20
"""Limits the memory and the report if a client keeps sending invalid requests."""


class RefusedRequests:
    """The latest reason of each refused request, until the same request succeeds.

    Any thread.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._reasons: dict[tuple[str, str], str] = {}

    def note(self, request: str, name: str, reason: str) -> None:
        """Record a refusal; the oldest ones are dropped.

        The name is empty if the request has no single controller.
        """
        with self._lock:
            self._reasons.pop((request, name), None)
            self._reasons[request, name] = " ".join(reason.split())
            if len(self._reasons) > CAPACITY:
                del self._reasons[next(iter(self._reasons))]

    def clear(self, request: str, name: str) -> None:
        """Drop a refusal, because the same request has succeeded."""
        with self._lock:
            self._reasons.pop((request, name), None)

    def reasons(self) -> dict[str, str]:
        """Return the reasons by '<name>.<request>', the oldest first."""
        with self._lock:
            return {
                f"{name}.{request}" if name else request: reason
                for (request, name), reason in self._reasons.items()
            }


logger = logging.getLogger("controller_manager")

MOTION = ("position", "velocity", "acceleration", "effort")
"""States of a joint that controllers use; any other may have no value yet."""

STUCK_S = 1.0
"""A loop this late is stuck in the code of a controller or a driver."""

MIN_PACE = 0.9
"""Fraction of the real-time factor below which a slow loop is reported."""

STOPPED = "The emergency stop is latched; release it, for example with arm stop --release"
CONTROLLERS = "Controllers Activity"
COMPONENTS = "Hardware Components Activity"
MANAGER = "Controller Manager Activity"


class ManagerDiagnostics:
    """Assesses a manager from any thread, even while the control loop is stuck."""

    def __init__(
        self,
        manager: ControllerManager,
        snapshot: ManagerSnapshot,
        loop: ControlLoop,
        refusals: RefusedRequests,
    ) -> None:
        self._manager = manager
        self._snapshot = snapshot
        self._loop = loop
        self._refusals = refusals
        self._unmeasured: tuple[str, ...] = ()

    def reports(self, thresholds: DiagnosticThresholds) -> tuple[HealthReport, ...]:
        """Return the health of controllers, hardware components and the loop."""
        return (
            self._report_controllers(thresholds.controllers),
            self._report_components(thresholds.hardware_components),
            self._report_loop(thresholds.controller_manager.periodicity),
        )

    def _report_controllers(self, thresholds: RunThresholds) -> HealthReport:
        report = HealthReport(CONTROLLERS)
        controllers, components = self._snapshot.controllers, self._snapshot.components
        active = [pair for pair in controllers if pair[0].state is LifecycleState.ACTIVE]
        if not any(s.state is LifecycleState.ACTIVE for s, _, _ in components):
            report.merge(
                Level.ERROR, "No hardware components are currently active to activate controllers"
            )
        elif not controllers:
            report.merge(Level.WARN, "No controllers are currently loaded")
        else:
            report.merge(Level.OK, _how_many(len(active), len(controllers), "controllers"))
        if self._manager.emergency_stopped:
            report.merge(Level.WARN, STOPPED)
        assessment = _RunAssessment(report, thresholds)
        for status, _ in controllers:
            report.values[f"{status.name}.state"] = status.state.label
            if status.halted_by:
                report.values[f"{status.name}.halted_by"] = status.halted_by
        for status, runs in active:
            assessment.add(status.name, runs, status.update_rate_hz, self._has_own_rate(status))
        assessment.conclude("Controllers")
        report.values.update(self._refusals.reasons())
        return report

    def _report_components(self, thresholds: RunThresholds) -> HealthReport:
        report = HealthReport(COMPONENTS)
        components = self._snapshot.components
        active = sum(status.state is LifecycleState.ACTIVE for status, _, _ in components)
        if not components:
            report.merge(Level.ERROR, "No hardware components are loaded!")
        elif not active:
            report.merge(Level.WARN, "No hardware components are currently active")
        else:
            report.merge(Level.OK, _how_many(active, len(components), "hardware components"))
        self._check_states(report)
        for component in self._manager.resources.components.values():
            if isinstance(component.hardware, SelfDiagnosing):
                health = component.hardware.health()
                report.values |= {f"{component.name}.{k}": v for k, v in health.values.items()}
                if health.problem:
                    report.merge(Level.ERROR, f"{component.name}: {health.problem}")
        assessment = _RunAssessment(report, thresholds)
        for status, reads, writes in components:
            report.values[f"{status.name}.state"] = status.state.label
            if status.state is LifecycleState.ACTIVE:
                rate_hz = status.read_write_rate_hz
                assessment.add(f"{status.name}.read_cycle", reads, rate_hz, checks_rate=True)
                assessment.add(f"{status.name}.write_cycle", writes, rate_hz, checks_rate=True)
        assessment.conclude("Hardware Components")
        return report

    def _check_states(self, report: HealthReport) -> None:
        """Report the measured states that are not numbers, and log them when they change.

        Only those of the joints' motion are a fault. The others are listed among the values.
        """
        unmeasured = self._manager.resources.unmeasured_states()
        joints = {
            f"{joint.name}/{state.name}"
            for component in self._manager.resources.components.values()
            for joint in component.hardware.info.joints
            for state in joint.state_interfaces
            if state.name in MOTION
        }
        unmeasured_joints = tuple(name for name in unmeasured if name in joints)
        if unmeasured:
            report.values["states_that_are_not_numbers"] = ", ".join(unmeasured)
        if unmeasured_joints:
            sentence = f"Measured {describe_unmeasured(unmeasured_joints)}"
            report.merge(Level.WARN, sentence)
            if unmeasured_joints != self._unmeasured:
                logger.warning("%s: the hardware provides no value for it", sentence)
        elif self._unmeasured:
            logger.info("Every state of the joints is a number again")
        self._unmeasured = unmeasured_joints

    def _report_loop(self, thresholds: PeriodicityThresholds) -> HealthReport:
        report = HealthReport(MANAGER)
        loop, pacer = self._loop, self._loop.pacer
        if not loop.running:
            report.merge(Level.ERROR, "The control loop has ended")
        elif loop.paused:
            report.merge(Level.OK, "Controller Manager is paused")
        elif pacer.remaining_s() < -STUCK_S:
            report.merge(
                Level.ERROR, f"The control loop has been stuck for {-pacer.remaining_s():.1f} s"
            )
        else:
            report.merge(Level.OK, "Controller Manager is running")
            self._check_pace(report)
        self._check_periodicity(report, thresholds)
        return report

    def _check_pace(self, report: HealthReport) -> None:
        """Compare the pace in wall time with the requested one, if any."""
        pacer = self._loop.pacer
        figures, asked = pacer.statistics, pacer.real_time_factor
        report.values |= {
            "real_time_factor": f"{figures.achieved_factor:.2f}",
            "overruns": str(figures.overruns),
            "max_lag": f"{1e3 * figures.max_lag_s:.2f} ms",
        }
        statistics = pacer.runs.statistics()
        if statistics is not None:
            report.values["execution_time"] = _describe(statistics.execution_time_us, "us")
        # The pace is unknown until the first second is over.
        if 0.0 < figures.achieved_factor < MIN_PACE * asked:
            report.merge(
                Level.WARN,
                "The control loop cannot keep its pace: real-time factor "
                f"{figures.achieved_factor:.2f} instead of {asked:g}",
            )

    def _check_periodicity(self, report: HealthReport, thresholds: PeriodicityThresholds) -> None:
        """Compare the manager's rate, in its own time, with the nominal rate."""
        expected_hz = self._manager.update_rate_hz
        report.values["update_rate"] = str(expected_hz)
        statistics = self._manager.updates.statistics()
        rate = statistics.periodicity_hz if statistics is not None else None
        if rate is None:
            return
        report.values |= {
            "periodicity.average": f"{rate.mean:.2f}",
            "periodicity.standard_deviation": f"{rate.standard_deviation:.2f}",
            "periodicity.min": f"{rate.minimum:.2f}",
            "periodicity.max": f"{rate.maximum:.2f}",
        }
        level = _rate_level(rate, expected_hz, thresholds)
        if level is not Level.OK:
            report.merge(
                level,
                f"Controller Manager has bad periodicity : {rate.mean:.2f} Hz. "
                f"Expected consistent {expected_hz} Hz",
            )

    def _has_own_rate(self, status: ControllerStatus) -> bool:
        """Whether the controller's rate differs from the loop's."""
        return status.update_rate_hz != self._manager.update_rate_hz


class _RunAssessment:
    """Writes the statistics of one kind of runs into a report, and collects those out of bounds."""

    def __init__(self, report: HealthReport, thresholds: RunThresholds) -> None:
        self._report = report
        self._thresholds = thresholds
        self._slow: dict[str, Level] = {}
        self._irregular: dict[str, Level] = {}

    def add(self, name: str, runs: RunRecord, rate_hz: int, checks_rate: bool) -> None:
        """Add one record; `checks_rate` says whether to check its periodicity."""
        statistics = runs.statistics()
        if statistics is None:
            return
        values = self._report.values
        values[f"{name}.execution_time"] = _describe(statistics.execution_time_us, "us")
        level = _time_level(statistics.execution_time_us, self._thresholds.execution_time)
        if level is not Level.OK:
            self._slow[name] = level
        rate = statistics.periodicity_hz
        if rate is None:
            return
        values[f"{name}.periodicity"] = f"{_describe(rate, 'Hz')} -> Desired : {rate_hz} Hz"
        level = _rate_level(rate, rate_hz, self._thresholds.periodicity)
        if checks_rate and level is not Level.OK:
            self._irregular[name] = level

    def conclude(self, kind: str) -> None:
        """Add those out of bounds to the report's message."""
        for culprits, what in (
            (self._slow, "high execution time"),
            (self._irregular, "bad periodicity"),
        ):
            if culprits:
                names = " ".join(culprits)
                self._report.merge(max(culprits.values()), f"{kind} with {what} : [ {names} ]")


def waiting_reports() -> tuple[HealthReport, ...]:
    """Return the reports of a manager that has no hardware yet."""
    return tuple(
        HealthReport(task, Level.WARN, "Waiting for robot description....")
        for task in (CONTROLLERS, COMPONENTS, MANAGER)
    )


def _how_many(active: int, total: int, what: str) -> str:
    return f"{'All' if active == total else 'Not all'} {what} are active"


def _rate_level(rate: Spread, expected_hz: float, thresholds: PeriodicityThresholds) -> Level:
    error_hz = abs(rate.mean - expected_hz)
    mean, deviation = thresholds.mean_error, thresholds.standard_deviation
    if error_hz > mean.error or rate.standard_deviation > deviation.error:
        return Level.ERROR
    if error_hz > mean.warn or rate.standard_deviation > deviation.warn:
        return Level.WARN
    return Level.OK


def _time_level(time_us: Spread, thresholds: ExecutionTimeThresholds) -> Level:
    mean, deviation = thresholds.mean_error, thresholds.standard_deviation
    if time_us.mean > mean.error or time_us.standard_deviation > deviation.error:
        return Level.ERROR
    if time_us.mean > mean.warn or time_us.standard_deviation > deviation.warn:
        return Level.WARN
    return Level.OK


def _describe(spread: Spread, unit: str) -> str:
    return (
        f"Avg: {spread.mean:.2f} [{spread.minimum:.2f} - {spread.maximum:.2f}] {unit}, "
        f"StdDev: {spread.standard_deviation:.2f}"
    )
