"""What broadcasters of sensors have in common: they publish a reading every cycle."""

from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration

ParametersT = TypeVar("ParametersT")


class ReadingSink(Protocol):
    """Where readings go; used on the loop thread."""

    def wanted(self) -> bool:
        """Return whether anybody listens now."""
        ...

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), which is reused for the next one."""
        ...


class SensorBroadcaster(Controller[ParametersT]):
    """Publishes the state interfaces that a subclass asks for, in its order.

    Attributes:
        sink: where the readings go; None publishes nothing. Set it before activation.
    """

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: ReadingSink | None = None

    def require(self, **names: str) -> None:
        """Check that parameters are not empty.

        Raises:
            ControllerError: one is; the message names it.
        """
        for name, value in names.items():
            if not value:
                raise ControllerError(f"parameter '{name}' is empty; it must be set")

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim nothing."""
        return InterfaceConfiguration.none()

    def reading(self) -> NDArray[np.float64]:
        """Return the present reading."""
        return self.states.read()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Publish the present reading."""
        if self.sink is not None and self.sink.wanted():
            self.sink.publish(time_s, self.reading())
        return ReturnType.OK
