"""Begins and ends faults in a running simulation."""

import time
from collections.abc import Callable, Sequence
from typing import Any

from arm_control.lifecycle import LifecycleState
from arm_gazebo.errors import FaultError
from arm_gazebo.faults.fault import Fault, FaultKind
from arm_gazebo.physics.faults import Distortion
from arm_gazebo.run.run import SimulationRun
from arm_node.names import listing

DISTORTIONS = {
    FaultKind.SENSOR_FROZEN: Distortion.FROZEN,
    FaultKind.SENSOR_NOISY: Distortion.NOISY,
    FaultKind.SENSOR_NAN: Distortion.NAN,
}
REASON = "a fault was requested"


class FaultInjector:
    """Begins and ends faults. Loop thread only, between two ticks.

    A fault changes the run through its inputs, so a recording of the run contains the fault.

    Attributes:
        active: the faults that have begun and not ended.
    """

    def __init__(self, run: SimulationRun) -> None:
        self.active: list[Fault] = []
        self._run = run
        self._feeds: dict[Fault, _EachTick] = {}

    def check(self, fault: Fault) -> None:
        """Raise FaultError if the simulation does not have the fault's target."""
        kind, target = fault.kind, fault.target
        if kind is FaultKind.JOINT_STALLED:
            _find("joint", target, list(self._run.physics.built.joints))
        elif kind in DISTORTIONS:
            channels = [name for m in self._run.managers for name in m.resources.state_names]
            channels += [name for sensor in self._run.sensors for name in sensor.channels]
            owners = dict.fromkeys(name.rpartition("/")[0] for name in channels)
            _find("joint, sensor or channel", target, [*owners, *dict.fromkeys(channels)])
        elif kind is FaultKind.CONTROLLER_RAISES:
            _find(
                "controller", target, [name for m in self._run.managers for name in m.controllers]
            )

    def begin(self, fault: Fault) -> None:
        """Begin a fault.

        Raises:
            FaultError: it has already begun, or the simulation does not have its target.
        """
        if fault in self.active:
            raise FaultError(f"the fault '{fault}' has already begun")
        self.check(fault)
        if fault.kind is FaultKind.JOINT_STALLED:
            self._run.physics.stall_joint(fault.target)
        elif fault.kind in DISTORTIONS:
            distortion = DISTORTIONS[fault.kind].value
            self._run.physics.distort(fault.target, distortion, fault.amount, fault.seed)
        elif fault.kind is FaultKind.CONTROLLER_RAISES:
            self._fail(fault.target)
            self._do_each_tick(fault, lambda: self._fail(fault.target))
        else:
            self._do_each_tick(fault, lambda: time.sleep(fault.amount))
        self.active.append(fault)

    def end(self, fault: Fault) -> None:
        """End a fault that has begun. A controller that failed stays inactive."""
        self.active.remove(fault)
        if fault.kind is FaultKind.JOINT_STALLED:
            self._run.physics.free_joint(fault.target)
        elif fault.kind in DISTORTIONS:
            self._run.physics.read_rightly(fault.target, DISTORTIONS[fault.kind].value)
        else:
            self._run.tick.remove_feed(self._feeds.pop(fault))

    def _do_each_tick(self, fault: Fault, act: Callable[[], None]) -> None:
        self._feeds[fault] = feed = _EachTick(act)
        self._run.tick.add_feed(feed)

    def _fail(self, name: str) -> None:
        """Make an active controller fail; it may have been activated again."""
        for manager in self._run.managers:
            managed = manager.controllers.get(name)
            if managed is not None and managed.state is LifecycleState.ACTIVE:
                manager.fail_controller(name, REASON)


class _EachTick:
    """Does something after each tick."""

    def __init__(self, act: Callable[[], None]) -> None:
        self._act = act

    def publish_due(self, time_s: float, data: Any) -> None:
        self._act()


def _find(what: str, name: str, existing: Sequence[str]) -> None:
    if name not in existing:
        raise FaultError(f"no {what} '{name}'; there are {listing(existing)}")
