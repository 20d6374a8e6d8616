"""Parameters of pid_controller/PidController."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

from arm_control.controllers.pid import AntiWindup, PidGains
from arm_control.errors import ParameterError
from arm_control.parameters import parameter, parameter_groups


@dataclass(frozen=True, slots=True)
class DofGains:
    """gains.<dof>: gains of one degree of freedom."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    u_clamp_max: float = parameter(inf, "Upper bound of the output")
    u_clamp_min: float = parameter(-inf, "Lower bound of the output")
    i_clamp_max: float = parameter(inf, "Upper bound of the integral's contribution")
    i_clamp_min: float = parameter(-inf, "Lower bound of the integral's contribution")
    antiwindup: bool = parameter(
        False, "Deprecated; with strategy legacy, clamp the integral, not only its contribution"
    )
    antiwindup_strategy: str = parameter(
        "legacy", "Anti-windup strategy", one_of=tuple(strategy.value for strategy in AntiWindup)
    )
    tracking_time_constant: float = parameter(0.0, "Of back_calculation, in s; 0: from the gains")
    error_deadband: float = parameter(1e-16, "Errors up to this are not integrated")
    feedforward_gain: float = parameter(
        0.0, "Gain of the reference, or of its derivative if there is one"
    )
    angle_wraparound: bool = parameter(False, "Take the shortest rotation as the error")
    save_i_term: bool = parameter(True, "Keep the integral from one activation to the next")
    activate_state_publisher: bool = parameter(
        False, "Publish errors and gains on ~/<dof>/pid_state"
    )

    def as_pid_gains(self) -> PidGains:
        """Return the gains in the form that `Pid` takes."""
        return PidGains(
            p=self.p,
            i=self.i,
            d=self.d,
            i_max=self.i_clamp_max,
            i_min=self.i_clamp_min,
            u_max=self.u_clamp_max,
            u_min=self.u_clamp_min,
            anti_windup=AntiWindup(self.antiwindup_strategy),
            clamps_integral=self.antiwindup,
            tracking_time_constant=self.tracking_time_constant,
            error_deadband=self.error_deadband,
        )


@dataclass(frozen=True, slots=True)
class PidControllerParameters:
    """All parameters.

    Attributes:
        gains: by degree of freedom.
    """

    dof_names: tuple[str, ...] = parameter((), "Joints or axes to command", read_only=True)
    reference_and_state_dof_names: tuple[str, ...] = parameter(
        (), "Names for references and states if they differ from dof_names", read_only=True
    )
    command_interface: str = parameter("", "Command interface of each", read_only=True)
    reference_and_state_interfaces: tuple[str, ...] = parameter(
        (), "Interface to control, and optionally its derivative", read_only=True
    )
    set_current_state_as_first_setpoint: bool = parameter(
        True, "At activation, use the measured states as references", read_only=True
    )
    use_external_measured_states: bool = parameter(
        False,
        "Take the states from ~/measured_state instead of state interfaces",
        at_configuration=True,
    )
    enable_feedforward: bool = parameter(False, "Add the reference times feedforward_gain")
    gains: Mapping[str, DofGains] = parameter_groups(DofGains, by="dof_names")

    @property
    def state_dof_names(self) -> tuple[str, ...]:
        """Names of references and states."""
        return self.reference_and_state_dof_names or self.dof_names

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of references and states with their interfaces, interface by interface."""
        return tuple(
            f"{dof}/{interface}"
            for interface in self.reference_and_state_interfaces
            for dof in self.state_dof_names
        )

    def gains_of(self, dof: str) -> DofGains:
        """Return the gains of a degree of freedom, or the defaults."""
        return self.gains.get(dof, DofGains())

    def check_together(self) -> None:
        """Raise `ParameterError` if values contradict each other."""
        for dof, gains in self.gains.items():
            for low, high in (("u_clamp_min", "u_clamp_max"), ("i_clamp_min", "i_clamp_max")):
                if not getattr(gains, low) <= getattr(gains, high):
                    raise ParameterError(
                        f"parameter 'gains.{dof}.{low}' is {getattr(gains, low):g}, above "
                        f"{high} {getattr(gains, high):g}"
                    )
