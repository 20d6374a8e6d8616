"""Moves the joints of mock hardware: by mirroring commands, by integration, or as mimics."""

from collections.abc import Mapping, Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo, JointInfo
from arm_description.errors import MimicCycleError
from arm_description.urdf.mimic import Mimic, resolve_leader

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

        Args:
            info: the component's description.
            state_names: full names, in the order of the states array.
            command_names: full names, in the order of the commands array.
            offset: added to commanded positions.
            integrates: whether position, velocity and acceleration of a joint are kept consistent.

        Raises:
            HardwareInfoError: a mimic joint has no leader in this component, or has command
                interfaces.
        """
        self._info = info
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
