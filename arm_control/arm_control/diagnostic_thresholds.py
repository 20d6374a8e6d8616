"""From when on a controller manager's figures are worth a warning, or an error."""

from dataclasses import dataclass

from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class RateBand:
    """Deviations of a rate, in Hz."""

    warn: float = parameter(5.0, "A warning from this many Hz on", above=0.0)
    error: float = parameter(10.0, "An error from this many Hz on", above=0.0)


@dataclass(frozen=True, slots=True)
class MeanTimeBand:
    """Mean execution times, in microseconds."""

    warn: float = parameter(1000.0, "A warning from this many microseconds on", above=0.0)
    error: float = parameter(2000.0, "An error from this many microseconds on", above=0.0)


@dataclass(frozen=True, slots=True)
class TimeDeviationBand:
    """Standard deviations of execution times, in microseconds."""

    warn: float = parameter(100.0, "A warning from this many microseconds on", above=0.0)
    error: float = parameter(200.0, "An error from this many microseconds on", above=0.0)


@dataclass(frozen=True, slots=True)
class PeriodicityThresholds:
    """Of a rate against the rate that it should be."""

    mean_error: RateBand = RateBand()
    standard_deviation: RateBand = RateBand()


@dataclass(frozen=True, slots=True)
class ExecutionTimeThresholds:
    """Of an execution time."""

    mean_error: MeanTimeBand = MeanTimeBand()
    standard_deviation: TimeDeviationBand = TimeDeviationBand()


@dataclass(frozen=True, slots=True)
class LoopThresholds:
    """Of the manager's own loop."""

    periodicity: PeriodicityThresholds = PeriodicityThresholds()


@dataclass(frozen=True, slots=True)
class RunThresholds:
    """Of what the loop runs."""

    periodicity: PeriodicityThresholds = PeriodicityThresholds()
    execution_time: ExecutionTimeThresholds = ExecutionTimeThresholds()


@dataclass(frozen=True, slots=True)
class DiagnosticThresholds:
    """All of them, as the parameters diagnostics.threshold.* of ros2_control."""

    controller_manager: LoopThresholds = LoopThresholds()
    controllers: RunThresholds = RunThresholds()
    hardware_components: RunThresholds = RunThresholds()
