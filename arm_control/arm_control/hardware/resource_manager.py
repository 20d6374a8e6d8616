"""Holds the hardware components, their interfaces, and the controllers' claims on them."""

from collections.abc import Iterable, Sequence

import numpy as np

from arm_control.controllers.exported_interfaces import ExportedInterfaces, Place
from arm_control.controllers.loaned_interfaces import LoanedInterfaces, loan
from arm_control.errors import ControllerManagerError
from arm_control.hardware.component import HardwareComponent
from arm_control.hardware.driver import Hardware, HardwareReturn, SingleModeHardware
from arm_control.lifecycle import LifecycleState
from arm_control.loop.supervision import RunRecord, RunSupervision, failure_of
from arm_control.status import HardwareComponentStatus, InterfaceStatus

HardwareFault = tuple[HardwareComponent, HardwareReturn]
"""A component whose read or write was not OK."""

# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_OK = HardwareReturn.OK
STAYS = ("position",)
"""Command interfaces for which the command that stops a joint is its own state, not 0."""
STOPS = ("velocity", "acceleration", "effort")


class ResourceManager:
    """All states and all commands of all components, each in one contiguous array.

    Loop thread only.

    Attributes:
        states: shape (number of state interfaces,); NaN until read.
        commands: shape (number of command interfaces,); NaN until commanded.
        components: by name, in the order given.
        exported: the interfaces of chainable controllers, which are commands and states as well.
    """

    def __init__(
        self,
        hardware: Sequence[Hardware],
        cycle_rate_hz: int,
        supervision: RunSupervision | None = None,
        *,
        command_inactive: bool = False,
    ) -> None:
        """Allocate the arrays and bind each component to its part.

        `supervision` measures their reads and writes and handles exceptions; `command_inactive`
        lets inactive components be commanded as well.

        Raises:
            ControllerManagerError: two components, or two interfaces, have the same name.
        """
        self.components: dict[str, HardwareComponent] = {}
        self._state_owner: dict[str, HardwareComponent] = {}
        self._command_owner: dict[str, HardwareComponent] = {}
        for driver in hardware:
            self._add(HardwareComponent(driver, cycle_rate_hz, supervision))
        self.states = np.full(len(self._state_owner), np.nan)
        self.commands = np.full(len(self._command_owner), np.nan)
        self._read_only_states = self.states.view()
        self._read_only_states.setflags(write=False)
        self._state_index = {name: i for i, name in enumerate(self._state_owner)}
        self._command_index = {name: i for i, name in enumerate(self._command_owner)}
        self.exported = ExportedInterfaces()
        self._data_types = {
            name: data_type
            for component in self.components.values()
            for name, data_type in component.hardware.info.data_types.items()
        }
        self._claims: dict[str, str] = {}
        self._commandable = {LifecycleState.ACTIVE}
        if command_inactive:
            self._commandable.add(LifecycleState.INACTIVE)
        self._reading: tuple[HardwareComponent, ...] = ()
        self._writing: tuple[HardwareComponent, ...] = ()
        self._bind()

    @property
    def state_names(self) -> tuple[str, ...]:
        """Full names of `states`."""
        return tuple(self._state_owner)

    @property
    def command_names(self) -> tuple[str, ...]:
        """Full names of `commands`."""
        return tuple(self._command_owner)

    def available_states(self) -> tuple[str, ...]:
        """Full names of the state interfaces of configured components and active controllers."""
        return (
            *(name for name, owner in self._state_owner.items() if owner.is_available),
            *filter(self.exported.is_state_available, self.exported.states()),
        )

    def available_commands(self) -> tuple[str, ...]:
        """Full names of configured components' command interfaces and of references in use."""
        return (
            *(name for name, owner in self._command_owner.items() if owner.is_available),
            *filter(self.exported.is_reference_available, self.exported.references()),
        )

    def is_state_available(self, name: str) -> bool:
        """Whether the state interface exists and its owner provides it."""
        owner = self._state_owner.get(name)
        if owner is None:
            return self.exported.is_state_available(name)
        return owner.is_available

    def is_command_available(self, name: str) -> bool:
        """Whether the command interface exists and its owner accepts commands."""
        owner = self._command_owner.get(name)
        if owner is None:
            return self.exported.is_reference_available(name)
        return owner.is_available

    def claimant(self, command: str) -> str | None:
        """Name of the controller that has claimed a command interface, or None."""
        return self._claims.get(command)

    def claim(self, controller: str, commands: Iterable[str]) -> None:
        """Claim command interfaces for a controller; the switch has checked that they are free."""
        self._claims.update(dict.fromkeys(commands, controller))

    def release(self, controller: str) -> None:
        """Release all command interfaces of a controller."""
        self._claims = {name: c for name, c in self._claims.items() if c != controller}

    def loan_commands(self, names: Sequence[str]) -> LoanedInterfaces:
        """Loan these commands."""
        return loan(names, [self._command_place(name) for name in names])

    def loan_states(self, names: Sequence[str]) -> LoanedInterfaces:
        """Loan these states, read-only."""
        places = [self._state_place(name) for name in names]
        return loan(names, places, [self._data_type_of(name) for name in names])

    def components_of(self, states: Iterable[str], commands: Iterable[str]) -> frozenset[str]:
        """Names of the components that these interfaces belong to."""
        owners = [self._state_owner.get(name) for name in states]
        owners += [self._command_owner.get(name) for name in commands]
        return frozenset(owner.name for owner in owners if owner is not None)

    def moded_joint(self, command: str) -> str | None:
        """Return the joint of a command interface of which it obeys one at a time, or None."""
        owner = self._command_owner.get(command)
        joint, _, kind = command.rpartition("/")
        if owner is None or not isinstance(owner.hardware, SingleModeHardware):
            return None
        return joint if kind in owner.hardware.modes else None

    def prepare_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> str:
        """Ask each affected component; return why one refuses, or an empty string."""
        for component, ours, theirs in self._concerned(start, stop):
            if ours and component.state not in self._commandable:
                return f"hardware component '{component.name}' is {component.state.label}"
            if reason := _mode_switch_failure(component, "prepare", ours, theirs):
                return reason
        return ""

    def perform_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> str:
        """Tell each affected component; return why one failed, or an empty string."""
        for component, ours, theirs in self._concerned(start, stop):
            if reason := _mode_switch_failure(component, "perform", ours, theirs):
                return reason
        return ""

    def read(self, time_s: float, period_s: float) -> list[HardwareFault]:
        """Read every configured component that is due; return the faults."""
        faults: list[HardwareFault] = []
        for component in self._reading:
            outcome = component.read(time_s, period_s)
            if outcome is not _OK:
                faults.append((component, outcome))
        return faults

    def write(self, time_s: float, period_s: float) -> list[HardwareFault]:
        """Write every active component that is due; return the faults."""
        faults: list[HardwareFault] = []
        for component in self._writing:
            outcome = component.write(time_s, period_s)
            if outcome is not _OK:
                faults.append((component, outcome))
        return faults

    def unmeasured_states(self) -> tuple[str, ...]:
        """Return the states of active components that are not numbers; any thread."""
        unknown = np.isnan(self.states).tolist()
        return tuple(
            name
            for (name, owner), is_unknown in zip(self._state_owner.items(), unknown, strict=True)
            if is_unknown and owner.state is LifecycleState.ACTIVE
        )

    def groups(self) -> tuple[tuple[str, ...], ...]:
        """Names of the components that start together; most groups have one member."""
        groups: dict[tuple[str, str], list[str]] = {}
        for name, component in self.components.items():
            group = component.hardware.info.group
            groups.setdefault((group, "" if group else name), []).append(name)
        return tuple(map(tuple, groups.values()))

    def set_component_state(self, name: str, target: LifecycleState) -> str:
        """Bring a component to a state; return why that failed, or an empty string.

        A component that is activated finds commands that hold its joints where they are now,
        whatever was commanded before. One that is cleaned up has no commands any more.
        """
        component = self.components[name]
        if target is LifecycleState.ACTIVE and component.state is LifecycleState.INACTIVE:
            self.hold(component.hardware.command_interfaces)
        reason = component.go_to(target)
        self._settle(component)
        return reason

    def take_down(self, component: HardwareComponent) -> None:
        """Take a failed component out of use."""
        component.fail()
        self._settle(component)

    def hold(self, names: Iterable[str]) -> None:
        """Command these interfaces to hold their joints; those without a command stay so."""
        held = self.holding_commands()
        for name in names:
            index = self._command_index.get(name)
            if index is not None and np.isfinite(self.commands[index]):
                self.commands[index] = held[index]

    def holding_commands(self) -> np.ndarray:
        """Return the commands that hold each joint where it is, shape (n,)."""
        states = dict(zip(self.state_names, self.states.tolist(), strict=True))
        held = self.commands.copy()
        for index, name in enumerate(self.command_names):
            kind = name.rpartition("/")[2]
            if kind in STOPS:
                held[index] = 0.0
            elif kind in STAYS and np.isfinite(states.get(name, np.nan)):
                held[index] = states[name]
        return held

    def list_interfaces(self) -> tuple[tuple[InterfaceStatus, ...], tuple[InterfaceStatus, ...]]:
        """Return the command and the state interfaces, each sorted by name."""
        exported = self.exported
        return (
            tuple(
                map(self._command_status, sorted((*self._command_owner, *exported.references())))
            ),
            tuple(map(self._state_status, sorted((*self._state_owner, *exported.states())))),
        )

    def list_components(self) -> tuple[HardwareComponentStatus, ...]:
        """Return every component."""
        return tuple(
            HardwareComponentStatus(
                name=component.name,
                type=component.hardware.info.type,
                plugin=component.hardware.info.plugin,
                state=component.state,
                read_write_rate_hz=component.rate_hz,
                is_async=component.hardware.info.is_async,
                command_interfaces=tuple(
                    map(self._command_status, component.hardware.command_interfaces)
                ),
                state_interfaces=tuple(
                    map(self._state_status, component.hardware.state_interfaces)
                ),
            )
            for component in self.components.values()
        )

    def component_runs(self) -> tuple[tuple[HardwareComponentStatus, RunRecord, RunRecord], ...]:
        """Return every component with the records of its reads and its writes."""
        return tuple(
            (status, component.reads, component.writes)
            for status, component in zip(
                self.list_components(), self.components.values(), strict=True
            )
        )

    def _command_status(self, name: str) -> InterfaceStatus:
        is_claimed = name in self._claims
        return InterfaceStatus(
            name, self.is_command_available(name), is_claimed, self._data_type_of(name)
        )

    def _state_status(self, name: str) -> InterfaceStatus:
        return InterfaceStatus(name, self.is_state_available(name), False, self._data_type_of(name))

    def _data_type_of(self, name: str) -> str:
        return self._data_types.get(name, "double")

    def _command_place(self, name: str) -> Place:
        index = self._command_index.get(name)
        return self.exported.reference_place(name) if index is None else (self.commands, index)

    def _state_place(self, name: str) -> Place:
        index = self._state_index.get(name)
        if index is None:
            return self.exported.state_place(name)
        return self._read_only_states, index

    def _concerned(
        self, start: Sequence[str], stop: Sequence[str]
    ) -> list[tuple[HardwareComponent, tuple[str, ...], tuple[str, ...]]]:
        """Split a switch by component; each gets only its own interfaces."""
        split = [
            (
                component,
                tuple(name for name in start if self._command_owner.get(name) is component),
                tuple(name for name in stop if self._command_owner.get(name) is component),
            )
            for component in self.components.values()
        ]
        return [part for part in split if part[1] or part[2]]

    def _add(self, component: HardwareComponent) -> None:
        if component.name in self.components:
            raise ControllerManagerError(f"two hardware components are named '{component.name}'")
        self.components[component.name] = component
        for names, owners, kind in (
            (component.hardware.state_interfaces, self._state_owner, "state"),
            (component.hardware.command_interfaces, self._command_owner, "command"),
        ):
            for name in names:
                if name in owners:
                    raise ControllerManagerError(
                        f"{kind} interface '{name}' already belongs to hardware component "
                        f"'{owners[name].name}'; '{component.name}' also has it"
                    )
                owners[name] = component

    def _bind(self) -> None:
        first_state = first_command = 0
        for component in self.components.values():
            hardware = component.hardware
            end_state = first_state + len(hardware.state_interfaces)
            end_command = first_command + len(hardware.command_interfaces)
            hardware.bind(
                self.states[first_state:end_state], self.commands[first_command:end_command]
            )
            first_state, first_command = end_state, end_command

    def _settle(self, component: HardwareComponent) -> None:
        """Note what a transition of a component means for all of them."""
        if not component.is_available:
            for name in component.hardware.command_interfaces:
                self.commands[self._command_index[name]] = np.nan
        self._select_components()

    def _select_components(self) -> None:
        every = tuple(self.components.values())
        self._reading = tuple(c for c in every if c.is_available)
        self._writing = tuple(c for c in every if c.state is LifecycleState.ACTIVE)


def _mode_switch_failure(
    component: HardwareComponent, step: str, start: Sequence[str], stop: Sequence[str]
) -> str:
    """Let a driver "prepare" or "perform" a switch; return why it failed, or an empty string."""
    method = f"{step}_command_mode_switch"
    return failure_of(
        lambda: getattr(component.hardware, method)(start, stop),
        f"{method} of hardware component '{component.name}'",
    )
