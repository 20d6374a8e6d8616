"""Judges the health of a controller manager, as ros2_control does on /diagnostics."""

from arm_control.control_loop import ControlLoop
from arm_control.controller_manager import ControllerManager
from arm_control.diagnostic_thresholds import (
    DiagnosticThresholds,
    ExecutionTimeThresholds,
    PeriodicityThresholds,
    RunThresholds,
)
from arm_control.health_report import HealthReport, Level
from arm_control.lifecycle import LifecycleState
from arm_control.manager_snapshot import ManagerSnapshot
from arm_control.refusals import Refusals
from arm_control.run_record import RunRecord, Spread
from arm_control.status import ControllerStatus

STUCK_S = 1.0
"""A loop this late is not slow, it is stuck in somebody's code."""

LEAST_PACE = 0.9
"""Share of the real-time factor below which a loop is too slow to pass over in silence."""

CONTROLLERS = "Controllers Activity"
COMPONENTS = "Hardware Components Activity"
MANAGER = "Controller Manager Activity"


class ManagerDiagnostics:
    """Watches a manager from a thread of its own, whatever the control loop is doing.

    It only reads what any thread may read, so `reports` may be called even while the loop is
    stuck.
    """

    def __init__(
        self,
        manager: ControllerManager,
        snapshot: ManagerSnapshot,
        loop: ControlLoop,
        refusals: Refusals,
    ) -> None:
        """Watch over a manager.

        Args:
            manager: the core; of it only the rates are read.
            snapshot: who is in which state.
            loop: runs the manager.
            refusals: of the requests that came to it.
        """
        self._manager = manager
        self._snapshot = snapshot
        self._loop = loop
        self._refusals = refusals

    def reports(self, thresholds: DiagnosticThresholds) -> tuple[HealthReport, ...]:
        """Return how controllers, hardware components and the loop are."""
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
                Level.ERROR,
                "No hardware components are currently active to activate controllers",
            )
        elif not controllers:
            report.merge(Level.WARN, "No controllers are currently loaded")
        else:
            report.merge(Level.OK, _how_many(len(active), len(controllers), "controllers"))
        judge = _RunJudge(report, thresholds)
        for status, _ in controllers:
            report.values[f"{status.name}.state"] = status.state.label
        for status, runs in active:
            judge.look_at(status.name, runs, status.update_rate_hz, self._own_pace(status))
        judge.conclude("Controllers")
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
        judge = _RunJudge(report, thresholds)
        for status, reads, writes in components:
            report.values[f"{status.name}.state"] = status.state.label
            if status.state is LifecycleState.ACTIVE:
                rate_hz = status.read_write_rate_hz
                judge.look_at(f"{status.name}.read_cycle", reads, rate_hz, judged=True)
                judge.look_at(f"{status.name}.write_cycle", writes, rate_hz, judged=True)
        judge.conclude("Hardware Components")
        return report

    def _report_loop(self, thresholds: PeriodicityThresholds) -> HealthReport:
        report = HealthReport(MANAGER)
        loop, pacer = self._loop, self._loop.pacer
        if not loop.running:
            report.merge(Level.ERROR, "The control loop has ended")
        elif loop.paused:
            report.merge(Level.OK, "Controller Manager is paused")
        elif pacer.remaining_s() < -STUCK_S:
            report.merge(
                Level.ERROR,
                f"The control loop has been stuck for {-pacer.remaining_s():.1f} s",
            )
        else:
            report.merge(Level.OK, "Controller Manager is running")
            self._judge_pace(report)
        self._judge_periodicity(report, thresholds)
        return report

    def _judge_pace(self, report: HealthReport) -> None:
        """Compare the pace in wall time with the one asked for, if any."""
        pacer = self._loop.pacer
        figures, asked = pacer.statistics, pacer.real_time_factor
        report.values |= {
            "real_time_factor": f"{figures.achieved_factor:.2f}",
            "overruns": str(figures.overruns),
            "max_lag": f"{1e3 * figures.max_lag_s:.2f} ms",
        }
        statistics = pacer.runs.statistics()
        if statistics is not None:
            report.values["execution_time"] = _in_words(statistics.execution_time_us, "us")
        # Nothing is known of the pace before the first second is over.
        if 0.0 < figures.achieved_factor < LEAST_PACE * asked:
            report.merge(
                Level.WARN,
                "The control loop cannot keep its pace: real-time factor "
                f"{figures.achieved_factor:.2f} instead of {asked:g}",
            )

    def _judge_periodicity(self, report: HealthReport, thresholds: PeriodicityThresholds) -> None:
        """Compare the manager's own rate, in its own time, with what it should be."""
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

    def _own_pace(self, status: ControllerStatus) -> bool:
        """Whether the controller has a pace of its own; else it shares the loop's."""
        return status.update_rate_hz != self._manager.update_rate_hz


class _RunJudge:
    """Writes the figures of one kind of runs into a report, and collects who is out of bounds."""

    def __init__(self, report: HealthReport, thresholds: RunThresholds) -> None:
        self._report = report
        self._thresholds = thresholds
        self._slow: dict[str, Level] = {}
        self._irregular: dict[str, Level] = {}

    def look_at(self, name: str, runs: RunRecord, rate_hz: int, judged: bool) -> None:
        """Write one record down; `judged` says whether its periodicity can be blamed on it."""
        statistics = runs.statistics()
        if statistics is None:
            return
        values = self._report.values
        values[f"{name}.execution_time"] = _in_words(statistics.execution_time_us, "us")
        level = _time_level(statistics.execution_time_us, self._thresholds.execution_time)
        if level is not Level.OK:
            self._slow[name] = level
        rate = statistics.periodicity_hz
        if rate is None:
            return
        values[f"{name}.periodicity"] = f"{_in_words(rate, 'Hz')} -> Desired : {rate_hz} Hz"
        level = _rate_level(rate, rate_hz, self._thresholds.periodicity)
        if judged and level is not Level.OK:
            self._irregular[name] = level

    def conclude(self, kind: str) -> None:
        """Name those out of bounds in the report's message."""
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


def _how_many(active: int, there_are: int, what: str) -> str:
    return f"{'All' if active == there_are else 'Not all'} {what} are active"


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


def _in_words(spread: Spread, unit: str) -> str:
    return (
        f"Avg: {spread.mean:.2f} [{spread.minimum:.2f} - {spread.maximum:.2f}] {unit}, "
        f"StdDev: {spread.standard_deviation:.2f}"
    )
