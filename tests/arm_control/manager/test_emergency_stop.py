"""The latched emergency stop: what is called, what is commanded, and what is refused meanwhile."""

import numpy as np
import pytest

from arm_control import ControllerManager, SwitchRequest
from arm_control.errors import StateError
from arm_control.lifecycle import LifecycleState
from arm_control.testing import FakeHardware, fake_hardware

POSITIONS = ("j0/position", "j1/position")


def test_controllers_with_commands_rest_and_others_go_on(bench):
    mover = bench.configure("mover", commands=POSITIONS)
    watcher = bench.configure("watcher", states=POSITIONS)
    bench.switch("mover watcher")
    bench.events.clear()
    assert bench.manager.set_emergency_stop(True)
    bench.tick(3)
    assert bench.events == ["mover deactivate", *["watcher update"] * 3]
    assert mover.halted_by == "emergency stop"
    assert watcher.halted_by == ""
    assert bench.states() == {"mover": "active", "watcher": "active"}
    bench.events.clear()
    assert bench.manager.set_emergency_stop(False)
    bench.tick()
    assert bench.events == ["mover activate", "mover update", "watcher update"]
    assert mover.halted_by == ""


def test_the_stop_is_latched(bench):
    assert not bench.manager.set_emergency_stop(False)
    assert bench.manager.set_emergency_stop(True)
    assert not bench.manager.set_emergency_stop(True)
    assert bench.manager.emergency_stopped
    assert bench.manager.set_emergency_stop(False)
    assert not bench.manager.emergency_stopped


def test_no_controller_is_activated_meanwhile(bench, caplog):
    bench.configure("mover", commands=POSITIONS)
    bench.manager.set_emergency_stop(True)
    result = bench.manager.switch_controller(SwitchRequest(activate=("mover",)))
    assert not result.ok
    assert result.message.startswith("the emergency stop is latched: release it first")
    # `arm control set_controller_state` and the spawner refer to the log for the reason.
    assert result.message in caplog.text
    bench.manager.set_emergency_stop(False)
    bench.switch("mover")


def test_a_halted_controller_is_deactivated_without_a_second_call(bench):
    mover = bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    bench.manager.set_emergency_stop(True)
    bench.events.clear()
    bench.switch("", "mover")
    assert bench.events == []
    assert mover.halted_by == ""
    bench.manager.set_emergency_stop(False)
    bench.tick()
    assert bench.events == []
    assert bench.states() == {"mover": "inactive"}


def test_a_controller_that_cannot_go_on_is_deactivated(bench):
    mover = bench.configure("mover", commands=POSITIONS)
    bench.configure("other", commands=("j2/position",))
    bench.switch("mover other")
    bench.manager.set_emergency_stop(True)
    mover.refuses.add("activate")
    bench.manager.set_emergency_stop(False)
    assert bench.states() == {"mover": "inactive", "other": "active"}
    bench.tick()
    assert bench.events[-1] == "other update"


def test_the_manager_shuts_down_while_it_is_stopped(bench):
    bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    bench.manager.set_emergency_stop(True)
    bench.manager.shutdown()
    assert bench.events.count("mover deactivate") == 1
    assert bench.events[-1] == "mover shutdown"


def test_observers_are_told(bench, observer):
    changes = observer.changes
    bench.manager.set_emergency_stop(True)
    bench.manager.set_emergency_stop(False)
    assert observer.changes == changes + 2


class Lagging(FakeHardware):
    """Hardware whose joints are half-way to their commands."""

    def write(self, time_s: float, period_s: float):
        outcome = super().write(time_s, period_s)
        self.states *= 0.5
        return outcome


@pytest.fixture
def lagging() -> tuple[ControllerManager, Lagging]:
    plain = fake_hardware(("j0",), command_interfaces=("position", "velocity", "max_effort"))
    hardware = Lagging(plain.info)
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    return manager, hardware


def test_hardware_that_cannot_stop_by_itself_gets_commands_that_hold(lagging):
    manager, hardware = lagging
    hardware.commands[:] = 1.0, 2.0, 5.0
    manager.write(0.0, 0.01)
    manager.set_emergency_stop(True)
    hardware.commands[:] = 9.0
    manager.update(0.0, 0.01)
    # Where the joint was, at rest, as strong as before.
    assert hardware.commands.tolist() == [0.5, 0.0, 5.0]


class Stoppable(FakeHardware):
    """Hardware that can stop by itself, or fails to."""

    stops: list[bool]
    fails = False

    def set_emergency_stop(self, engaged: bool) -> None:
        self.stops.append(engaged)
        if self.fails:
            raise OSError("no line to the drives")


@pytest.mark.parametrize("fails", [False, True])
def test_hardware_that_can_is_told_to_stop(fails, caplog):
    hardware = Stoppable(fake_hardware().info)
    hardware.stops, hardware.fails = [], fails
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    manager.set_emergency_stop(True)
    assert np.isnan(hardware.commands).all()
    manager.set_emergency_stop(False)
    assert hardware.stops == [True, False]
    assert ("no line to the drives" in caplog.text) == fails
    components = manager.list_hardware_components()
    assert [component.state for component in components] == [LifecycleState.ACTIVE]


def test_a_reset_leaves_what_is_halted_alone(bench):
    bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    bench.manager.set_emergency_stop(True)
    bench.events.clear()
    bench.manager.state.reset()
    assert bench.events == []


def test_no_state_is_saved_or_restored_meanwhile(bench):
    bench.manager.set_emergency_stop(True)
    with pytest.raises(StateError, match="the emergency stop is latched"):
        bench.manager.state.save()
    with pytest.raises(StateError, match="the emergency stop is latched"):
        bench.manager.state.check({})
