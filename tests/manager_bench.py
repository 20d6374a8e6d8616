"""A controller manager over the hardware of a test, ticked by hand."""

from arm_control import ControllerManager, SwitchRequest
from arm_control.manager.switch_planner import Strictness
from arm_control.testing import FakeHardware

PERIOD_S = 0.01


class ManagerBench:
    """A manager at 100 Hz over one component, which is active."""

    def __init__(self, hardware: FakeHardware) -> None:
        self.hardware = hardware
        self.manager = ControllerManager([hardware], 100)
        self.manager.bring_up()
        self.time_s = 0.0

    def switch(self, activate: str = "", deactivate: str = "") -> None:
        """Switch the controllers of these names, parted by blanks; all of it must succeed."""
        names = (tuple(activate.split()), tuple(deactivate.split()))
        result = self.manager.switch_controller(SwitchRequest(*names, Strictness.STRICT))
        assert result.ok, result.message

    def tick(self, count: int = 1, period_s: float = PERIOD_S) -> None:
        """Run cycles in the order of a simulation."""
        for _ in range(count):
            self.manager.update(self.time_s, period_s)
            self.manager.write(self.time_s, period_s)
            self.move(period_s)
            self.time_s += period_s
            self.manager.read(self.time_s, period_s)
            self.manager.publish(self.time_s, period_s)

    def move(self, period_s: float) -> None:
        """Move the hardware; by itself it shows its commands as states."""
