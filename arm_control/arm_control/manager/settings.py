"""The controller manager's own parameters, under ros2_control's names."""

from dataclasses import field

from arm_control.parameters import parameter
from arm_node.frozen import frozen


@frozen
class ManagerPolicy:
    """The user's choices; the defaults are ros2_control's.

    Attributes:
        handle_exceptions: whether an exception of a controller or component in a cycle stops only
            that one; otherwise it ends the control loop.
        activate_with_inactive_hardware: whether controllers may claim command interfaces of
            inactive components.
        stop_with_self_deactivated_hardware: whether controllers are stopped when a component that
            they command deactivates itself; otherwise they go on without effect.
        end_on_initial_state_failure: whether the start fails if a component does not reach its
            initial state; otherwise that is only logged.
    """

    handle_exceptions: bool = True
    activate_with_inactive_hardware: bool = False
    stop_with_self_deactivated_hardware: bool = True
    end_on_initial_state_failure: bool = True


@frozen
class RateBand:
    """Deviations of a rate, in Hz."""

    warn: float = parameter(5.0, "Deviation in Hz above which to warn", above=0.0)
    error: float = parameter(10.0, "Deviation in Hz above which it is an error", above=0.0)


@frozen
class MeanTimeBand:
    """Mean execution times, in microseconds."""

    warn: float = parameter(1000.0, "Microseconds above which to warn", above=0.0)
    error: float = parameter(2000.0, "Microseconds above which it is an error", above=0.0)


@frozen
class TimeDeviationBand:
    """Standard deviations of execution times, in microseconds."""

    warn: float = parameter(100.0, "Microseconds above which to warn", above=0.0)
    error: float = parameter(200.0, "Microseconds above which it is an error", above=0.0)


@frozen
class PeriodicityThresholds:
    """Thresholds of a rate's deviation from its nominal value."""

    mean_error: RateBand = RateBand()
    standard_deviation: RateBand = RateBand()


@frozen
class ExecutionTimeThresholds:
    """Thresholds of an execution time."""

    mean_error: MeanTimeBand = MeanTimeBand()
    standard_deviation: TimeDeviationBand = TimeDeviationBand()


@frozen
class _LoopThresholds:
    """Thresholds of the manager's loop."""

    periodicity: PeriodicityThresholds = PeriodicityThresholds()


@frozen
class RunThresholds:
    """Thresholds of controllers or components."""

    periodicity: PeriodicityThresholds = PeriodicityThresholds()
    execution_time: ExecutionTimeThresholds = ExecutionTimeThresholds()


@frozen
class DiagnosticThresholds:
    """All thresholds, with the names of ros2_control's parameters diagnostics.threshold.*."""

    controller_manager: _LoopThresholds = _LoopThresholds()
    controllers: RunThresholds = RunThresholds()
    hardware_components: RunThresholds = RunThresholds()


@frozen
class _SwitchDefaults:
    """Defaults of switch requests."""

    strictness: str = parameter(
        "best_effort",
        "Strictness of a switch request without one: best_effort or strict",
        one_of=("best_effort", "strict"),
    )


@frozen
class _Defaults:
    """Defaults of requests."""

    switch_controller: _SwitchDefaults = _SwitchDefaults()
    allow_controller_activation_with_inactive_hardware: bool = parameter(
        False,
        "Whether controllers may claim command interfaces of inactive hardware",
        read_only=True,
    )
    deactivate_controllers_on_hardware_self_deactivate: bool = parameter(
        True,
        "Whether to stop controllers whose hardware deactivates itself",
        read_only=True,
    )


@frozen
class _InitialState:
    """Hardware components that are not activated at the start."""

    unconfigured: tuple[str, ...] = parameter((), "Components to leave unconfigured")
    inactive: tuple[str, ...] = parameter((), "Components to configure only")
    shutdown_on_initial_state_failure: bool = parameter(
        True,
        "Whether the process ends if a component does not reach its initial state",
        read_only=True,
    )


@frozen
class _Overruns:
    """What to do when the loop is late."""

    print_warnings: bool = parameter(True, "Log when the loop cannot keep its pace")


@frozen
class _Diagnostics:
    """How the manager's health is assessed."""

    threshold: DiagnosticThresholds = field(default_factory=DiagnosticThresholds)


@frozen
class DiagnosticUpdater:
    """How the manager's health is published."""

    period: float = parameter(1.0, "Seconds of wall time between two reports", above=0.0)
    use_fqn: bool = parameter(False, "Whether reports name the node with its namespace")


@frozen
class ManagerSettings:
    """Parameters of the node /controller_manager."""

    update_rate: int = parameter(100, "Control cycles per second", read_only=True, above=0)
    thread_priority: int = parameter(
        50,
        "SCHED_FIFO priority of the control loop, if the process has the right, with a niceness of "
        "-20 for the other threads of the process; 0 for the ordinary scheduler",
        read_only=True,
        at_least=0,
        at_most=99,
    )
    enforce_command_limits: bool = parameter(
        False,
        "Clamp every command to the limits that the robot description gives for its joint",
        read_only=True,
    )
    handle_exceptions: bool = parameter(
        True,
        "Stop only the controller or hardware component that raises; if false, end the process",
        read_only=True,
    )
    defaults: _Defaults = _Defaults()
    hardware_components_initial_state: _InitialState = _InitialState()
    overruns: _Overruns = _Overruns()
    diagnostics: _Diagnostics = _Diagnostics()
    diagnostic_updater: DiagnosticUpdater = DiagnosticUpdater()

    @property
    def policy(self) -> ManagerPolicy:
        """The choices among these parameters."""
        return ManagerPolicy(
            handle_exceptions=self.handle_exceptions,
            activate_with_inactive_hardware=(
                self.defaults.allow_controller_activation_with_inactive_hardware
            ),
            stop_with_self_deactivated_hardware=(
                self.defaults.deactivate_controllers_on_hardware_self_deactivate
            ),
            end_on_initial_state_failure=(
                self.hardware_components_initial_state.shutdown_on_initial_state_failure
            ),
        )
