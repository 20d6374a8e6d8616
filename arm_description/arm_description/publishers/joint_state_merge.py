"""Merges joint states from defaults, a sweep and other joint states, by name."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from arm_description.errors import JointStateError, SettingsError, UrdfError
from arm_description.publishers.settings import JointPublisherSettings
from arm_description.urdf.robot import Joint, Mimic, resolve_leader
from arm_node.names import listing


@dataclass(frozen=True, slots=True)
class MergedState:
    """A joint state; a field without any value is empty. rad or m, per s, N m or N."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    efforts: tuple[float, ...]


@dataclass(slots=True)
class _FreeJoint:
    """A joint with its own state."""

    lower: float
    upper: float
    zero: float
    wraps: bool
    position: float | None
    velocity: float | None
    effort: float | None
    forward: bool = True

    def sweep(self, delta: float) -> None:
        """Move by delta and reverse at the bounds; a continuous joint restarts at the lower one."""
        start = self.zero if self.position is None else self.position
        position = start + (delta if self.forward else -delta)
        if position > self.upper:
            position = self.lower if self.wraps else self.upper
            self.forward = self.wraps
        elif position < self.lower:
            position = self.lower
            self.forward = True
        self.position = position


class JointStateMerge:
    """The states that joint_state_publisher publishes. One thread at a time."""

    def __init__(self, robot_joints: Sequence[Joint], settings: JointPublisherSettings) -> None:
        """Take a robot's joints in document order.

        Raises:
            MimicCycleError: joints depend on each other in a circle.
            UrdfError: a joint mimics one that the robot does not have.
            SettingsError: a parameter makes a joint depend on one that the robot does not have.
        """
        self._delta = settings.delta
        joints = [joint for joint in robot_joints if joint.type.is_scalar]
        dependences = _dependences(joints, settings)
        self._free = {
            joint.name: _free_joint(joint, settings)
            for joint in joints
            if joint.name not in dependences
        }
        fixed = {joint.name for joint in robot_joints} - {joint.name for joint in joints}
        # Every published joint as a function of a free one, or of None if the leader cannot move.
        self._rules: dict[str, tuple[_FreeJoint | None, float, float]] = {}
        for joint in joints:
            rule = resolve_leader(joint.name, dependences)
            if rule.joint not in self._free and rule.joint not in fixed:
                error_class = UrdfError if joint.mimic is not None else SettingsError
                raise error_class(
                    f"joint '{joint.name}' depends on joint '{rule.joint}', which the robot "
                    f"does not have; it has {listing(self._free)}"
                )
            self._rules[joint.name] = (self._free.get(rule.joint), rule.multiplier, rule.offset)

    @property
    def names(self) -> tuple[str, ...]:
        """The published joints, in document order."""
        return tuple(self._rules)

    def set_delta(self, delta: float) -> None:
        """Set the step of `sweep`, rad or m."""
        self._delta = delta

    def merge(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float],
        efforts: Sequence[float],
    ) -> None:
        """Merge the states of joints by name; the latest value wins. Empty fields change nothing.

        Unknown and dependent joints are ignored.

        Raises:
            JointStateError: a field has another length than the names, or a position is not finite;
                the whole message is ignored.
        """
        for field, values in (
            ("positions", positions),
            ("velocities", velocities),
            ("efforts", efforts),
        ):
            if len(values) not in (0, len(names)):
                raise JointStateError(f"{len(names)} names, but {len(values)} {field}")
        if not all(map(math.isfinite, positions)):
            raise JointStateError(f"a position of {listing(names)} is not a finite number")
        for i, name in enumerate(names):
            joint = self._free.get(name)
            if joint is None:
                continue
            if positions:
                joint.position = positions[i]
            if velocities:
                joint.velocity = velocities[i]
            if efforts:
                joint.effort = efforts[i]

    def sweep(self) -> None:
        """Move every free joint by delta."""
        if self._delta > 0.0:
            for joint in self._free.values():
                joint.sweep(self._delta)

    def state(self) -> MergedState:
        """Return the state of all joints, with 0 for values that were never set."""
        free = self._free.values()
        rules = self._rules.values()
        positions = velocities = efforts = ()
        if any(joint.position is not None for joint in free):
            positions = tuple(
                factor * ((joint.position or 0.0) if joint else 0.0) + offset
                for joint, factor, offset in rules
            )
        if any(joint.velocity is not None for joint in free):
            velocities = tuple(
                factor * ((joint.velocity or 0.0) if joint else 0.0) for joint, factor, _ in rules
            )
        if any(joint.effort is not None for joint in free):
            efforts = tuple((joint.effort or 0.0) if joint else 0.0 for joint, _, _ in rules)
        return MergedState(self.names, positions, velocities, efforts)


def _dependences(joints: Sequence[Joint], settings: JointPublisherSettings) -> dict[str, Mimic]:
    result = dict(settings.dependent_joints)
    if settings.use_mimic_tags:
        result.update((joint.name, joint.mimic) for joint in joints if joint.mimic is not None)
    return result


def position_range(joint: Joint, with_soft_limits: bool = True) -> tuple[float, float]:
    """Return the range of positions of a joint, in rad or m; without limits [-pi, pi].

    Args:
        joint: a joint of a type with a single position.
        with_soft_limits: whether the limits of a `<safety_controller>` narrow the range. If they
            allow no position, the lower end is above the upper one.
    """
    lower, upper = -math.pi, math.pi
    if not joint.type.wraps and joint.limit is not None:
        lower, upper = joint.limit.lower, joint.limit.upper
    if with_soft_limits and joint.safety is not None:
        lower = max(lower, joint.safety.soft_lower)
        upper = min(upper, joint.safety.soft_upper)
    return lower, upper


def _free_joint(joint: Joint, settings: JointPublisherSettings) -> _FreeJoint:
    lower, upper = position_range(joint, settings.use_smallest_joint_limits)
    zero = settings.zeros.get(joint.name)
    if zero is None:
        zero = 0.0 if lower <= 0.0 <= upper else (lower + upper) / 2.0
    return _FreeJoint(
        lower=lower,
        upper=upper,
        zero=zero,
        wraps=joint.type.wraps,
        position=zero if settings.publish_default_positions else None,
        velocity=0.0 if settings.publish_default_velocities else None,
        effort=0.0 if settings.publish_default_efforts else None,
    )
