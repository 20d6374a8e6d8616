"""pid_controller/PidController: tracks references from a topic or another controller."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.angles import shortest_angular_distance
from arm_control.controllers.controller import (
    ChainableController,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.controllers.pid import AntiWindup, Pid, PidGains
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import parameter, parameter_groups
from arm_control.run_inputs import run_input


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


STATE_FIELDS = (
    "reference",
    "feedback",
    "feedback_dot",
    "error",
    "error_dot",
    "time_step",
    "output",
)

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PidTerms:
    """The terms of the output of one degree of freedom.

    Attributes:
        period_s: length of this cycle.
        error: reference minus state.
        error_rate: the error's derivative.
        integral: the integral's contribution to the output.
        gains: the current gains.
        output: the command.
    """

    period_s: float
    error: float
    error_rate: float
    integral: float
    gains: DofGains
    output: float


class PidStateSink(Protocol):
    """Receives the controller's state on the loop thread."""

    def publish(self, time_s: float, state: Array) -> None:
        """Publish one state, (n, len(STATE_FIELDS)); the array is reused for the next one."""
        ...

    def publish_terms(self, time_s: float, dof: int, terms: PidTerms) -> None:
        """Publish the terms of the output of the degree of freedom with this index."""
        ...


class PidController(ChainableController[PidControllerParameters]):
    """Commands each degree of freedom from the error of its reference.

    A reference of NaN leaves the command unchanged. With two interfaces, the second is the
    derivative of the first, and its error is the derivative of the error; otherwise the error is
    differentiated numerically.

    Attributes:
        sink: receives the state; None publishes nothing. Set it before activation.
        is_feedforward_enabled: whether feed-forward is added to the output.
    """

    parameters_type = PidControllerParameters
    adapter = "arm_control.controllers.pid_controller.ros:PidControllerAdapter"
    transient = ("_shape", "_state", "_gains", "_watched", "_wraps", "_feedforward")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: PidStateSink | None = None
        self.is_feedforward_enabled = False
        self._offered: deque[Array] = deque(maxlen=1)
        self._measured = np.empty((0, 0))
        self._set_up(PidControllerParameters())

    def on_configure(self, parameters: PidControllerParameters) -> None:
        """Take the parameters.

        Raises:
            ControllerError: names or interfaces are missing or do not match.
        """
        interfaces = parameters.reference_and_state_interfaces
        if not parameters.dof_names:
            raise ControllerError("'dof_names' parameter was empty")
        if not parameters.command_interface:
            raise ControllerError("'command_interface' parameter was empty")
        if len(interfaces) not in (1, 2):
            raise ControllerError(
                "'reference_and_state_interfaces' takes one interface, or two of which the second "
                f"is the derivative of the first, not {len(interfaces)}"
            )
        if len(parameters.state_dof_names) != len(parameters.dof_names):
            raise ControllerError(
                f"'dof_names' has {len(parameters.dof_names)} names, but "
                f"'reference_and_state_dof_names' has {len(parameters.state_dof_names)}"
            )
        super().on_configure(parameters)
        self.is_feedforward_enabled = parameters.enable_feedforward
        self._set_up(parameters)

    def update_parameters(self, parameters: PidControllerParameters) -> None:
        """Take changed gains; the integral stays."""
        if parameters.enable_feedforward != self.parameters.enable_feedforward:
            self.is_feedforward_enabled = parameters.enable_feedforward
        super().update_parameters(parameters)
        self._take_gains(parameters)

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the command interface of each degree of freedom."""
        interface = self.parameters.command_interface
        return InterfaceConfiguration.individual(
            f"{dof}/{interface}" for dof in self.parameters.dof_names
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the controlled states, unless they come by topic."""
        if self.parameters.use_external_measured_states:
            return InterfaceConfiguration.none()
        return InterfaceConfiguration.individual(self.parameters.state_names)

    def reference_names(self) -> tuple[str, ...]:
        """Export a reference for each state."""
        return self.parameters.state_names

    def exported_state_names(self) -> tuple[str, ...]:
        """Export each state as it was measured."""
        return self.parameters.state_names

    @run_input
    def offer(
        self, names: Sequence[str], values: Sequence[float], derivatives: Sequence[float] = ()
    ) -> str:
        """Set the references from the next cycle on; any thread. NaN leaves one unchanged.

        Args:
            names: degrees of freedom in any order; empty for the order of the parameters.
            values: one value of the first interface for each.
            derivatives: one value of the second interface for each, or none.

        Returns:
            Why it was refused; empty if it was accepted.
        """
        rows, reason = self._arranged(names, values, derivatives)
        if not reason:
            self._offered.append(rows)
        return reason

    @run_input
    def offer_measured(
        self, names: Sequence[str], values: Sequence[float], derivatives: Sequence[float] = ()
    ) -> str:
        """Set the measured states; like `offer`."""
        rows, reason = self._arranged(names, values, derivatives)
        if not reason:
            self._measured = rows
        return reason

    @run_input
    def enable_feedforward(self, is_enabled: bool) -> None:
        """Add feed-forward to the output, or leave it out; any thread."""
        self.is_feedforward_enabled = is_enabled

    def take_command(self, values: Sequence[float]) -> None:
        """Take a reference for each degree of freedom; see `offer`.

        Raises:
            ControllerError: the command is refused.
        """
        reason = self.offer((), values)
        if reason:
            raise ControllerError(f"a reference was dropped: {reason}")

    def on_activate(self) -> None:
        """Reset the controller; the references are the current states, or NaN."""
        parameters = self.parameters
        self._offered.clear()
        if (
            parameters.set_current_state_as_first_setpoint
            and not parameters.use_external_measured_states
        ):
            self.references[:] = self.states.read()
        self._measured = np.full(self._shape, np.nan)
        self._last_error = np.full(self._shape[1], np.nan)
        self._pid.reset(np.array([gains.save_i_term for gains in self._gains], dtype=np.bool_))

    def on_reset(self) -> None:
        """Reset the controller and its integrals; the references are unknown, as at activation."""
        self.references[:] = np.nan
        self.on_activate()
        self._pid.reset(np.zeros(self._shape[1], dtype=np.bool_))

    def on_set_chained_mode(self, is_chained: bool) -> None:
        """Drop the pending references: they are from before the change."""
        self._offered.clear()

    def on_deactivate(self) -> None:
        """Command 0, unless positions are commanded."""
        if self.parameters.command_interface != "position":
            self.commands.write(0.0)

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Apply the pending references."""
        if self._offered:
            offered = self._offered.pop().ravel()
            given = ~np.isnan(offered)
            self.references[given] = offered[given]
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Compute the commands from the errors."""
        references = self.references.reshape(self._shape)
        measured = self._measured
        if not self.parameters.use_external_measured_states:
            measured = self.states.read().reshape(self._shape)
        self.exported_states[:] = measured.ravel()
        error = references[0] - measured[0]
        if self._wraps.any():
            error = np.where(
                self._wraps, shortest_angular_distance(measured[0], references[0]), error
            )
        rate = self._error_rate(references, measured, error, period_s)
        output = self._pid.update(error, np.where(np.isnan(rate), 0.0, rate), period_s)
        if self.is_feedforward_enabled:
            forward = references[-1] * self._feedforward
            output = output + np.where(np.isnan(forward), 0.0, forward)
        present = self.commands.read()
        command = np.where(np.isfinite(error), output, present)
        self.commands.write(command)
        self._publish(time_s, (references[0], measured, error, rate, period_s, command))
        self._publish_terms(time_s, period_s, error, rate, command)
        return ReturnType.OK

    def _error_rate(
        self, references: Array, measured: Array, error: Array, period_s: float
    ) -> NDArray[np.float64]:
        """Return the errors' derivatives: measured if possible, else by differences."""
        differences = (error - self._last_error) / period_s
        self._last_error = error
        if len(references) == 1:
            return differences
        given = references[1] - measured[1]
        return np.where(np.isfinite(given), given, differences)

    def _publish(
        self, time_s: float, state: tuple[Array, Array, Array, Array, float, Array]
    ) -> None:
        if self.sink is None:
            return
        reference, measured, error, rate, period_s, output = state
        feedback_dot = measured[1] if len(measured) == 2 else 0.0
        columns = (reference, measured[0], feedback_dot, error, rate, period_s, output)
        for i, column in enumerate(columns):
            self._state[:, i] = column
        self.sink.publish(time_s, self._state)

    def _publish_terms(
        self, time_s: float, period_s: float, error: Array, rate: Array, output: Array
    ) -> None:
        if self.sink is None or not self._watched:
            return
        integral = self._pid.integral
        for dof in self._watched:
            terms = PidTerms(
                period_s,
                float(error[dof]),
                float(rate[dof]),
                float(integral[dof]),
                self._gains[dof],
                float(output[dof]),
            )
            self.sink.publish_terms(time_s, dof, terms)

    def _set_up(self, parameters: PidControllerParameters) -> None:
        count = len(parameters.dof_names)
        self._shape = (len(parameters.reference_and_state_interfaces), count)
        self._state = np.zeros((count, len(STATE_FIELDS)))
        self._last_error = np.full(count, np.nan)
        self._pid = Pid([DofGains().as_pid_gains()] * count)
        self._take_gains(parameters)

    def _take_gains(self, parameters: PidControllerParameters) -> None:
        self._gains = [parameters.gains_of(dof) for dof in parameters.dof_names]
        self._watched = [i for i, g in enumerate(self._gains) if g.activate_state_publisher]
        self._wraps = np.array([gains.angle_wraparound for gains in self._gains], dtype=np.bool_)
        self._feedforward = np.array([gains.feedforward_gain for gains in self._gains])
        self._pid.set_gains([gains.as_pid_gains() for gains in self._gains])

    def _arranged(
        self, names: Sequence[str], values: Sequence[float], derivatives: Sequence[float]
    ) -> tuple[Array, str]:
        """Return a message's numbers, one row per interface, and why they cannot be used."""
        parameters = self._parameters  # Read once: the loop thread may reset it.
        if parameters is None:
            return np.empty((0, 0)), "the controller is not configured"
        own = parameters.state_dof_names
        rows = np.full((len(parameters.reference_and_state_interfaces), len(own)), np.nan)
        named = list(names) or list(own)
        if sorted(named) != sorted(own):
            return rows, f"it names {', '.join(named)}; the controller has {', '.join(own)}"
        if len(values) != len(own) or len(derivatives) not in (0, len(own)):
            return rows, (
                f"it has {len(values)} values and {len(derivatives)} derivatives; "
                f"the controller has {len(own)} degrees of freedom"
            )
        where = [own.index(name) for name in named]
        rows[0, where] = values
        if len(rows) == 2 and len(derivatives):
            rows[1, where] = derivatives
        if np.isinf(rows).any():
            return rows, "it has an infinite value"
        return rows, ""
