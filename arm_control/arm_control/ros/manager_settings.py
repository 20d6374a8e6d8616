"""The controller manager's own parameters, under ros2_control's names."""

from dataclasses import dataclass, field

from arm_control.diagnostic_thresholds import DiagnosticThresholds
from arm_control.manager_policy import ManagerPolicy
from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class SwitchDefaults:
    """What a switch request leaves open."""

    strictness: str = parameter(
        "best_effort",
        "Of a switch that names none: best_effort or strict",
        one_of=("best_effort", "strict"),
    )


@dataclass(frozen=True, slots=True)
class Defaults:
    """Defaults of requests."""

    switch_controller: SwitchDefaults = SwitchDefaults()
    allow_controller_activation_with_inactive_hardware: bool = parameter(
        False,
        "Whether controllers may claim command interfaces of hardware that is only configured",
        read_only=True,
    )
    deactivate_controllers_on_hardware_self_deactivate: bool = parameter(
        True,
        "Whether controllers stop that command hardware which deactivates itself in its write",
        read_only=True,
    )


@dataclass(frozen=True, slots=True)
class InitialState:
    """Which hardware components are not activated at the start."""

    unconfigured: tuple[str, ...] = parameter((), "Components to leave unconfigured")
    inactive: tuple[str, ...] = parameter((), "Components to configure only")
    shutdown_on_initial_state_failure: bool = parameter(
        True,
        "Whether the process ends where a component does not reach its initial state",
        read_only=True,
    )


@dataclass(frozen=True, slots=True)
class Overruns:
    """What to do when the loop is late."""

    print_warnings: bool = parameter(True, "Say in the log when the loop cannot keep its pace")


@dataclass(frozen=True, slots=True)
class Diagnostics:
    """How the manager's health is judged."""

    threshold: DiagnosticThresholds = field(default_factory=DiagnosticThresholds)


@dataclass(frozen=True, slots=True)
class DiagnosticUpdater:
    """How the manager's health is published."""

    period: float = parameter(1.0, "Seconds of wall time between two reports", above=0.0)
    use_fqn: bool = parameter(False, "Whether reports name the node with its namespace")


@dataclass(frozen=True, slots=True)
class ManagerSettings:
    """Parameters of the node /controller_manager."""

    update_rate: int = parameter(100, "Control cycles per second", read_only=True, above=0)
    thread_priority: int = parameter(
        50,
        "SCHED_FIFO priority of the control loop where the process may; 0 for the ordinary one",
        read_only=True,
        above=-1,
        at_most=99,
    )
    enforce_command_limits: bool = parameter(
        False,
        "Clamp every command to the limits that the robot description gives for its joint",
        read_only=True,
    )
    handle_exceptions: bool = parameter(
        True,
        "Stop only the controller or hardware component that raises; otherwise the process ends",
        read_only=True,
    )
    defaults: Defaults = Defaults()
    hardware_components_initial_state: InitialState = InitialState()
    overruns: Overruns = Overruns()
    diagnostics: Diagnostics = Diagnostics()
    diagnostic_updater: DiagnosticUpdater = DiagnosticUpdater()

    @property
    def policy(self) -> ManagerPolicy:
        """The choices that these parameters leave to the user."""
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
