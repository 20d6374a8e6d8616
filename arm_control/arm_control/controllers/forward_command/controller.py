"""Controllers that forward the latest command: forward_command_controller and similar ones."""

from collections.abc import Sequence
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.errors import ControllerError
from arm_control.parameters import parameter
from arm_control.run_inputs import run_input
from arm_node.frozen import frozen

ParametersT = TypeVar("ParametersT")

FIXED_INTERFACE = "Command interface of each joint; fixed, any other value has no effect"
IGNORED_GAIN = "ROS 1 parameter, has no effect"
WRONG_SIZE = "command size (%d) does not match number of interfaces (%d)"
# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_OK = ReturnType.OK
ROUNDING_S = 1e-9
"""Rounding error of an age that is a sum of periods."""
DROPPED = "a command with a NaN or an infinity was dropped: %s"
SHOWN = 16
"""How many values of a dropped command are shown."""


def _command_timeout() -> float:
    return parameter(
        0.0,
        "Seconds without a new command after which the joints hold; 0 for never",
        at_least=0.0,
        at_configuration=True,
    )


@frozen
class ForwardCommandParameters:
    """Parameters of controllers that command one interface of several joints."""

    joints: tuple[str, ...] = parameter(
        (), "Joints to command, in the order of the message", at_configuration=True
    )
    interface_name: str = parameter("", "Command interface of each joint", at_configuration=True)
    command_timeout: float = _command_timeout()


@frozen
class PositionGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupPositionController."""

    interface_name: str = parameter("position", FIXED_INTERFACE, at_configuration=True)


@frozen
class VelocityGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupVelocityController."""

    interface_name: str = parameter("velocity", FIXED_INTERFACE, at_configuration=True)


@frozen
class EffortGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupEffortController."""

    interface_name: str = parameter("effort", FIXED_INTERFACE, at_configuration=True)


@frozen
class MultiInterfaceForwardCommandParameters:
    """Parameters of MultiInterfaceForwardCommandController."""

    joint: str = parameter("", "The joint to command", at_configuration=True)
    interface_names: tuple[str, ...] = parameter(
        (), "Its interfaces, in the message's order", at_configuration=True
    )
    command_timeout: float = _command_timeout()


@frozen
class PidParameters:
    """Gains as in parameter files of ROS 1."""

    p: float = parameter(0.0, IGNORED_GAIN)
    i: float = parameter(0.0, IGNORED_GAIN)
    d: float = parameter(0.0, IGNORED_GAIN)


@frozen
class JointPositionParameters:
    """Parameters of JointPositionController."""

    joint: str = parameter("", "The joint to command", at_configuration=True)
    pid: PidParameters = PidParameters()
    command_timeout: float = _command_timeout()


class ForwardCommander(Controller[ParametersT]):
    """Writes the latest command to its interfaces in every cycle.

    `offer` takes commands from any thread; the latest one wins. From the activation to the first
    command, the interfaces keep their values. If no new command comes for longer than the
    parameter `command_timeout`, in the controller's time, the joints hold until the next one.
    """

    adapter = "arm_control.controllers.forward_command.ros:ForwardCommandAdapter"
    transient = ("_command_names", "_timeout_s", "_seen")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._command_names: tuple[str, ...] = ()
        self._latest: NDArray[np.float64] | None = None
        self._timeout_s = 0.0
        self._seen: NDArray[np.float64] | None = None
        self._age_s = 0.0
        self._is_stale = False

    @run_input
    def offer(self, values: Sequence[float] | NDArray[np.float64]) -> bool:
        """Make this the command from the next cycle on; any thread.

        Args:
            values: shape (n,), one per interface. A wrong length makes the next update fail; an
                empty array is ignored.

        Returns:
            Whether it was accepted; a command with a NaN or an infinity is dropped.
        """
        # A copy, because the message owns its buffer. The assignment is atomic.
        command = np.array(values, dtype=np.float64)
        if not np.isfinite(command).all():
            return False
        self._latest = command
        return True

    def take_command(self, values: Sequence[float]) -> None:
        """Take a command, one value per interface; see `offer`.

        Raises:
            ControllerError: the number of values is wrong, or one is not finite.
        """
        if len(values) != len(self._command_names):
            raise ControllerError(WRONG_SIZE % (len(values), len(self._command_names)))
        if not self.offer(values):
            raise ControllerError(DROPPED % list(values)[:SHOWN])

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the interfaces of the parameters, in their order."""
        return InterfaceConfiguration.individual(self._command_names)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the positions to hold if commands may become stale; otherwise nothing."""
        if not self._timeout_s:
            return InterfaceConfiguration.none()
        return InterfaceConfiguration.individual_best_effort(
            name for name in self._command_names if name.endswith("/position")
        )

    def save_state(self) -> Any:
        """Return the latest command, its age, and whether an update has seen it."""
        return super().save_state(), self._latest is self._seen

    def load_state(self, state: Any) -> None:
        """Continue with a saved command."""
        attributes, is_seen = state
        super().load_state(attributes)
        self._seen = self._latest if is_seen else None

    def fingerprint(self) -> bytes:
        """Return the numbers of the latest command, and whether it is stale."""
        stale = b"stale" if self._is_stale else b""
        return stale if self._latest is None else self._latest.tobytes() + stale

    def on_activate(self) -> None:
        """Drop commands from before the activation: they must not move the robot now."""
        self._latest = self._seen = None
        self._is_stale = False

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Write the latest command; hold once it is stale."""
        command = self._latest
        if command is None or not command.size:
            return _OK
        if command.size != len(self.commands):
            self.logger.error(WRONG_SIZE, command.size, len(self.commands))
            return ReturnType.ERROR
        if command is not self._seen:
            self._seen, self._age_s, self._is_stale = command, 0.0, False
        elif self._timeout_s > 0.0:
            self._age_s += period_s
        if self._is_stale:
            return _OK
        if 0.0 < self._timeout_s < self._age_s - ROUNDING_S:
            self._is_stale = True
            self._hold()
        else:
            self.commands.write(command)
        return _OK

    def _hold(self) -> None:
        """Command the measured positions; where they are unknown, the last commands, or else 0."""
        self.logger.warning(
            "no command for more than %g s (command_timeout): holding until the next one",
            self._timeout_s,
        )
        measured = dict(zip(self.states.names, self.states.read().tolist(), strict=True))
        held = self.commands.read().copy()
        for index, name in enumerate(self.commands.names):
            if not name.endswith("/position"):
                held[index] = 0.0
            elif np.isfinite(measured.get(name, np.nan)):
                held[index] = measured[name]
        self.commands.write(held)


class ForwardCommandController(ForwardCommander[ForwardCommandParameters]):
    """forward_command_controller/ForwardCommandController: one interface of several joints.

    Attributes:
        interface: the command interface of a type with a fixed one; empty if the parameter names
            it.
    """

    interface: ClassVar[str] = ""
    parameters_type: ClassVar[type[Any]] = ForwardCommandParameters

    def on_configure(self, parameters: ForwardCommandParameters) -> None:
        """Take joints and interface.

        Raises:
            ControllerError: one of them is empty.
        """
        if not parameters.joints:
            raise ControllerError("'joints' parameter was empty")
        interface = self.interface or parameters.interface_name
        if not interface:
            raise ControllerError("'interface_name' parameter was empty")
        if interface != parameters.interface_name:
            self.logger.warning(
                "interface_name '%s' has no effect: this type of controller commands '%s'",
                parameters.interface_name,
                interface,
            )
        self._command_names = tuple(f"{joint}/{interface}" for joint in parameters.joints)
        self._timeout_s = parameters.command_timeout
        super().on_configure(parameters)


class JointGroupPositionController(ForwardCommandController):
    """position_controllers/JointGroupPositionController: the joints hold when deactivated."""

    interface = "position"
    parameters_type = PositionGroupParameters


class JointGroupVelocityController(ForwardCommandController):
    """velocity_controllers/JointGroupVelocityController: stops the joints when deactivated."""

    interface = "velocity"
    parameters_type = VelocityGroupParameters

    def on_deactivate(self) -> None:
        """Command zero velocity."""
        self.commands.write(0.0)


class JointGroupEffortController(ForwardCommandController):
    """effort_controllers/JointGroupEffortController: commands no effort when deactivated."""

    interface = "effort"
    parameters_type = EffortGroupParameters

    def on_deactivate(self) -> None:
        """Command zero effort."""
        self.commands.write(0.0)


class MultiInterfaceForwardCommandController(
    ForwardCommander[MultiInterfaceForwardCommandParameters]
):
    """forward_command_controller/MultiInterfaceForwardCommandController: one joint."""

    parameters_type = MultiInterfaceForwardCommandParameters

    def on_configure(self, parameters: MultiInterfaceForwardCommandParameters) -> None:
        """Take joint and interfaces.

        Raises:
            ControllerError: one of them is empty.
        """
        if not parameters.joint:
            raise ControllerError("'joint' parameter was empty")
        if not parameters.interface_names:
            raise ControllerError("'interface_names' parameter was empty")
        self._command_names = tuple(
            f"{parameters.joint}/{interface}" for interface in parameters.interface_names
        )
        self._timeout_s = parameters.command_timeout
        super().on_configure(parameters)


class JointPositionController(ForwardCommander[JointPositionParameters]):
    """position_controllers/JointPositionController of ROS 1: the position of one joint."""

    parameters_type = JointPositionParameters
    adapter = "arm_control.controllers.forward_command.ros:JointCommandAdapter"

    def on_configure(self, parameters: JointPositionParameters) -> None:
        """Take the joint; gains have no effect.

        Raises:
            ControllerError: the joint is empty.
        """
        if not parameters.joint:
            raise ControllerError("'joint' parameter was empty")
        if parameters.pid != PidParameters():
            self.logger.info(
                "the gains under 'pid' have no effect: the hardware controls the position itself"
            )
        self._command_names = (f"{parameters.joint}/position",)
        self._timeout_s = parameters.command_timeout
        super().on_configure(parameters)
