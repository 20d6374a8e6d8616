"""imu_sensor_broadcaster/IMUSensorBroadcaster: publishes the readings of an IMU."""

from dataclasses import dataclass
from typing import Any, ClassVar

from arm_control.controllers.controller import InterfaceConfiguration
from arm_control.controllers.sensor_broadcasters.sensor_broadcaster import (
    IMU_INTERFACES,
    SensorBroadcaster,
)
from arm_control.errors import ControllerError
from arm_control.parameters import parameter

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
