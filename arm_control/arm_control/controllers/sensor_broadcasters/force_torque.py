"""force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster: publishes a wrench."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import ControllerContext, InterfaceConfiguration
from arm_control.controllers.sensor_broadcasters.sensor_broadcaster import (
    FORCE_TORQUE_INTERFACES,
    SensorBroadcaster,
)
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import ParameterSpec, parameter

FILTER_CHAIN = "sensor_filter_chain"


@dataclass(frozen=True, slots=True)
class AxisInterfaces:
    """Full names of the state interfaces for x, y and z; empty for none."""

    x: str = parameter("", "State interface along or about x", at_configuration=True)
    y: str = parameter("", "State interface along or about y", at_configuration=True)
    z: str = parameter("", "State interface along or about z", at_configuration=True)


@dataclass(frozen=True, slots=True)
class WrenchInterfaces:
    """The state interfaces that form the wrench."""

    force: AxisInterfaces = AxisInterfaces()
    torque: AxisInterfaces = AxisInterfaces()


@dataclass(frozen=True, slots=True)
class _AxisOffsets:
    """Offsets added to the readings along or about x, y and z, in N or N m."""

    x: float = parameter(0.0, "Added to the reading along or about x, in N or N m")
    y: float = parameter(0.0, "Added to the reading along or about y, in N or N m")
    z: float = parameter(0.0, "Added to the reading along or about z, in N or N m")


@dataclass(frozen=True, slots=True)
class _WrenchOffsets:
    """Offsets of the readings, added before the multiplication."""

    force: _AxisOffsets = _AxisOffsets()
    torque: _AxisOffsets = _AxisOffsets()


@dataclass(frozen=True, slots=True)
class _AxisMultipliers:
    """Multipliers of the readings along or about x, y and z."""

    x: float = parameter(1.0, "Multiplies the reading along or about x, after its offset")
    y: float = parameter(1.0, "Multiplies the reading along or about y, after its offset")
    z: float = parameter(1.0, "Multiplies the reading along or about z, after its offset")


@dataclass(frozen=True, slots=True)
class _WrenchMultipliers:
    """Multipliers of the readings, applied after the offsets."""

    force: _AxisMultipliers = _AxisMultipliers()
    torque: _AxisMultipliers = _AxisMultipliers()


@dataclass(frozen=True, slots=True)
class ForceTorqueSensorBroadcasterParameters:
    """Parameters of ForceTorqueSensorBroadcaster."""

    frame_id: str = parameter("", "frame_id of the published headers", at_configuration=True)
    sensor_name: str = parameter(
        "",
        "Sensor whose force.x to torque.z are published; excludes interface_names",
        at_configuration=True,
    )
    interface_names: WrenchInterfaces = WrenchInterfaces()
    offset: _WrenchOffsets = _WrenchOffsets()
    multiplier: _WrenchMultipliers = _WrenchMultipliers()


class ForceTorqueSensorBroadcaster(SensorBroadcaster[ForceTorqueSensorBroadcasterParameters]):
    """Publishes up to six state interfaces as a wrench; components without one are NaN.

    It publishes (reading + offset) * multiplier, as in ros2_controllers. Offsets and multipliers
    may change at any time.
    """

    parameters_type: ClassVar[type[Any]] = ForceTorqueSensorBroadcasterParameters
    adapter = "arm_control.controllers.sensor_broadcasters.ros:ForceTorqueSensorBroadcasterAdapter"
    transient = ("_wrench", "_names", "_places", "_offset", "_multiplier")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._wrench = np.full(len(FORCE_TORQUE_INTERFACES), np.nan)
        self._names: tuple[str, ...] = ()
        self._places: list[int] = []
        self._offset = np.zeros(len(FORCE_TORQUE_INTERFACES))
        self._multiplier = np.ones(len(FORCE_TORQUE_INTERFACES))

    @classmethod
    def parameter_specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return the parameters.

        Raises:
            ParameterError: a filter is requested; filters are C++ plugins.
        """
        filters = sorted(name for name in given if name.partition(".")[0] == FILTER_CHAIN)
        if filters:
            raise ParameterError(
                f"parameter '{filters[0]}' requests a filter, but there are none: {FILTER_CHAIN} "
                "names C++ plugins; remove it, or filter ~/wrench in your own node"
            )
        return super().parameter_specs(given)

    def on_configure(self, parameters: ForceTorqueSensorBroadcasterParameters) -> None:
        """Check and take the parameters.

        Raises:
            ControllerError: the frame is missing, or both or neither of 'sensor_name' and
                'interface_names' are set.
        """
        self.require(frame_id=parameters.frame_id)
        named = _six(parameters.interface_names)
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
        self._take_calibration(parameters)

    def update_parameters(self, parameters: ForceTorqueSensorBroadcasterParameters) -> None:
        """Take changed offsets and multipliers."""
        super().update_parameters(parameters)
        self._take_calibration(parameters)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the interfaces that the parameters name."""
        return InterfaceConfiguration.individual(self._names)

    def reading(self) -> NDArray[np.float64]:
        """Return force and torque."""
        self._wrench[self._places] = self.states.read()
        return (self._wrench + self._offset) * self._multiplier

    def _take_calibration(self, parameters: ForceTorqueSensorBroadcasterParameters) -> None:
        self._offset = np.array(_six(parameters.offset))
        self._multiplier = np.array(_six(parameters.multiplier))


def _six(wrench: Any) -> tuple[Any, ...]:
    """Return the six values of a wrench, forces first."""
    return tuple(getattr(part, axis) for part in (wrench.force, wrench.torque) for axis in "xyz")
