"""The robot's joints in the simulation, as hardware that a controller manager can drive."""

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware import HardwareReturn
from arm_control.hardware_info import HardwareInfo, InterfaceInfo
from arm_gazebo.drives.mode import DriveMode
from arm_gazebo.hardware.instrument import Instrument
from arm_gazebo.hardware.sensor_states import SensorStates
from arm_gazebo.index_slice import as_slice
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.robot.joint import RobotJoint

logger = logging.getLogger(__name__)

MODES = {mode.value: mode for mode in (DriveMode.POSITION, DriveMode.VELOCITY, DriveMode.EFFORT)}
"""Command interfaces, and what a joint does with each; of several claimed the first counts."""
MAX_EFFORT = "max_effort"
"""Command interface that limits what a joint's drive may spend; nothing above 0 lifts the limit."""
STATES = ("position", "velocity", "effort")
UNITS = {
    DriveMode.POSITION: ("rad", "m"),
    DriveMode.VELOCITY: ("rad/s", "m/s"),
    DriveMode.EFFORT: ("N m", "N"),
}


@dataclass(frozen=True, slots=True)
class _CommandInterface:
    """One command interface: where its value is, whom it drives, and within which bounds."""

    name: str
    index: int
    drive: int
    mode: DriveMode
    joint: RobotJoint
    lower: float
    upper: float

    def warning(self, value: float) -> str:
        """Return what to tell the user about a command beyond the bounds."""
        unit = UNITS[self.mode][self.joint.linear]
        bound = self.upper if value > self.upper else self.lower
        return (
            f"joint '{self.joint.name}': {self.mode.value} command {value:.4g} {unit} is beyond "
            f"its limit of {bound:.4g} {unit}, which is used instead"
        )


@dataclass(frozen=True, slots=True)
class _LimitInterface:
    """A command interface that limits a drive: where its value is, and whom it limits."""

    name: str
    index: int
    drive: int


class SimulatedHardware:
    """A component of the robot description, driven by the simulation's servos.

    Implements `arm_control.hardware.Hardware`; every method belongs to the loop thread. Time
    passes in `Simulation.advance`, which the owner calls between `write` and `read`.

    Args:
        simulation: has the joints.
        info: the component. What of it cannot be simulated is left out and logged.
        instruments: the robot's sensors.
    """

    def __init__(
        self, simulation: Simulation, info: HardwareInfo, instruments: Sequence[Instrument] = ()
    ) -> None:
        self.info = info
        self._simulation = simulation
        self._servo = simulation.servo
        joints = simulation.built.joints
        self._states: list[tuple[str, RobotJoint]] = [
            (state.name, joints[part.name])
            for part in info.joints
            for state in part.state_interfaces
            if part.name in joints and state.name in STATES
        ]
        self._interfaces = self._command_interfaces()
        self._limits = self._limit_interfaces(len(self._interfaces))
        self._sensors = SensorStates(info, instruments)
        joint_states = (f"{joint.name}/{state}" for state, joint in self._states)
        self.state_interfaces = (*joint_states, *self._sensors.names)
        self.command_interfaces = tuple(i.name for i in (*self._interfaces, *self._limits))
        self._log_left_out()
        self._claimed: set[str] = set()
        self._active: tuple[_CommandInterface, ...] = ()
        self._limiting: tuple[_LimitInterface, ...] = ()
        self._beyond: set[str] = set()
        # One for each interface: a command that trembles about its limit shall not fill the log.
        self._warnings: dict[str, str] = {}
        self.bind(np.empty(len(self.state_interfaces)), np.empty(len(self._interfaces)))

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Keep these views; see `Hardware.bind`."""
        self._state_values = states
        self._sensor_values = states[len(self._states) :]
        self._commands = commands
        self._taken = b""
        self._find_sources()

    def rebind(self) -> None:
        """Read from the simulation's new model from now on; see `Simulation.swap`."""
        joints = self._simulation.built.joints
        self._states = [(state, joints[joint.name]) for state, joint in self._states]
        self._find_sources()

    def _find_sources(self) -> None:
        """Look up where the states are in MuJoCo's arrays, each a view of the present ones."""
        states, data = self._state_values, self._simulation.data
        sources = {"position": data.qpos, "velocity": data.qvel, "effort": data.qfrc_actuator}
        self._copies = [
            (states[where], source, there)
            for kind, source in sources.items()
            for where, there in [self._places(kind)]
        ]

    def on_configure(self) -> bool:
        """Show states and, on the command interfaces, what the joints do by themselves."""
        self.read(self._simulation.time_s, 0.0)
        for interface in self._interfaces:
            self._commands[interface.index] = self._neutral(interface)
        for limit in self._limits:
            self._commands[limit.index] = math.nan
        return True

    def on_activate(self) -> bool:
        """Be ready: the joints follow what is claimed."""
        return True

    def on_deactivate(self) -> bool:
        """Leave all joints to themselves."""
        return self.perform_command_mode_switch((), tuple(self._claimed))

    def on_cleanup(self) -> bool:
        """Leave all joints to themselves."""
        return self.on_deactivate()

    def on_shutdown(self) -> bool:
        """Leave all joints to themselves."""
        return self.on_deactivate()

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Agree to whatever exists."""
        return set(start) | set(stop) <= set(self.command_interfaces)

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Drive each joint as its claimed interface says, from where it is.

        A started interface gets the value at which nothing jumps. Joints without any are idle.
        """
        before = self._modes()
        self._claimed = (self._claimed - set(stop)) | set(start)
        after = self._modes()
        switched = [i for i in self._interfaces if i.name in start or i.name in stop]
        for interface in switched:
            interface_before, interface_after = before[interface.drive], after[interface.drive]
            if interface_before is not interface_after or interface.name in start:
                self._servo.set_mode(interface.drive, interface_after)
        for interface in switched:
            self._beyond.discard(interface.name)
            if interface.name in start:
                self._commands[interface.index] = self._neutral(interface)
        self._active = tuple(
            interface
            for interface in self._interfaces
            if interface.name in self._claimed and interface.mode is after[interface.drive]
        )
        self._switch_limits(start, stop)
        self._taken = b""
        return True

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Fill the states from the physics."""
        for target, source, there in self._copies:
            target[:] = source[there]
        self._sensors.fill(self._sensor_values)
        return HardwareReturn.OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Take commands that changed; NaN is no command, and what is too much is clamped."""
        commands = self._commands.tobytes()
        if commands == self._taken:
            return HardwareReturn.OK
        self._taken = commands
        values = self._commands.tolist()
        for limit in self._limiting:
            self._servo.limit_effort(limit.drive, values[limit.index])
        for interface in self._active:
            value = values[interface.index]
            if not interface.lower <= value <= interface.upper:
                if value != value:
                    continue
                value = self._clamped(interface, value)
            elif self._beyond:
                self._beyond.discard(interface.name)
            self._servo.command(interface.drive, value)
        return HardwareReturn.OK

    def take_warnings(self) -> list[str]:
        """Return what users should hear about their commands since the last call."""
        warnings, self._warnings = self._warnings, {}
        return list(warnings.values())

    def _switch_limits(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Begin and end without limits."""
        for limit in self._limits:
            if limit.name in start or limit.name in stop:
                self._commands[limit.index] = math.nan
                self._servo.limit_effort(limit.drive, math.nan)
        self._limiting = tuple(limit for limit in self._limits if limit.name in self._claimed)

    def _clamped(self, interface: _CommandInterface, value: float) -> float:
        if interface.name not in self._beyond:
            self._beyond.add(interface.name)
            self._warnings[interface.name] = interface.warning(value)
        return min(max(value, interface.lower), interface.upper)

    def _neutral(self, interface: _CommandInterface) -> float:
        if interface.mode is DriveMode.POSITION:
            return self._servo.stopping_point(interface.drive)
        return 0.0

    def _modes(self) -> dict[int, DriveMode]:
        """Return how each drive of this component is to be driven, as claimed now."""
        modes = dict.fromkeys((i.drive for i in self._interfaces), self._simulation.idle_mode)
        for mode in reversed(MODES.values()):
            for interface in self._interfaces:
                if interface.mode is mode and interface.name in self._claimed:
                    modes[interface.drive] = mode
        return modes

    def _places(self, kind: str) -> tuple[slice | NDArray[np.intp], slice | NDArray[np.intp]]:
        """Return where states of a kind are in the states, and where in MuJoCo's array."""
        where = [index for index, (state, _) in enumerate(self._states) if state == kind]
        there = [
            joint.qpos_address if kind == "position" else joint.dof_address
            for state, joint in self._states
            if state == kind
        ]
        return as_slice(np.array(where, dtype=np.intp)), as_slice(np.array(there, dtype=np.intp))

    def _command_interfaces(self) -> tuple[_CommandInterface, ...]:
        drives = {joint.name: drive for drive, joint in enumerate(self._servo.joints)}
        found: list[_CommandInterface] = []
        for part in self.info.joints:
            for command in part.command_interfaces:
                if part.name in drives and command.name in MODES:
                    drive = drives[part.name]
                    joint, mode = self._servo.joints[drive], MODES[command.name]
                    name, bounds = f"{part.name}/{command.name}", _bounds(joint, mode, command)
                    found.append(_CommandInterface(name, len(found), drive, mode, joint, *bounds))
        return tuple(found)

    def _limit_interfaces(self, first: int) -> tuple[_LimitInterface, ...]:
        drives = {joint.name: drive for drive, joint in enumerate(self._servo.joints)}
        limited = [
            part.name
            for part in self.info.joints
            for command in part.command_interfaces
            if part.name in drives and command.name == MAX_EFFORT
        ]
        return tuple(
            _LimitInterface(f"{name}/{MAX_EFFORT}", first + place, drives[name])
            for place, name in enumerate(limited)
        )

    def _log_left_out(self) -> None:
        offered = {*self.state_interfaces, *self.command_interfaces}
        asked = (*self.info.state_interface_names, *self.info.command_interface_names)
        left_out = [name for name in dict.fromkeys(asked) if name not in offered]
        if left_out:
            logger.warning(
                "hardware '%s': not simulated and left out: %s",
                self.info.name,
                ", ".join(left_out),
            )


def _bounds(joint: RobotJoint, mode: DriveMode, command: InterfaceInfo) -> tuple[float, float]:
    """Return the lowest and highest command: the joint's limits, narrowed by the interface's."""
    lower, upper = {
        DriveMode.POSITION: (joint.lower, joint.upper),
        DriveMode.VELOCITY: (-joint.velocity_limit, joint.velocity_limit),
        DriveMode.EFFORT: (-joint.effort, joint.effort),
    }[mode]
    lowest = -math.inf if command.minimum is None else command.minimum
    highest = math.inf if command.maximum is None else command.maximum
    return max(lower, lowest), min(upper, highest)
