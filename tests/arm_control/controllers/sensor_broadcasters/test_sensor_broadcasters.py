"""The cores of the IMU and the force-torque sensor broadcaster, with a sink that remembers."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from arm_control import (
    ControllerContext,
    ControllerError,
    ControllerManager,
    HardwareInfo,
    InterfaceInfo,
    JointInfo,
    SwitchRequest,
)
from arm_control.controllers.sensor_broadcasters.controller import (
    FORCE_TORQUE_INTERFACES,
    IMU_INTERFACES,
    AxisInterfaces,
    ForceTorqueSensorBroadcaster,
    ForceTorqueSensorBroadcasterParameters,
    ImuSensorBroadcaster,
    ImuSensorBroadcasterParameters,
    SensorBroadcaster,
    WrenchInterfaces,
)
from arm_control.errors import ParameterError
from arm_control.testing import FakeHardware

Imu = ImuSensorBroadcasterParameters
Wrench = ForceTorqueSensorBroadcasterParameters


class Sink:
    """Records what was published."""

    def __init__(self) -> None:
        self.listened_to = True
        self.published: list[tuple[float, list[float]]] = []

    def wanted(self) -> bool:
        return self.listened_to

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        self.published.append((time_s, reading.tolist()))


def sensor(name: str, interfaces: tuple[str, ...]) -> FakeHardware:
    """Return a sensor whose last interface shows 10, the one before 11, and so on."""
    shown = [InterfaceInfo(interface, 10.0 + i) for i, interface in enumerate(interfaces[::-1])]
    part = JointInfo(name, state_interfaces=tuple(shown))
    return FakeHardware(HardwareInfo("sim", "sensor", "any/Plugin", sensors=(part,)))


def start(
    broadcaster: SensorBroadcaster[Any], parameters: object, hardware: FakeHardware
) -> tuple[ControllerManager, Sink]:
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    manager.load_controller(broadcaster, "test/It")
    manager.configure_controller(broadcaster.name, parameters)
    sink = Sink()
    broadcaster.sink = sink
    assert manager.switch_controller(SwitchRequest((broadcaster.name,))).ok
    return manager, sink


@pytest.fixture
def imu() -> ImuSensorBroadcaster:
    return ImuSensorBroadcaster(ControllerContext("imu_broadcaster", 100))


@pytest.fixture
def wrench() -> ForceTorqueSensorBroadcaster:
    return ForceTorqueSensorBroadcaster(ControllerContext("ft_broadcaster", 100))


def test_an_imu_is_published_in_the_messages_order_with_the_time_of_the_state(imu):
    hardware = sensor("imu", IMU_INTERFACES)
    manager, sink = start(imu, Imu("imu", "imu_link"), hardware)
    manager.read(1.25, 0.01)
    manager.publish(1.25, 0.01)
    assert sink.published == [(1.25, [19.0, 18.0, 17.0, 16.0, 15.0, 14.0, 13.0, 12.0, 11.0, 10.0])]


def test_nothing_is_published_without_a_subscriber(imu):
    manager, sink = start(imu, Imu("imu", "imu_link"), sensor("imu", IMU_INTERFACES))
    sink.listened_to = False
    manager.publish(1.25, 0.01)
    assert sink.published == []


def test_an_imu_with_fewer_interfaces_is_not_activated(imu):
    manager = ControllerManager([sensor("imu", IMU_INTERFACES[:9])], 100)
    manager.bring_up()
    manager.load_controller(imu, "test/It")
    manager.configure_controller("imu_broadcaster", Imu("imu", "imu_link"))
    result = manager.switch_controller(SwitchRequest(("imu_broadcaster",)))
    assert not result.ok
    assert "imu/linear_acceleration.z" in result.message


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        (Imu("", "f"), "parameter 'sensor_name' is empty"),
        (Imu("s", ""), "parameter 'frame_id' is empty"),
        (
            Imu("s", "f", static_covariance_angular_velocity=(1.0,)),
            "'static_covariance_angular_velocity' has 1 numbers; it takes 9",
        ),
    ],
)
def test_an_imu_without_what_it_needs_is_refused(imu, parameters, said):
    with pytest.raises(ControllerError, match=said):
        imu.on_configure(parameters)


def test_a_wrench_is_published(wrench):
    hardware = sensor("wrist", FORCE_TORQUE_INTERFACES)
    manager, sink = start(wrench, Wrench("tool", "wrist"), hardware)
    manager.read(0.5, 0.01)
    manager.publish(0.5, 0.01)
    assert sink.published == [(0.5, [15.0, 14.0, 13.0, 12.0, 11.0, 10.0])]


def test_axes_can_be_named_one_by_one_and_the_others_are_nan(wrench):
    names = WrenchInterfaces(AxisInterfaces(z="cell/weight"), AxisInterfaces(x="cell/twist"))
    hardware = sensor("cell", ("weight", "twist"))
    manager, sink = start(wrench, Wrench("tool", interface_names=names), hardware)
    manager.read(0.5, 0.01)
    manager.publish(0.5, 0.01)
    ((_, reading),) = sink.published
    assert reading[2:4] == [11.0, 10.0]
    assert [math.isnan(value) for value in reading] == [True, True, False, False, True, True]


def test_a_wrench_is_offset_then_multiplied_and_both_may_change(wrench):
    build = ForceTorqueSensorBroadcaster.build_parameters
    names = {"frame_id": "tool", "sensor_name": "wrist"}
    calibrated = build({**names, "offset.force.x": -15.0, "multiplier.torque.z": 2.0})
    manager, sink = start(wrench, calibrated, sensor("wrist", FORCE_TORQUE_INTERFACES))
    manager.read(0.5, 0.01)
    manager.publish(0.5, 0.01)
    wrench.update_parameters(build({**names, "offset.force.y": 1.0, "multiplier.force.y": -2.0}))
    manager.publish(0.51, 0.01)
    assert sink.published == [
        (0.5, [0.0, 14.0, 13.0, 12.0, 11.0, 20.0]),
        (0.51, [15.0, -30.0, 13.0, 12.0, 11.0, 10.0]),
    ]


def test_a_chain_of_filters_is_refused(wrench):
    given = {"sensor_filter_chain.filter1.type": "control_filters/LowPassFilterWrench"}
    with pytest.raises(ParameterError, match=r"'sensor_filter_chain.filter1.type' requests a"):
        wrench.parameter_specs(given)


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        (Wrench("", "s"), "parameter 'frame_id' is empty"),
        (Wrench("f"), "must be set, and neither is"),
        (Wrench("f", "s", WrenchInterfaces(AxisInterfaces(x="a/b"))), "must be set, and both are"),
    ],
)
def test_a_wrench_needs_either_a_sensor_or_interface_names(wrench, parameters, said):
    with pytest.raises(ControllerError, match=said):
        wrench.on_configure(parameters)
