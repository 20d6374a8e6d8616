"""The broadcasters of sensors, which publish a reading in every cycle: IMU, force and torque."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.controllers.sensor_broadcasters.readings import (
    FORCE_TORQUE_INTERFACES,
    IMU_INTERFACES,
    ReadingSink,
)
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import ParameterSpec, parameter

ParametersT = TypeVar("ParametersT")


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


COVARIANCE_SIZE = 9
NO_COVARIANCE = (0.0,) * COVARIANCE_SIZE


@dataclass(frozen=True, slots=True)
class ImuSensorBroadcasterParameters:
    """Parameters of ImuSensorBroadcaster; covariances are 3x3, row by row."""

    sensor_name: str = parameter(
        "", "Sensor whose state interfaces are published", at_configuration=True
    )
    frame_id: str = parameter("", "frame_id of the published headers", at_configuration=True)
    static_covariance_orientation: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Covariance of the orientation, in rad^2", at_configuration=True
    )
    static_covariance_angular_velocity: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Covariance of the angular velocity, in rad^2/s^2", at_configuration=True
    )
    static_covariance_linear_acceleration: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Covariance of the linear acceleration, in m^2/s^4", at_configuration=True
    )


class ImuSensorBroadcaster(SensorBroadcaster[ImuSensorBroadcasterParameters]):
    """Publishes ten state interfaces of one sensor as an IMU message."""

    parameters_type: ClassVar[type[Any]] = ImuSensorBroadcasterParameters
    adapter = "arm_control.controllers.sensor_broadcasters.ros:ImuSensorBroadcasterAdapter"

    def on_configure(self, parameters: ImuSensorBroadcasterParameters) -> None:
        """Check and take the parameters.

        Raises:
            ControllerError: a name is missing, or a covariance does not have nine numbers.
        """
        self.require(sensor_name=parameters.sensor_name, frame_id=parameters.frame_id)
        for name in ("orientation", "angular_velocity", "linear_acceleration"):
            full_name = f"static_covariance_{name}"
            count = len(getattr(parameters, full_name))
            if count != COVARIANCE_SIZE:
                raise ControllerError(
                    f"parameter '{full_name}' has {count} numbers; it takes {COVARIANCE_SIZE}, "
                    "row by row"
                )
        super().on_configure(parameters)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the sensor's ten interfaces."""
        sensor = self.parameters.sensor_name
        return InterfaceConfiguration.individual(f"{sensor}/{name}" for name in IMU_INTERFACES)


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
