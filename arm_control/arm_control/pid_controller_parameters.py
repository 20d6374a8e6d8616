"""Parameters of pid_controller/PidController."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import inf
from typing import Any

from arm_control.errors import ParameterError
from arm_control.joint_trajectory.pid import AntiWindup, PidGains
from arm_control.parameters import ParameterSpec, build_parameters, list_among, parameter, specs_of


@dataclass(frozen=True, slots=True)
class DofGains:
    """gains.<dof>: of one degree of freedom."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    u_clamp_max: float = parameter(inf, "Upper bound of the output")
    u_clamp_min: float = parameter(-inf, "Lower bound of the output")
    i_clamp_max: float = parameter(inf, "Upper bound of the integral's part")
    i_clamp_min: float = parameter(-inf, "Lower bound of the integral's part")
    antiwindup: bool = parameter(
        False, "With the strategy legacy: clamp the integral itself, not only its part (deprecated)"
    )
    antiwindup_strategy: str = parameter(
        "legacy",
        "What keeps the integral from running away",
        read_only=True,
        one_of=tuple(strategy.value for strategy in AntiWindup),
    )
    tracking_time_constant: float = parameter(0.0, "Of back_calculation, in s; 0 derives it")
    error_deadband: float = parameter(1e-16, "An error up to this is not integrated")
    feedforward_gain: float = parameter(0.0, "Of the reference, or of its derivative if there is")
    angle_wraparound: bool = parameter(False, "The error goes the short way round a full turn")
    save_i_term: bool = parameter(True, "Keep the integral from one activation to the next")

    def as_pid_gains(self) -> PidGains:
        """Return the gains as the PID controller takes them."""
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
class CommonPidParameters:
    """The parameters that do not depend on the names of the degrees of freedom."""

    dof_names: tuple[str, ...] = parameter((), "Joints or axes to command", read_only=True)
    reference_and_state_dof_names: tuple[str, ...] = parameter(
        (), "Names for references and states, where they differ from dof_names", read_only=True
    )
    command_interface: str = parameter("", "Command interface of each", read_only=True)
    reference_and_state_interfaces: tuple[str, ...] = parameter(
        (), "Interface to control, and optionally its derivative", read_only=True
    )
    set_current_state_as_first_setpoint: bool = parameter(
        True, "At the activation, make the measured states the references", read_only=True
    )
    use_external_measured_states: bool = parameter(
        False, "Take the states from ~/measured_state instead of state interfaces", read_only=True
    )
    enable_feedforward: bool = parameter(False, "Add the reference times feedforward_gain")


@dataclass(frozen=True, slots=True)
class PidControllerParameters(CommonPidParameters):
    """All parameters.

    Attributes:
        gains: by degree of freedom.
    """

    gains: Mapping[str, DofGains] = field(default_factory=dict)

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

    @classmethod
    def specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return every parameter that there is for the names among the given parameters."""
        specs = specs_of(CommonPidParameters)
        for dof in list_among(given, "dof_names"):
            specs += specs_of(DofGains, f"gains.{dof}.")
        return specs

    @classmethod
    def build(cls, values: Mapping[str, Any]) -> "PidControllerParameters":
        """Make an instance from values by full name; what is missing takes its default.

        Raises:
            ParameterError: a name is unknown, or a value cannot be used.
        """
        rest = dict(values)
        gains: dict[str, DofGains] = {}
        for dof in list_among(rest, "dof_names"):
            prefix = f"gains.{dof}."
            own = [name for name in rest if name.startswith(prefix)]
            gains[dof] = build_parameters(
                DofGains, {name.removeprefix(prefix): rest.pop(name) for name in own}
            )
        common = build_parameters(CommonPidParameters, rest)
        parameters = cls(
            **{item.name: getattr(common, item.name) for item in fields(common)}, gains=gains
        )
        parameters.check()
        return parameters

    def gains_of(self, dof: str) -> DofGains:
        """Return the gains of a degree of freedom, the defaults where it has none of its own."""
        return self.gains.get(dof, DofGains())

    def check(self) -> None:
        """Raise `ParameterError` where values contradict each other."""
        for dof, gains in self.gains.items():
            for low, high in (("u_clamp_min", "u_clamp_max"), ("i_clamp_min", "i_clamp_max")):
                if not getattr(gains, low) <= getattr(gains, high):
                    raise ParameterError(
                        f"parameter 'gains.{dof}.{low}' is {getattr(gains, low):g}, above "
                        f"{high} {getattr(gains, high):g}"
                    )
