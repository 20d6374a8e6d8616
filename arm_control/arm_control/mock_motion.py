"""How the joints of mock hardware move: by mirroring, by integration, by following others."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware_info import HardwareInfo, JointInfo, MimicInfo

MOTIONS = ("position", "velocity", "acceleration")

Array = NDArray[np.float64]

_POSITION, _VELOCITY, _ACCELERATION = range(len(MOTIONS))


class MockMotion:
    """Position, velocity and acceleration of all joints of a component. Loop thread only.

    Without integration each quantity that is commanded shows as it is. With integration the one
    quantity that a joint is commanded by gives the other two: by differences upwards, by
    integration downwards (explicit Euler: a velocity moves the position from the next cycle on).
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
        """Lay the arrays out.

        Args:
            info: of the component.
            state_names: full names, in the order of the states array.
            command_names: full names, in the order of the commands array.
            offset: added to commanded positions.
            integrates: whether the quantities of a joint hang together.

        Raises:
            HardwareInfoError: a mimic joint has no leader in this component, or is commanded.
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
        """Begin from these states, at rest where they say nothing."""
        self._values[:] = 0.0
        self._values[self._shown] = states[self._state_at]
        self._follow()
        states[self._state_at] = self._values[self._shown]

    def check_modes(self, start: Sequence[str]) -> None:
        """Check that each joint among these command interfaces moves by one of its quantities.

        Raises:
            HardwareInfoError: it would move by none or by several; the message names the joint.
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
        """Move each joint by its quantity among these command interfaces."""
        for name in start:
            joint, _, interface = name.rpartition("/")
            if joint in self._row and interface in MOTIONS:
                self._mode[self._row[joint]] = MOTIONS.index(interface)

    def advance(self, commands: Array, states: Array, period_s: float) -> None:
        """Take the commands, move on by a period, and show where the joints are."""
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
    """Return where (quantity, joint) stand that have an interface, and the interface's index."""
    index: Mapping[str, int] = {name: i for i, name in enumerate(names)}
    found = [
        (motion, joint, index[name])
        for motion, word in enumerate(MOTIONS)
        for joint, info in enumerate(joints)
        if (name := f"{info.name}/{word}") in index
    ]
    columns = np.array(found, dtype=np.intp).reshape(-1, 3).T
    return (columns[0], columns[1]), columns[2]


def _mimics(info: HardwareInfo) -> list[tuple[int, int, MimicInfo]]:
    """Return follower, leader and rule of each mimic joint, leaders of leaders first.

    Raises:
        HardwareInfoError: see `MockMotion`.
    """
    row = {joint.name: i for i, joint in enumerate(info.joints)}
    waiting = [(joint, joint.mimic) for joint in info.joints if joint.mimic is not None]
    for joint, mimic in waiting:
        where = f"hardware component '{info.name}': joint '{joint.name}' mimics '{mimic.leader}'"
        if mimic.leader not in row:
            raise HardwareInfoError(
                f"{where}, which is no joint of it; it has {', '.join(row) or 'none'}"
            )
        if joint.command_interfaces:
            raise HardwareInfoError(
                f"{where}, so it takes no commands itself; remove its command interfaces, or say "
                'mimic="false" in its <joint>'
            )
    ordered: list[tuple[int, int, MimicInfo]] = []
    while waiting:
        following = {joint.name for joint, _ in waiting}
        ready = [(j, mimic) for j, mimic in waiting if mimic.leader not in following]
        if not ready:
            raise HardwareInfoError(
                f"hardware component '{info.name}': joints mimic each other in a circle: "
                f"{', '.join(sorted(following))}"
            )
        ordered += [(row[joint.name], row[mimic.leader], mimic) for joint, mimic in ready]
        waiting = [pair for pair in waiting if pair not in ready]
    return ordered
