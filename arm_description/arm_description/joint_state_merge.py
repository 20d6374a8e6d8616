"""Joint states from defaults, a sweep and other joint states, merged by name."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from arm_description.errors import JointStateError, SettingsError
from arm_description.joint_publisher_settings import Dependence, JointPublisherSettings
from arm_description.names import listing
from arm_description.robot import Joint, Robot

PUBLISHED = ("revolute", "continuous", "prismatic")
"""Joint types with one position; the others have none or several."""


@dataclass(frozen=True, slots=True)
class MergedState:
    """A joint state; a field that no joint has is empty. rad or m, per s, N m or N."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    efforts: tuple[float, ...]


@dataclass(slots=True)
class _FreeJoint:
    """A joint with a state of its own."""

    lower: float
    upper: float
    zero: float
    wraps: bool
    position: float | None
    velocity: float | None
    effort: float | None
    forward: bool = True

    def sweep(self, delta: float) -> None:
        """Move by delta, back from the bounds; a continuous joint starts again at the lower."""
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

    def __init__(self, robot: Robot, settings: JointPublisherSettings) -> None:
        """Take a robot's joints, in the document's order.

        Raises:
            SettingsError: joints that depend on each other in a circle, or on one that the
                robot does not have.
        """
        self._delta = settings.delta
        joints = [joint for joint in robot.joints if joint.type in PUBLISHED]
        dependences = _dependences(robot, settings)
        self._free = {
            joint.name: _free_joint(joint, settings)
            for joint in joints
            if joint.name not in dependences
        }
        standing = {joint.name for joint in robot.joints} - {joint.name for joint in joints}
        # Every published joint as a function of a free one; of None where that cannot move.
        self._rules: dict[str, tuple[_FreeJoint | None, float, float]] = {}
        for joint in joints:
            chain = _compose(joint.name, dependences)
            if chain.parent not in self._free and chain.parent not in standing:
                raise SettingsError(
                    f"joint '{joint.name}' depends on joint '{chain.parent}', which the robot "
                    f"does not have; it has {listing(self._free)}"
                )
            self._rules[joint.name] = (self._free.get(chain.parent), chain.factor, chain.offset)

    @property
    def names(self) -> tuple[str, ...]:
        """The joints published, in the document's order."""
        return tuple(self._rules)

    def set_delta(self, delta: float) -> None:
        """Set by how much `sweep` moves, rad or m."""
        self._delta = delta

    def merge(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float],
        efforts: Sequence[float],
    ) -> None:
        """Take the state of joints by name; the last word counts. Empty fields say nothing.

        Joints that the robot does not have, and dependent ones, are passed over.

        Raises:
            JointStateError: a field of another length than the names, or a position that is not
                finite; nothing of the message is taken.
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
        """Return the state of all joints; 0 for a value that nobody has given."""
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


def _dependences(robot: Robot, settings: JointPublisherSettings) -> dict[str, Dependence]:
    result = dict(settings.dependent_joints)
    if settings.use_mimic_tags:
        for joint in robot.joints:
            if joint.mimic is not None and joint.type in PUBLISHED:
                mimic = joint.mimic
                result[joint.name] = Dependence(mimic.joint, mimic.multiplier, mimic.offset)
    return result


def _compose(name: str, dependences: dict[str, Dependence]) -> Dependence:
    """Return the dependence of a joint on the free joint at the end of its chain."""
    chain = {name: None}
    parent, factor, offset = name, 1.0, 0.0
    while parent in dependences:
        link = dependences[parent]
        offset += factor * link.offset
        factor *= link.factor
        parent = link.parent
        if parent in chain:
            circle = " -> ".join([*chain, parent])
            raise SettingsError(f"joints depend on each other in a circle: {circle}")
        chain[parent] = None
    return Dependence(parent, factor, offset)


def position_range(joint: Joint, with_soft_limits: bool = True) -> tuple[float, float]:
    """Return between which positions a joint of one position is moved: rad, or m.

    Without limits that is half a turn to both sides.

    Args:
        joint: of a type in `PUBLISHED`.
        with_soft_limits: whether those of a `<safety_controller>` narrow the range. It is empty,
            the lower end above the upper, where they leave the joint no position.
    """
    lower, upper = -math.pi, math.pi
    if joint.type != "continuous" and joint.limit is not None:
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
        wraps=joint.type == "continuous",
        position=zero if settings.publish_default_positions else None,
        velocity=0.0 if settings.publish_default_velocities else None,
        effort=0.0 if settings.publish_default_efforts else None,
    )
