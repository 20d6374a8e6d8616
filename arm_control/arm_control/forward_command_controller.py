"""Controllers that hand the latest command through: forward_command_controller and its kin."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.parameters import parameter

ParametersT = TypeVar("ParametersT")

FIXED_INTERFACE = "Command interface of each joint; fixed, another one has no effect"
IGNORED_GAIN = "Known from ROS 1, without effect"


@dataclass(frozen=True, slots=True)
class ForwardCommandParameters:
    """Parameters of the controllers of one interface on several joints."""

    joints: tuple[str, ...] = parameter((), "Joints to command, in the order of the message")
    interface_name: str = parameter("", "Command interface of each joint")


@dataclass(frozen=True, slots=True)
class PositionGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupPositionController."""

    interface_name: str = parameter("position", FIXED_INTERFACE)


@dataclass(frozen=True, slots=True)
class VelocityGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupVelocityController."""

    interface_name: str = parameter("velocity", FIXED_INTERFACE)


@dataclass(frozen=True, slots=True)
class EffortGroupParameters(ForwardCommandParameters):
    """Parameters of JointGroupEffortController."""

    interface_name: str = parameter("effort", FIXED_INTERFACE)


@dataclass(frozen=True, slots=True)
class MultiInterfaceForwardCommandParameters:
    """Parameters of MultiInterfaceForwardCommandController."""

    joint: str = parameter("", "The joint to command")
    interface_names: tuple[str, ...] = parameter((), "Its interfaces, in the message's order")


@dataclass(frozen=True, slots=True)
class PidParameters:
    """Gains as they stand in parameter files of ROS 1."""

    p: float = parameter(0.0, IGNORED_GAIN)
    i: float = parameter(0.0, IGNORED_GAIN)
    d: float = parameter(0.0, IGNORED_GAIN)


@dataclass(frozen=True, slots=True)
class JointPositionParameters:
    """Parameters of JointPositionController."""

    joint: str = parameter("", "The joint to command")
    pid: PidParameters = PidParameters()


class ForwardCommander(Controller[ParametersT]):
    """Rewrites the latest command on its interfaces in every cycle.

    Commands come in from any thread through `offer`: the last one wins. Until the first one after
    an activation the interfaces keep what they had.
    """

    adapter = "arm_control.ros.forward_command_adapter:ForwardCommandAdapter"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._command_names: tuple[str, ...] = ()
        self._latest: NDArray[np.float64] | None = None

    def offer(self, values: Sequence[float] | NDArray[np.float64]) -> bool:
        """Make this the command from the next cycle on; any thread.

        Args:
            values: shape (n,), one per interface. A wrong length fails the next update; no value
                at all counts as no command.

        Returns:
            Whether it was taken: one with a NaN or an infinity is dropped.
        """
        # A copy: the message's buffer is its owner's. The assignment is atomic.
        command = np.array(values, dtype=np.float64)
        if not np.isfinite(command).all():
            return False
        self._latest = command
        return True

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the interfaces of the parameters, in their order."""
        return InterfaceConfiguration.individual(self._command_names)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read nothing."""
        return InterfaceConfiguration.none()

    def on_activate(self) -> None:
        """Drop what came in before: an old command must not move the robot now."""
        self._latest = None

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Write the latest command."""
        command = self._latest
        if command is None or not command.size:
            return ReturnType.OK
        if command.size != len(self.commands):
            self.logger.error(
                "command size (%d) does not match number of interfaces (%d)",
                command.size,
                len(self.commands),
            )
            return ReturnType.ERROR
        self.commands.write(command)
        return ReturnType.OK


class ForwardCommandController(ForwardCommander[ForwardCommandParameters]):
    """forward_command_controller/ForwardCommandController: one interface of several joints.

    Attributes:
        interface: the command interface of a type that has but one; empty where the parameter
            names it.
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


class JointGroupPositionController(ForwardCommandController):
    """position_controllers/JointGroupPositionController: stays where it is when it ends."""

    interface = "position"
    parameters_type = PositionGroupParameters


class JointGroupVelocityController(ForwardCommandController):
    """velocity_controllers/JointGroupVelocityController: stops the joints when it ends."""

    interface = "velocity"
    parameters_type = VelocityGroupParameters

    def on_deactivate(self) -> None:
        """Command a standstill."""
        self.commands.write(0.0)


class JointGroupEffortController(ForwardCommandController):
    """effort_controllers/JointGroupEffortController: lets go of the joints when it ends."""

    interface = "effort"
    parameters_type = EffortGroupParameters

    def on_deactivate(self) -> None:
        """Command no effort."""
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


class JointPositionController(ForwardCommander[JointPositionParameters]):
    """position_controllers/JointPositionController: ROS 1's, one position of one joint."""

    parameters_type = JointPositionParameters
    adapter = "arm_control.ros.forward_command_adapter:JointCommandAdapter"

    def on_configure(self, parameters: JointPositionParameters) -> None:
        """Take the joint; gains have no effect.

        Raises:
            ControllerError: there is no joint.
        """
        if not parameters.joint:
            raise ControllerError("'joint' parameter was empty")
        if parameters.pid != PidParameters():
            self.logger.info(
                "the gains under 'pid' have no effect: the hardware follows positions by itself"
            )
        self._command_names = (f"{parameters.joint}/position",)
