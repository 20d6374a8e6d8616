"""The controller manager's own parameters, under ros2_control's names."""

from dataclasses import dataclass

from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class SwitchDefaults:
    """What a switch request leaves open."""

    strictness: str = parameter("best_effort", "Of a switch that names none: best_effort or strict")


@dataclass(frozen=True, slots=True)
class Defaults:
    """Defaults of requests."""

    switch_controller: SwitchDefaults = SwitchDefaults()


@dataclass(frozen=True, slots=True)
class InitialState:
    """Which hardware components are not activated at the start."""

    unconfigured: tuple[str, ...] = parameter((), "Components to leave unconfigured")
    inactive: tuple[str, ...] = parameter((), "Components to configure only")


@dataclass(frozen=True, slots=True)
class Overruns:
    """What to do when the loop is late."""

    print_warnings: bool = parameter(True, "Say in the log when the loop cannot keep its pace")


@dataclass(frozen=True, slots=True)
class ManagerSettings:
    """Parameters of the node /controller_manager."""

    update_rate: int = parameter(100, "Control cycles per second")
    defaults: Defaults = Defaults()
    hardware_components_initial_state: InitialState = InitialState()
    overruns: Overruns = Overruns()
