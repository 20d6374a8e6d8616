"""mock_components/GenericSystem: a driver without hardware, whose states mirror its commands."""

import logging
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware.driver import HardwareReturn, SystemInterface
from arm_control.hardware.info import HardwareInfo, JointInfo
from arm_control.hardware.mock_motion import MOTIONS, MockMotion

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
