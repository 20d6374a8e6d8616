"""The base class of sensor broadcasters, which publish a reading in every cycle."""

from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.errors import ControllerError

IMU_INTERFACES = (
    "orientation.x",
    "orientation.y",
    "orientation.z",
    "orientation.w",
    "angular_velocity.x",
    "angular_velocity.y",
    "angular_velocity.z",
    "linear_acceleration.x",
    "linear_acceleration.y",
    "linear_acceleration.z",
)
FORCE_TORQUE_INTERFACES = ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z")


ParametersT = TypeVar("ParametersT")


class ReadingSink(Protocol):
    """Receives the readings on the loop thread."""

    def wanted(self) -> bool:
        """Return whether there is a subscriber now."""
        ...

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), which is reused for the next one."""
        ...


class SensorBroadcaster(Controller[ParametersT]):
    """Publishes the state interfaces that a subclass requests, in its order.

    Attributes:
        sink: receives the readings; None publishes nothing. Set it before activation.
    """

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: ReadingSink | None = None

    def require(self, **names: str) -> None:
        """Check that parameters are not empty.

        Raises:
            ControllerError: one is empty; the message names it.
        """
        for name, value in names.items():
            if not value:
                raise ControllerError(f"parameter '{name}' is empty; it must be set")

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim nothing."""
        return InterfaceConfiguration.none()

    def reading(self) -> NDArray[np.float64]:
        """Return the current reading."""
        return self.states.read()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Publish the current reading."""
        if self.sink is not None and self.sink.wanted():
            self.sink.publish(time_s, self.reading())
        return ReturnType.OK
