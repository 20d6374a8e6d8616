"""force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster: publishes a wrench."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import ControllerContext
from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.parameters import parameter
from arm_control.sensor_broadcaster import SensorBroadcaster
from arm_control.sensor_interfaces import FORCE_TORQUE_INTERFACES


@dataclass(frozen=True, slots=True)
class AxisInterfaces:
    """Full names of the state interfaces along x, y and z; empty where there is none."""

    x: str = parameter("", "State interface along or about x", read_only=True)
    y: str = parameter("", "State interface along or about y", read_only=True)
    z: str = parameter("", "State interface along or about z", read_only=True)


@dataclass(frozen=True, slots=True)
class WrenchInterfaces:
    """Which state interfaces make the wrench."""

    force: AxisInterfaces = AxisInterfaces()
    torque: AxisInterfaces = AxisInterfaces()

    def names(self) -> tuple[str, ...]:
        """Return the six names, forces first."""
        return tuple(
            getattr(vector, axis) for vector in (self.force, self.torque) for axis in "xyz"
        )


@dataclass(frozen=True, slots=True)
class ForceTorqueSensorBroadcasterParameters:
    """Parameters of ForceTorqueSensorBroadcaster."""

    frame_id: str = parameter("", "frame_id of the published headers", read_only=True)
    sensor_name: str = parameter(
        "",
        "Sensor whose force.x to torque.z are published; excludes interface_names",
        read_only=True,
    )
    interface_names: WrenchInterfaces = WrenchInterfaces()


class ForceTorqueSensorBroadcaster(SensorBroadcaster[ForceTorqueSensorBroadcasterParameters]):
    """Publishes up to six state interfaces as a wrench; what has none is NaN."""

    parameters_type: ClassVar[type[Any]] = ForceTorqueSensorBroadcasterParameters
    adapter = "arm_control.ros.sensor_broadcaster_adapters:ForceTorqueSensorBroadcasterAdapter"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._wrench = np.full(len(FORCE_TORQUE_INTERFACES), np.nan)
        self._names: tuple[str, ...] = ()
        self._places: list[int] = []

    def on_configure(self, parameters: ForceTorqueSensorBroadcasterParameters) -> None:
        """Check and take the parameters.

        Raises:
            ControllerError: the frame is missing, or not exactly one of both ways names the
                interfaces.
        """
        self.require(frame_id=parameters.frame_id)
        named = parameters.interface_names.names()
        if bool(parameters.sensor_name) == any(named):
            raise ControllerError(
                "either parameter 'sensor_name' or some of 'interface_names.force.x' to "
                "'interface_names.torque.z' must be set, "
                + ("and both are" if parameters.sensor_name else "and neither is")
            )
        if parameters.sensor_name:
            named = tuple(f"{parameters.sensor_name}/{name}" for name in FORCE_TORQUE_INTERFACES)
        self._wrench[:] = np.nan
        self._names = tuple(name for name in named if name)
        self._places = [place for place, name in enumerate(named) if name]
        super().on_configure(parameters)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the interfaces that the parameters name."""
        return InterfaceConfiguration.individual(self._names)

    def reading(self) -> NDArray[np.float64]:
        """Return force and torque."""
        self._wrench[self._places] = self.states.read()
        return self._wrench
