"""Whether a state satisfies constraints, how far it is from that, and in words what is violated.

The rules are MoveIt's: a joint is inside its tolerances, continuous ones by the shortest angle; a
point is in the union of its regions; each component of a link's rotation error is in its tolerance.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import rotation_from_quaternion
from arm_description.urdf.joint_type import JointType
from arm_node.names import describe_known
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    OrientationError,
    PositionConstraint,
    tightened,
)
from arm_planning.constraints.regions import describe_shape, distance_outside, local_point
from arm_planning.errors import InvalidGoalError
from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel

Array = NDArray[np.float64]
LinkPose = Callable[[Array, str], Array]
"""Returns the pose of a link in the planning frame, (4, 4), at positions of the group, (n,)."""

EPSILON = 2.0 * float(np.finfo(float).eps)
"""How much a joint may miss its tolerance, as in MoveIt."""
ROUNDING_M = 1e-9
"""Distance outside of a region that rounding explains."""
SINGULAR = 1e-6
"""Cosine of the second Euler angle below which the first and the third turn about one axis."""


@dataclass(frozen=True, slots=True)
class ConstraintResult:
    """What one constraint says about a state.

    Attributes:
        satisfied: whether it holds.
        distance: MoveIt's measure: the weight times the joint's difference, the distance from the
            region's centre in m, or the sum of the rotation error's components in rad.
        excess: by how much it is violated, rad or m; 0 if it holds.
        sentence: what is violated by how much; "" if it holds.
    """

    satisfied: bool
    distance: float
    excess: float
    sentence: str


class ConstraintEvaluator:
    """Evaluates constraints at states of a group.

    For one thread if `pose` is for one thread.

    Args:
        constraints: what is to hold.
        model: the robot.
        group: the group whose positions vary.
        positions: positions of the robot's other active joints.
        pose: poses of links.

    Raises:
        PlanningError: INVALID_GOAL_CONSTRAINTS: a joint does not exist, or a number is not finite.
    """

    def __init__(
        self,
        constraints: MotionConstraints,
        model: PlanningModel,
        group: JointGroup,
        positions: JointPositions,
        pose: LinkPose,
    ) -> None:
        self.constraints = constraints
        self._model, self._group, self._positions = model, group, positions
        self._joints = JointReader(model, group, positions)
        for each in constraints.joints:
            self._joints.check(each)
        self._pose = pose

    def results(self, q: Array) -> tuple[ConstraintResult, ...]:
        """Return a result for each constraint: joints, positions, orientations."""
        return (
            *(self._joint(each, q) for each in self.constraints.joints),
            *(self._position(each, q) for each in self.constraints.positions),
            *(self._orientation(each, q) for each in self.constraints.orientations),
        )

    def satisfied(self, q: Array) -> bool:
        """Return whether all constraints hold."""
        return (
            all(self._joint(each, q).satisfied for each in self.constraints.joints)
            and all(self._position(each, q).satisfied for each in self.constraints.positions)
            and all(self._orientation(each, q).satisfied for each in self.constraints.orientations)
        )

    def distance(self, q: Array) -> float:
        """Return the sum of the constraints' distances."""
        return sum(result.distance for result in self.results(q))

    def violation(self, q: Array) -> str:
        """Return a sentence on the first violated constraint; "" if all hold."""
        return next((each.sentence for each in self.results(q) if not each.satisfied), "")

    def residual(self, q: Array) -> Array:
        """Return by how much each component is outside of its tolerance, signed, rad and m.

        All zeros where the constraints hold. A joint gives one component, a position one, an
        orientation three.
        """
        parts = [self._joint_residual(each, q) for each in self.constraints.joints]
        parts += [self._outside(each, q)[0] for each in self.constraints.positions]
        for each in self.constraints.orientations:
            error = self._rotation_error(each, q)
            tolerances = np.array(each.tolerances)
            parts.extend((error - np.clip(error, -tolerances, tolerances)).tolist())
        return np.array(parts)

    def tightened(self, share: float) -> "ConstraintEvaluator":
        """Return an evaluator of the same constraints with a share of their tolerances."""
        return ConstraintEvaluator(
            tightened(self.constraints, share),
            self._model,
            self._group,
            self._positions,
            self._pose,
        )

    def _joint_residual(self, each: JointConstraint, q: Array) -> float:
        difference = self._joints.difference(each, q)
        return difference - min(max(difference, -each.below), each.above)

    def _joint(self, each: JointConstraint, q: Array) -> ConstraintResult:
        difference = self._joints.difference(each, q)
        excess = abs(self._joint_residual(each, q))
        distance = each.weight * abs(difference)
        if excess <= EPSILON:
            return ConstraintResult(True, distance, 0.0, "")
        unit = self._joints.unit(each.joint)
        sentence = (
            f"joint '{each.joint}' is at {self._joints.position(each.joint, q):.4g} {unit}, "
            f"{excess:.4g} {unit} outside of {each.position - each.below:.4g} to "
            f"{each.position + each.above:.4g} {unit}"
        )
        return ConstraintResult(False, distance, excess, sentence)

    def _outside(self, each: PositionConstraint, q: Array) -> tuple[float, int, Array]:
        """Distance from the nearest region, its index, and the point in the regions' frame."""
        pose = self._pose(q, each.link)
        point = pose[:3, :3] @ np.array(each.offset) + pose[:3, 3]
        if each.frame:
            frame = self._pose(q, each.frame)
            point = (point - frame[:3, 3]) @ frame[:3, :3]
        outside = [
            distance_outside(region.shape, local_point(region, point)) for region in each.regions
        ]
        nearest = min(range(len(outside)), key=outside.__getitem__)
        return outside[nearest], nearest, point

    def _position(self, each: PositionConstraint, q: Array) -> ConstraintResult:
        if not each.regions:
            # MoveIt ignores a constraint without a region.
            return ConstraintResult(True, 0.0, 0.0, "")
        outside, nearest, point = self._outside(each, q)
        region = each.regions[nearest]
        distance = each.weight * math.dist(point.tolist(), region.pose.position)
        if outside <= ROUNDING_M:
            return ConstraintResult(True, distance, 0.0, "")
        sentence = (
            f"link '{each.link}' is {1000.0 * outside:.3g} mm outside of its region, "
            f"{describe_shape(region.shape)}"
        )
        return ConstraintResult(False, distance, outside, sentence)

    def _rotation_error(self, each: OrientationConstraint, q: Array) -> Array:
        rotation = self._pose(q, each.link)[:3, :3]
        if each.frame:
            rotation = self._pose(q, each.frame)[:3, :3].T @ rotation
        wanted = rotation_from_quaternion(np.array(each.orientation))
        if each.error is OrientationError.ROTATION_VECTOR:
            # R_link R_wanted^T, whose rotation vector is already in the frame of the constraint.
            error = rotation_vector(rotation @ wanted.T)
            return rotation_from_quaternion(np.array(each.axes)).T @ error
        return euler_error(wanted.T @ rotation, each.tolerances)

    def _orientation(self, each: OrientationConstraint, q: Array) -> ConstraintResult:
        error = self._rotation_error(each, q)
        excess = np.abs(error) - np.array(each.tolerances)
        worst = int(np.argmax(excess))
        distance = each.weight * float(np.abs(error).sum())
        if excess[worst] <= EPSILON:
            return ConstraintResult(True, distance, 0.0, "")
        sentence = (
            f"link '{each.link}' is turned by {abs(error[worst]):.3g} rad about {'xyz'[worst]} "
            f"from its orientation, {each.tolerances[worst]:.3g} rad are allowed"
        )
        return ConstraintResult(False, distance, float(excess[worst]), sentence)


class JointReader:
    """Positions of any movable joint of the robot: of the group, of others, of mimic joints."""

    def __init__(self, model: PlanningModel, group: JointGroup, positions: JointPositions) -> None:
        self._index = {joint: index for index, joint in enumerate(group.joints)}
        self._positions = positions
        self._joints = {joint.name: joint for joint in model.robot.movable_joints}

    def check(self, constraint: JointConstraint) -> None:
        """Refuse a constraint on a joint that does not exist, or that is not finite.

        Raises:
            PlanningError: INVALID_GOAL_CONSTRAINTS.
        """
        name = constraint.joint
        if name not in self._joints:
            known = describe_known(name, self._joints, "the robot has")
            sentence = f"a constraint names the joint '{name}'; {known}"
            raise InvalidGoalError(sentence)
        if not all(map(math.isfinite, (constraint.position, constraint.above, constraint.below))):
            raise InvalidGoalError(f"the constraint on joint '{name}' is not finite")

    def position(self, name: str, q: Array) -> float:
        """Return a joint's position, rad or m."""
        if name in self._index:
            return float(q[self._index[name]])
        mimic = self._joints[name].mimic
        if mimic is not None:
            return mimic.position(self.position(mimic.joint, q))
        return self._positions[name]

    def difference(self, constraint: JointConstraint, q: Array) -> float:
        """Return position minus wanted position; the shortest angle if the joint is continuous."""
        difference = self.position(constraint.joint, q) - constraint.position
        if self._joints[constraint.joint].type is JointType.CONTINUOUS:
            return math.remainder(difference, 2.0 * math.pi)
        return difference

    def unit(self, name: str) -> str:
        """Return "rad" or "m"."""
        return "m" if self._joints[name].type.slides else "rad"


def rotation_vector(rotation: Array) -> Array:
    """Return the axis times the angle in [0, pi] of a (3, 3) rotation, (3,)."""
    skew = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    sine, cosine = float(np.linalg.norm(skew)) / 2.0, (float(np.trace(rotation)) - 1.0) / 2.0
    angle = math.atan2(sine, cosine)
    if sine > 1e-7:
        return skew * (angle / (2.0 * sine))
    if cosine > 0.0:
        return skew / 2.0
    # Near half a turn, R + I is twice the axis times itself.
    column = int(np.argmax(np.diag(rotation)))
    axis = rotation[:, column] + np.eye(3)[column]
    return axis * (angle / float(np.linalg.norm(axis)))


def euler_error(rotation: Array, tolerances: tuple[float, float, float]) -> Array:
    """Return the intrinsic x, y, z angles of a (3, 3) rotation, each in [-pi, pi], (3,).

    With the second angle at a right angle, the first and the third turn about one axis: the first
    takes as much of their sum as its tolerance allows, and the third takes the rest.
    """
    y = math.asin(min(max(float(rotation[0, 2]), -1.0), 1.0))
    if math.hypot(float(rotation[0, 0]), float(rotation[0, 1])) > SINGULAR:
        x = math.atan2(-float(rotation[1, 2]), float(rotation[2, 2]))
        z = math.atan2(-float(rotation[0, 1]), float(rotation[0, 0]))
        return np.array([x, y, z])
    total = math.atan2(float(rotation[1, 0]), float(rotation[1, 1]))
    sign = math.copysign(1.0, y)
    x = min(max(sign * total, -tolerances[0]), tolerances[0])
    return np.array([x, y, total - sign * x])
