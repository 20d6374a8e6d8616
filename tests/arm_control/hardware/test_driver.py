"""The base of users' drivers."""

import numpy as np
import pytest

from arm_control import ControllerManager, HardwareReturn, LifecycleState
from arm_control.errors import HardwareInfoError
from arm_control.hardware.driver import SystemInterface
from arm_control.testing import fake_hardware


class Echo(SystemInterface):
    """Shows half of each command."""

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        self.set_state("j0/position", self.get_command("j0/position") / 2.0)
        return HardwareReturn.OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        return HardwareReturn.OK


class Closing(Echo):
    """Records what it releases."""

    def __init__(self, *arguments) -> None:
        super().__init__(*arguments)
        self.closed: list[str] = []

    def on_deactivate(self) -> bool:
        self.closed.append("power")
        return False

    def on_cleanup(self) -> bool:
        self.closed.append("port")
        return True


@pytest.fixture
def info():
    return fake_hardware(("j0", "j1"), state_interfaces=("position",)).info


def test_a_driver_need_only_read_and_write(info):
    echo = Echo(info)
    manager = ControllerManager([echo], 100)
    manager.bring_up()
    assert [c.state for c in manager.list_hardware_components()] == [LifecycleState.ACTIVE]

    echo.commands[:] = (1.0, 2.0)
    manager.write(0.0, 0.01)
    manager.read(0.01, 0.01)

    assert echo.get_state("j0/position") == 0.5
    assert np.isnan(echo.get_state("j1/position"))


def test_a_wrong_name_is_answered_with_the_right_ones(info):
    with pytest.raises(HardwareInfoError) as caught:
        Echo(info).set_state("j9/position", 0.0)
    assert str(caught.value) == (
        "hardware component 'FakeSystem' has no interface 'j9/position'; "
        "it has j0/position, j1/position"
    )


def test_a_shutdown_releases_everything_even_after_failures(info):
    closing = Closing(info)
    assert not closing.on_shutdown()
    assert closing.closed == ["power", "port"]
