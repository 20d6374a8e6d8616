"""Fakes for testing controllers and programs built on the controller manager."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.info import HardwareInfo, InterfaceInfo, JointInfo


class ManualClock:
    """A clock that moves only when it is told to."""

    def __init__(self, now_s: float = 0.0) -> None:
        self._now_s = now_s

    def now_s(self) -> float:
        """Return the current time."""
        return self._now_s

    def advance(self, seconds: float) -> None:
        """Move the clock forward."""
        self._now_s += seconds


class FakeHardware:
    """Hardware whose states follow its commands immediately, and which fails on demand.

    A state interface with the same name as a command interface shows the last command; any other
    keeps its initial value. Tests make it fail by setting the attributes below.

    Attributes:
        read_result: what `read` returns.
        write_result: what `write` returns.
        refused: life-cycle methods that fail, such as 'on_activate'; also
            'prepare_command_mode_switch' and 'perform_command_mode_switch'.
        unmeasured: states that are NaN; a state removed from it returns to its initial value.
        events: names of the life-cycle methods called, in order.
        mode_switches: (start, stop) of each mode switch performed.
    """

    def __init__(self, info: HardwareInfo) -> None:
        self.info = info
        self.state_interfaces = info.state_interface_names
        self.command_interfaces = info.command_interface_names
        self.read_result = HardwareReturn.OK
        self.write_result = HardwareReturn.OK
        self.refused: set[str] = set()
        self.unmeasured: set[str] = set()
        self._hidden: frozenset[str] = frozenset()
        self.events: list[str] = []
        self.mode_switches: list[tuple[tuple[str, ...], tuple[str, ...]]] = []
        self.states = np.empty(0)
        self.commands = np.empty(0)
        self._initial = np.array(
            [
                interface.initial_value or 0.0
                for part in (*info.joints, *info.sensors, *info.gpios)
                for interface in part.state_interfaces
            ]
        )
        mirrored = [name for name in self.state_interfaces if name in self.command_interfaces]
        self._mirrored_states = np.array(
            [self.state_interfaces.index(name) for name in mirrored], dtype=np.intp
        )
        self._mirrored_commands = np.array(
            [self.command_interfaces.index(name) for name in mirrored], dtype=np.intp
        )

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Store the views."""
        self.states = states
        self.commands = commands

    def on_configure(self) -> bool:
        """Set every state to its initial value."""
        self.states[:] = self._initial
        return self._record("on_configure")

    def on_activate(self) -> bool:
        """Record the call."""
        return self._record("on_activate")

    def on_deactivate(self) -> bool:
        """Record the call."""
        return self._record("on_deactivate")

    def on_cleanup(self) -> bool:
        """Record the call."""
        return self._record("on_cleanup")

    def on_shutdown(self) -> bool:
        """Record the call."""
        return self._record("on_shutdown")

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Accept, unless told to refuse."""
        return "prepare_command_mode_switch" not in self.refused

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Record the switch, unless told to refuse."""
        if "perform_command_mode_switch" in self.refused:
            return False
        self.mode_switches.append((tuple(start), tuple(stop)))
        return True

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Replace the unmeasured states by NaN; return `read_result`."""
        for name in self._hidden | self.unmeasured:
            index = self.state_interfaces.index(name)
            self.states[index] = np.nan if name in self.unmeasured else self._initial[index]
        self._hidden = frozenset(self.unmeasured)
        return self.read_result

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Copy every command that is not NaN to its state; return `write_result`."""
        commands = self.commands[self._mirrored_commands]
        given = ~np.isnan(commands)
        self.states[self._mirrored_states[given]] = commands[given]
        return self.write_result

    def _record(self, event: str) -> bool:
        self.events.append(event)
        return event not in self.refused


def fake_hardware(
    joints: Iterable[str] = ("j0", "j1", "j2", "j3"),
    *,
    name: str = "FakeSystem",
    command_interfaces: Iterable[str] = ("position",),
    state_interfaces: Iterable[str] = ("position", "velocity", "effort"),
    initial_positions: Mapping[str, float] | None = None,
) -> FakeHardware:
    """Make a FakeHardware with the same interfaces on every joint."""
    commands = tuple(InterfaceInfo(interface) for interface in command_interfaces)
    initial = initial_positions or {}
    return FakeHardware(
        HardwareInfo(
            name=name,
            type="system",
            plugin="mock_components/GenericSystem",
            joints=tuple(
                JointInfo(
                    joint,
                    commands,
                    tuple(
                        InterfaceInfo(
                            interface, initial.get(joint) if interface == "position" else None
                        )
                        for interface in state_interfaces
                    ),
                )
                for joint in joints
            ),
        )
    )
