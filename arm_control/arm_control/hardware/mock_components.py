"""mock_components/GenericSystem: a driver without hardware, whose states mirror its commands.

Joints move by mirroring commands, by integration, or as mimics.
"""

import logging
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware.driver import HardwareReturn, SystemInterface
from arm_control.hardware.info import HardwareInfo, JointInfo
from arm_description.errors import MimicCycleError
from arm_description.urdf.robot import Mimic, resolve_leader

MOTIONS = ("position", "velocity", "acceleration")

Array = NDArray[np.float64]

_POSITION, _VELOCITY, _ACCELERATION = range(len(MOTIONS))


class MockMotion:
    """Position, velocity and acceleration of all joints of a component. Loop thread only.

    Without integration, each commanded quantity appears unchanged. With integration, the commanded
    quantity of a joint gives the other two: derivatives by differences, integrals by explicit Euler
    (a velocity moves the position from the next cycle on).
    """

    def __init__(
        self,
        info: HardwareInfo,
        state_names: Sequence[str],
        command_names: Sequence[str],
        offset: float,
        *,
        integrates: bool,
    ) -> None:
        """Allocate the arrays.

        The full names are in the order of the arrays of states and commands. The offset is added to
        commanded positions; `integrates` keeps a joint's position, velocity and acceleration
        consistent.

        Raises:
            HardwareInfoError: a mimic joint has no leader in this component, or has command
                interfaces.
        """
        self._offset = offset
        self._integrates = integrates
        joints = info.joints
        self._row = {joint.name: i for i, joint in enumerate(joints)}
        shape = (len(MOTIONS), len(joints))
        self._values = np.zeros(shape)
        self._mode = np.full(len(joints), _POSITION)
        self._wanted = np.full(shape, np.nan)
        self._commanded, self._command_at = _places(joints, command_names)
        self._shown, self._state_at = _places(joints, state_names)
        self._mimics = _mimics(info)

    def start(self, states: Array) -> None:
        """Start from these states; quantities without a state interface start at 0."""
        self._values[:] = 0.0
        self._values[self._shown] = states[self._state_at]
        self._follow()
        states[self._state_at] = self._values[self._shown]

    def check_modes(self, start: Sequence[str]) -> None:
        """Check that these interfaces command each joint by exactly one quantity.

        Raises:
            HardwareInfoError: a joint is commanded by none or several; the message names it.
        """
        asked: dict[str, list[str]] = {}
        for name in start:
            joint, _, interface = name.rpartition("/")
            if joint in self._row:
                asked.setdefault(joint, []).append(interface)
        for joint, interfaces in asked.items():
            moving = [interface for interface in interfaces if interface in MOTIONS]
            if len(moving) != 1:
                raise HardwareInfoError(
                    f"joint '{joint}' has to be commanded by one of {', '.join(MOTIONS)}, "
                    f"not by {' and '.join(interfaces)}"
                )

    def set_modes(self, start: Sequence[str]) -> None:
        """Set the quantity that commands each joint, from these command interfaces."""
        for name in start:
            joint, _, interface = name.rpartition("/")
            if joint in self._row and interface in MOTIONS:
                self._mode[self._row[joint]] = MOTIONS.index(interface)

    def advance(self, commands: Array, states: Array, period_s: float) -> None:
        """Apply the commands for one period and update the states."""
        self._wanted[self._commanded] = commands[self._command_at]
        wanted = self._wanted
        if self._offset:
            wanted = wanted.copy()
            wanted[_POSITION] += self._offset
        if self._integrates:
            self._integrate(wanted, period_s)
        else:
            self._values = np.where(np.isnan(wanted), self._values, wanted)
        self._follow()
        states[self._state_at] = self._values[self._shown]

    def _integrate(self, wanted: Array, period_s: float) -> None:
        position, velocity, acceleration = self._values
        given = ~np.isnan(wanted)
        by_position = (self._mode == _POSITION) & given[_POSITION]
        by_velocity = (self._mode == _VELOCITY) & given[_VELOCITY]
        by_acceleration = self._mode == _ACCELERATION
        moved = position + np.where(self._mode == _POSITION, 0.0, velocity * period_s)
        moved = np.where(by_position, wanted[_POSITION], moved)
        rate = velocity + np.where(by_acceleration, acceleration * period_s, 0.0)
        rate = np.where(by_velocity, wanted[_VELOCITY], rate)
        if period_s > 0.0:
            rate = np.where(by_position, (moved - position) / period_s, rate)
            differs = by_position | by_velocity
            acceleration = np.where(differs, (rate - velocity) / period_s, acceleration)
        commanded = by_acceleration & given[_ACCELERATION]
        acceleration = np.where(commanded, wanted[_ACCELERATION], acceleration)
        self._values = np.stack((moved, rate, acceleration))

    def _follow(self) -> None:
        for follower, leader, mimic in self._mimics:
            self._values[:, follower] = mimic.multiplier * self._values[:, leader]
            self._values[_POSITION, follower] += mimic.offset


def _places(
    joints: Sequence[JointInfo], names: Sequence[str]
) -> tuple[tuple[NDArray[np.intp], NDArray[np.intp]], NDArray[np.intp]]:
    """Return the (quantity, joint) pairs that have an interface, and the interfaces' indices."""
    index: Mapping[str, int] = {name: i for i, name in enumerate(names)}
    found = [
        (motion, joint, index[name])
        for motion, word in enumerate(MOTIONS)
        for joint, info in enumerate(joints)
        if (name := f"{info.name}/{word}") in index
    ]
    columns = np.array(found, dtype=np.intp).reshape(-1, 3).T
    return (columns[0], columns[1]), columns[2]


def _mimics(info: HardwareInfo) -> list[tuple[int, int, Mimic]]:
    """Return follower, leader and rule of each mimic joint; the leader is the end of its chain.

    Raises:
        HardwareInfoError: see `MockMotion`.
    """
    row = {joint.name: i for i, joint in enumerate(info.joints)}
    followers = [(joint, joint.mimic) for joint in info.joints if joint.mimic is not None]
    for joint, mimic in followers:
        where = f"hardware component '{info.name}': joint '{joint.name}' mimics '{mimic.joint}'"
        if mimic.joint not in row:
            raise HardwareInfoError(
                f"{where}, but has no such joint; it has {', '.join(row) or 'none'}"
            )
        if joint.command_interfaces:
            raise HardwareInfoError(
                f"{where}, so it cannot be commanded; remove its command interfaces, or set "
                'mimic="false" in its <joint>'
            )
    mimics = {joint.name: mimic for joint, mimic in followers}
    resolved: dict[str, Mimic] = {}
    for name in mimics:
        # Not an error yet: the message names all joints of the circle, and those that depend on it.
        with suppress(MimicCycleError):
            resolved[name] = resolve_leader(name, mimics)
    if len(resolved) < len(mimics):
        raise HardwareInfoError(
            f"hardware component '{info.name}': joints mimic each other in a circle: "
            f"{', '.join(sorted(mimics.keys() - resolved))}"
        )
    return [(row[name], row[mimic.joint], mimic) for name, mimic in resolved.items()]


STANDARD_INTERFACES = (*MOTIONS, "effort")
"""Joint interfaces that start at 0; any other is NaN until it gets a value."""

_OLD_NAMES = {
    "mock_sensor_commands": "fake_sensor_commands",
    "mock_gpio_commands": "fake_gpio_commands",
}

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _MockSettings:
    """The `<param>`s of the component's `<hardware>`.

    Attributes:
        calculate_dynamics: the commanded one of position, velocity and acceleration gives the
            other two.
        disable_commands: commands have no effect, as with a broken connection.
        mock_sensor_commands: every sensor state can be commanded.
        mock_gpio_commands: every GPIO state can be commanded.
        position_state_following_offset: added to commanded positions on the way to the states.
        custom_interface_with_following_offset: joint state interface that shows the position with
            the offset; the position itself then has no offset.
    """

    calculate_dynamics: bool = False
    disable_commands: bool = False
    mock_sensor_commands: bool = False
    mock_gpio_commands: bool = False
    position_state_following_offset: float = 0.0
    custom_interface_with_following_offset: str = ""


class GenericSystem(SystemInterface):
    """A system, actuator or sensor whose states follow its commands immediately.

    A command appears in the state of the same name at the next read; NaN is no command. States
    start at their `initial_value`. A mimic joint follows its leader.
    """

    def __init__(self, info: HardwareInfo) -> None:
        """Lay out the interfaces.

        Raises:
            HardwareInfoError: a parameter is invalid, or a mimic joint has no leader in this
                component or has command interfaces.
        """
        super().__init__(info)
        self._settings = _read_settings(info)
        self.command_interfaces = _command_names(info, self._settings)
        self._mirror_from, self._mirror_to = self._pair(self._mirrored())
        self._offset_from, self._offset_to = self._pair(self._offset())
        self._motion = MockMotion(
            info,
            self.state_interfaces,
            self.command_interfaces,
            self._settings.position_state_following_offset if not self._custom else 0.0,
            integrates=self._settings.calculate_dynamics,
        )

    def on_configure(self) -> bool:
        """Set every state to its initial value."""
        self.states[:] = _initial_values(self.info)
        self._motion.start(self.states)
        return True

    def on_activate(self) -> bool:
        """Warn if commands have no effect."""
        if self._settings.disable_commands:
            self.logger.warning("disable_commands is true: the states will not move")
        return True

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Accept; with calculate_dynamics, only one of position, velocity, acceleration per joint.

        Raises:
            HardwareInfoError: a joint would be commanded by none or several of them.
        """
        if self._settings.calculate_dynamics:
            self._motion.check_modes(start)
        return True

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Note which interface commands each joint from now on."""
        self._motion.set_modes(start)
        return True

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Update the states from the commands."""
        if not self._settings.disable_commands:
            commands, states = self.commands, self.states
            _copy_given(commands[self._mirror_from], states, self._mirror_to)
            _copy_given(
                commands[self._offset_from] + self._settings.position_state_following_offset,
                states,
                self._offset_to,
            )
            self._motion.advance(commands, states, period_s)
        return HardwareReturn.OK

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Do nothing: the next read takes the commands."""
        return HardwareReturn.OK

    @property
    def _custom(self) -> str:
        return self._settings.custom_interface_with_following_offset

    def _mirrored(self) -> Iterable[tuple[str, str]]:
        """Yield each command and the state of the same name, except those that MockMotion moves."""
        moving = {f"{joint.name}/{motion}" for joint in self.info.joints for motion in MOTIONS}
        for name in self.command_interfaces:
            if name in self.state_interfaces and name not in moving:
                yield name, name

    def _offset(self) -> Iterable[tuple[str, str]]:
        """Yield the position command and the state of the custom interface of each joint."""
        for joint in self.info.joints if self._custom else ():
            command, state = f"{joint.name}/position", f"{joint.name}/{self._custom}"
            if command in self.command_interfaces and state in self.state_interfaces:
                yield command, state

    def _pair(self, names: Iterable[tuple[str, str]]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        pairs = tuple(names)
        return (
            np.array([self.command_interfaces.index(c) for c, _ in pairs], dtype=np.intp),
            np.array([self.state_interfaces.index(s) for _, s in pairs], dtype=np.intp),
        )


def _copy_given(
    values: NDArray[np.float64], states: NDArray[np.float64], where: NDArray[np.intp]
) -> None:
    given = ~np.isnan(values)
    states[where[given]] = values[given]


def _command_names(info: HardwareInfo, settings: _MockSettings) -> tuple[str, ...]:
    """Return the description's command interfaces and those that set mock sensors and GPIOs."""
    names = dict.fromkeys(info.command_interface_names)
    parts: list[JointInfo] = [
        *(info.sensors if settings.mock_sensor_commands else ()),
        *(info.gpios if settings.mock_gpio_commands else ()),
    ]
    names.update(
        (f"{part.name}/{interface.name}", None)
        for part in parts
        for interface in part.state_interfaces
    )
    return tuple(names)


def _initial_values(info: HardwareInfo) -> list[float]:
    joints = [
        np.nan
        if i.initial_value is None and i.name not in STANDARD_INTERFACES
        else i.initial_value or 0.0
        for joint in info.joints
        for i in joint.state_interfaces
    ]
    others = [
        np.nan if i.initial_value is None else i.initial_value
        for part in (*info.sensors, *info.gpios)
        for i in part.state_interfaces
    ]
    return joints + others


def _read_settings(info: HardwareInfo) -> _MockSettings:
    parameters = dict(info.parameters)
    for name, old_name in _OLD_NAMES.items():
        if old_name in parameters:
            logger.warning(
                "hardware component '%s': '%s' is the old name of '%s'", info.name, old_name, name
            )
            parameters.setdefault(name, parameters[old_name])
    return _MockSettings(
        calculate_dynamics=_read_flag(info, parameters, "calculate_dynamics"),
        disable_commands=_read_flag(info, parameters, "disable_commands"),
        mock_sensor_commands=_read_flag(info, parameters, "mock_sensor_commands"),
        mock_gpio_commands=_read_flag(info, parameters, "mock_gpio_commands"),
        position_state_following_offset=_read_number(
            info, parameters, "position_state_following_offset"
        ),
        custom_interface_with_following_offset=parameters.get(
            "custom_interface_with_following_offset", ""
        ),
    )


def _read_flag(info: HardwareInfo, parameters: dict[str, str], name: str) -> bool:
    text = parameters.get(name, "false").strip().lower()
    if text not in ("true", "false"):
        raise HardwareInfoError(
            f"hardware component '{info.name}': '{name}' is '{text}'; it must be true or false"
        )
    return text == "true"


def _read_number(info: HardwareInfo, parameters: dict[str, str], name: str) -> float:
    text = parameters.get(name) or "0"
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise HardwareInfoError(
            f"hardware component '{info.name}': '{name}' is '{text}'; it must be a finite number"
        )
    return value
