"""Emulated arms on pseudo terminals, and descriptions of hardware for them."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from arm_control import HardwareInfo, HardwareReturn
from arm_control.hardware.info import parse_hardware_info
from arm_drivers.serial_arm import SerialArm
from arm_sim.bench.feetech_servos import FeetechServos
from arm_sim.bench.serial_device import EmulatedPort

WAIT_S = 60.0
STATES = "".join(f'<state_interface name="{kind}"/>' for kind in ("position", "velocity", "effort"))


def hardware_info(plugin: str, joints: int, **parameters: str) -> HardwareInfo:
    """Return a component with joints j0, j1 and so on, and a finger that mimics j0 doubled."""
    words = "".join(f'<param name="{name}">{value}</param>' for name, value in parameters.items())
    names = [f"j{number}" for number in range(joints)]
    commands = '<command_interface name="position"/><command_interface name="velocity"/>'
    parts = "".join(f'<joint name="{name}">{commands}{STATES}</joint>' for name in names)
    urdf = "".join(
        f'<joint name="{name}" type="revolute"><parent link="base"/><child link="{name}_link"/>'
        f'<limit lower="-3" upper="3" effort="1" velocity="5"/>{mimic}</joint>'
        f'<link name="{name}_link"/>'
        for name, mimic in (
            *((name, "") for name in names),
            ("finger", '<mimic joint="j0" multiplier="2" offset="0.1"/>'),
        )
    )
    return parse_hardware_info(
        f'<robot name="arm"><link name="base"/>{urdf}<ros2_control name="Servos" type="system">'
        f"<hardware><plugin>{plugin}</plugin>{words}</hardware>{parts}"
        f'<joint name="finger">{STATES}</joint></ros2_control></robot>'
    )[0]


@pytest.fixture
def servos() -> FeetechServos:
    return FeetechServos(range(1, 4))


@pytest.fixture
def port(tmp_path: Path, servos: FeetechServos) -> Iterator[EmulatedPort]:
    with EmulatedPort(servos, tmp_path / "port") as plugged:
        yield plugged


@pytest.fixture
def feetech_info(port: EmulatedPort) -> Callable[..., HardwareInfo]:
    def info(**parameters: str) -> HardwareInfo:
        # Patience, because the emulated servos share a busy processor with the test.
        patience = {"reply_timeout": "0.4", "max_missed": "5"}
        given = {"port": str(port.path), **patience, **parameters}
        return hardware_info("arm_drivers/Feetech", 3, **given)

    return info


@pytest.fixture
def make_info() -> Callable[..., HardwareInfo]:
    return hardware_info


@pytest.fixture
def run_until() -> Callable[..., HardwareReturn]:
    """Return what runs the control loop until a condition holds, or the hardware fails."""

    def run(hardware: SerialArm, done: Callable[[], bool] = lambda: False) -> HardwareReturn:
        deadline = time.monotonic() + WAIT_S
        while not done():
            assert time.monotonic() < deadline, "the condition did not come true"
            for cycle in (hardware.read, hardware.write):
                if cycle(0.0, 0.01) is not HardwareReturn.OK:
                    return HardwareReturn.ERROR
            time.sleep(0.002)
        return HardwareReturn.OK

    return run
