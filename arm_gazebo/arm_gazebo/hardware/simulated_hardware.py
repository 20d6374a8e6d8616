"""The simulated joints as a hardware component for a controller manager."""

import logging
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.info import HardwareInfo, InterfaceInfo
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.hardware.simulated_gpios import SimulatedGpios
from arm_gazebo.hardware.simulated_sensors import SensorStates, SimulatedSensor
from arm_gazebo.physics.physics import Physics
from arm_gazebo.robot.actuation import RobotJoint
from arm_node.frozen import frozen
from arm_node.index_slice import as_slice

logger = logging.getLogger(__name__)

MODES = {mode.value: mode for mode in (DriveMode.POSITION, DriveMode.VELOCITY, DriveMode.EFFORT)}
"""The drive mode of each command interface; of several claimed interfaces the first one counts."""
MAX_EFFORT = "max_effort"
"""Command interface that limits the effort of a joint's drive; 0 or less lifts the limit."""
STATES = ("position", "velocity", "effort")
# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_OK = HardwareReturn.OK
UNITS = {
    DriveMode.POSITION: ("rad", "m"),
    DriveMode.VELOCITY: ("rad/s", "m/s"),
    DriveMode.EFFORT: ("N m", "N"),
}


@frozen
class _CommandInterface:
    """One command interface: the index of its value, its drive and its bounds."""

    name: str
    index: int
    drive: int
    mode: DriveMode
    joint: RobotJoint
    lower: float
    upper: float

    def warning(self, value: float) -> str:
        """Return the warning about a command beyond the bounds."""
        unit = UNITS[self.mode][self.joint.linear]
        bound = self.upper if value > self.upper else self.lower
        return (
            f"joint '{self.joint.name}': {self.mode.value} command {value:.4g} {unit} is beyond "
            f"its limit of {bound:.4g} {unit}, which is used instead"
        )


@frozen
class _LimitInterface:
    """A command interface that limits a drive's effort: the index of its value, and the drive."""

    name: str
    index: int
    drive: int


class SimulatedHardware:
    """A hardware component of the robot description, driven by the simulation's servos.

    Implements `arm_control.Hardware`; call every method on the loop thread. The owner calls
    `Physics.advance` between `write` and `read`. Interfaces of the component that cannot be
    simulated are left out and logged.
    """

    modes = tuple(MODES)

    def __init__(
        self,
        simulation: Physics,
        info: HardwareInfo,
        sensors: Sequence[SimulatedSensor] = (),
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
        self._sensors = SensorStates(info, sensors)
        self._joint_channels = tuple(f"{joint.name}/{state}" for state, joint in self._states)
        self._gpios = SimulatedGpios(info)
        self.state_interfaces = (*self._joint_channels, *self._sensors.names, *self._gpios.states)
        of_joints = tuple(i.name for i in (*self._interfaces, *self._limits))
        self.command_interfaces = (*of_joints, *self._gpios.commands)
        self._log_left_out()
        self._claimed: set[str] = set()
        self._obeys = False
        self._is_stopped = False
        self._active: tuple[_CommandInterface, ...] = ()
        self._limiting: tuple[_LimitInterface, ...] = ()
        self._beyond: set[str] = set()
        # One for each interface: a command that oscillates at its limit must not flood the log.
        self._warnings: dict[str, str] = {}
        self.bind(np.empty(len(self.state_interfaces)), np.empty(len(self.command_interfaces)))

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Store these views; see `Hardware.bind`."""
        self._state_values = states
        first_gpio = len(states) - len(self._gpios.states)
        self._sensor_values = states[len(self._states) : first_gpio]
        self._commands = commands
        self._gpio_values = (
            states[first_gpio:],
            commands[len(commands) - len(self._gpios.commands) :],
        )
        self._taken = b""
        self._find_sources()

    def rebind(self) -> None:
        """Read from the simulation's new model from now on; see `Physics.swap`."""
        joints = self._simulation.built.joints
        self._states = [(state, joints[joint.name]) for state, joint in self._states]
        self._find_sources()

    def _find_sources(self) -> None:
        """Look up the indices of the states in MuJoCo's arrays and in our state array.

        Store indices, not parts of arrays: a part is a view only if the index is a slice. Otherwise
        it is a copy, and writes to it are lost.
        """
        data = self._simulation.data
        sources = {"position": data.qpos, "velocity": data.qvel, "effort": data.qfrc_actuator}
        self._copies = [
            (where, source, there)
            for kind, source in sources.items()
            for where, there in [self._places(kind)]
        ]

    def on_configure(self) -> bool:
        """Fill the states, and set each command to the value at which its joint stays put."""
        self.read(self._simulation.time_s, 0.0)
        for interface in self._interfaces:
            self._commands[interface.index] = self._neutral(interface)
        for limit in self._limits:
            self._commands[limit.index] = math.nan
        self._gpios.start(*self._gpio_values)
        return True

    def on_activate(self) -> bool:
        """Drive each joint in the mode of its claimed interface, from its present state."""
        self._obeys = True
        self._change_modes()
        return True

    def on_deactivate(self) -> bool:
        """Leave the joints idle; what is claimed stays claimed, and counts again once active."""
        self._obeys = False
        self._change_modes()
        return True

    def on_cleanup(self) -> bool:
        """Release all command interfaces."""
        self.perform_command_mode_switch((), tuple(self._claimed))
        return self.on_deactivate()

    def on_shutdown(self) -> bool:
        """Release all command interfaces."""
        return self.on_cleanup()

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Accept every switch between existing interfaces."""
        return set(start) | set(stop) <= set(self.command_interfaces)

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Drive each joint in the mode of its claimed interface, from its present state.

        A started interface gets a value that causes no jump. Joints without a claimed interface
        are idle, and so are all while the component is not active.
        """
        before = self._modes()
        self._claimed = (self._claimed - set(stop)) | set(start)
        after = self._find_active()
        switched = [i for i in self._interfaces if i.name in start or i.name in stop]
        for interface in switched:
            interface_before, interface_after = before[interface.drive], after[interface.drive]
            if interface_before is not interface_after or interface.name in start:
                self._servo.set_mode(interface.drive, interface_after)
        for interface in switched:
            self._beyond.discard(interface.name)
            if interface.name in start:
                self._commands[interface.index] = self._neutral(interface)
        self._lift_limits(start, stop)
        self._taken = b""
        return True

    def set_emergency_stop(self, engaged: bool) -> None:
        """Let every drive brake and hold; or drive each joint in its claimed mode again.

        A drive brakes as hard as it can in any pose. Limits of efforts stay.
        """
        self._is_stopped = engaged
        self._change_modes()

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Fill the states from the physics."""
        states = self._state_values
        for where, source, there in self._copies:
            states[where] = source[there]
        simulation = self._simulation
        simulation.faults.apply(self._joint_channels, states, simulation.probe.number)
        self._sensors.fill(self._sensor_values)
        return _OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Take changed commands: NaN is ignored, and values beyond the limits are clamped."""
        if self._is_stopped:
            return _OK
        commands = self._commands.tobytes()
        if commands == self._taken:
            return _OK
        self._taken = commands
        values = self._commands.tolist()
        if self._gpios.commands:
            self._gpios.follow(*self._gpio_values)
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
        return _OK

    def reset(self) -> None:
        """Set each claimed command to the value at which its joint stays put, and read the states.

        Call it after `Physics.reset`.
        """
        for interface in self._active:
            self._commands[interface.index] = self._neutral(interface)
        self._taken = b""
        self._beyond.clear()
        self._gpios.start(*self._gpio_values)
        self.read(self._simulation.time_s, 0.0)

    def save_state(self) -> tuple[frozenset[str], frozenset[str], bytes]:
        """Return the claimed commands, those beyond their limits, and the last ones written."""
        return frozenset(self._claimed), frozenset(self._beyond), self._taken

    def load_state(self, state: tuple[frozenset[str], frozenset[str], bytes]) -> None:
        """Continue from a saved state, after the simulation was restored."""
        claimed, beyond, self._taken = state
        self._claimed, self._beyond = set(claimed), set(beyond)
        self._find_active()

    def command_bounds(self) -> dict[int, tuple[float, float]]:
        """Return the lowest and highest command of each commanded drive, by its index."""
        return {each.drive: (each.lower, each.upper) for each in self._active}

    def take_warnings(self) -> list[str]:
        """Return the warnings about commands since the last call."""
        warnings, self._warnings = self._warnings, {}
        return list(warnings.values())

    def _change_modes(self) -> None:
        """Drive each joint in its mode, and set its command to where it stays put."""
        for drive, mode in self._find_active().items():
            if mode is not self._servo.mode(drive):
                self._servo.set_mode(drive, mode)
        for interface in self._active:
            self._commands[interface.index] = self._neutral(interface)
        self._beyond.clear()
        self._taken = b""

    def _find_active(self) -> dict[int, DriveMode]:
        """Find the claimed interfaces that count; return the mode of each drive."""
        modes = self._modes()
        self._active = tuple(
            interface
            for interface in self._interfaces
            if interface.name in self._claimed and interface.mode is modes[interface.drive]
        )
        self._limiting = tuple(limit for limit in self._limits if limit.name in self._claimed)
        return modes

    def _lift_limits(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Lift the limits of interfaces that are started or stopped."""
        for limit in self._limits:
            if limit.name in start or limit.name in stop:
                self._commands[limit.index] = math.nan
                self._servo.limit_effort(limit.drive, math.nan)

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
        """Return the mode of each drive of this component according to the claimed interfaces."""
        if self._is_stopped:
            return dict.fromkeys((i.drive for i in self._interfaces), DriveMode.HOLD)
        modes = dict.fromkeys((i.drive for i in self._interfaces), self._simulation.idle_mode)
        if not self._obeys:
            return modes
        for mode in reversed(MODES.values()):
            for interface in self._interfaces:
                if interface.mode is mode and interface.name in self._claimed:
                    modes[interface.drive] = mode
        return modes

    def _places(self, kind: str) -> tuple[slice | NDArray[np.intp], slice | NDArray[np.intp]]:
        """Return the indices of one kind of state in the state array and in MuJoCo's array."""
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
                "hardware '%s': these interfaces are not simulated and are left out: %s",
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
