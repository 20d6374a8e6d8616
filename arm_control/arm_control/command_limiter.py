"""Keeps commands within the limits of the joints, all joints at once."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from arm_control.joint_group import JointGroup
from arm_control.joint_limits import LIMITED, JointLimits
from arm_control.limit_rules import rule_for
from arm_control.resource_manager import ResourceManager


class CommandLimiter:
    """Clamps the manager's commands, once per cycle between controllers and hardware.

    A higher command never becomes a lower one. NaN, which is no command, stays NaN. Loop thread
    only.
    """

    def __init__(self, limits: Mapping[str, JointLimits], resources: ResourceManager) -> None:
        """Find the commands that limits speak of.

        Args:
            limits: by joint.
            resources: has commands and states.
        """
        names = [
            name
            for component in resources.components.values()
            for name in component.hardware.command_interfaces
            if name.rpartition("/")[0] in limits
        ]
        self._kinds = [
            _LimitedCommands(
                kind, [name for name in names if name.endswith(f"/{kind}")], limits, resources
            )
            for kind in LIMITED
            if any(name.endswith(f"/{kind}") for name in names)
        ]

    def claimed(self, commands: Collection[str]) -> None:
        """Hear which commands controllers hold now; those newly held start from the states."""
        for kind in self._kinds:
            kind.claimed(commands)

    def enforce(self, period_s: float) -> None:
        """Clamp every command that is beyond what is allowed in a cycle of this length."""
        if not period_s > 0.0:
            return
        # Bounds that do not exist are infinite, so there are differences and products of those.
        with np.errstate(invalid="ignore", over="ignore"):
            for kind in self._kinds:
                kind.enforce(period_s)


class _LimitedCommands:
    """All commands of one kind, and what each of them was in the last cycle."""

    def __init__(
        self,
        kind: str,
        names: Sequence[str],
        limits: Mapping[str, JointLimits],
        resources: ResourceManager,
    ) -> None:
        joints = [name.rpartition("/")[0] for name in names]
        group = JointGroup([limits[joint] for joint in joints], joints, resources)
        self._rule = rule_for(kind, group)
        self._names = names
        self._window = resources.loan_commands(names)
        self._previous = np.full(len(names), np.nan)
        self._held = np.zeros(len(names), dtype=bool)

    def claimed(self, commands: Collection[str]) -> None:
        """Forget the last command of those that nobody held until now."""
        held = np.array([name in commands for name in self._names])
        self._previous[held & ~self._held] = np.nan
        self._held = held

    def enforce(self, period_s: float) -> None:
        """Clamp what is held; what nobody holds is the hardware's own."""
        commands = self._window.read()
        low, high = self._rule.band(commands, self._previous, period_s)
        allowed = np.where(self._held, np.minimum(np.maximum(commands, low), high), commands)
        self._window.write(allowed)
        given = np.isfinite(allowed)
        self._previous[given] = allowed[given]
