"""A planned motion: where the robot is on its way, how long it is, and how its tip moves."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses
from arm_planning.trajectory import TimedTrajectory

TRAIL_POINTS = 100


@dataclass(frozen=True, slots=True, eq=False)
class PlannedPath:
    """Motions that follow one another.

    Attributes:
        model: the robot.
        start: positions of the robot's joints before the motion.
        motions: at least one; each has at least one point.
    """

    model: PlanningModel
    start: JointPositions
    motions: tuple[TimedTrajectory, ...]

    @property
    def duration_s(self) -> float:
        """The time that all motions take together."""
        return sum(motion.duration_s for motion in self.motions)

    @property
    def points(self) -> int:
        """The number of way points."""
        return sum(len(motion.times_s) for motion in self.motions)

    def positions_at(self, time_s: float) -> JointPositions:
        """Return the positions of all joints, linear between way points.

        Args:
            time_s: time since the start; before it is the start, after the end the end.
        """
        positions = dict(self.start)
        for motion in self.motions:
            for joint, values in zip(motion.joints, motion.positions.T, strict=True):
                positions[joint] = float(np.interp(time_s, motion.times_s, values))
            if time_s < motion.duration_s:
                break
            time_s -= motion.duration_s
        return positions

    def tip(self) -> str:
        """Return the link whose trail is shown: the tip of the group with the moved joints.

        Without such a group it is the link that the last moved joint carries.
        """
        moved = {joint for motion in self.motions for joint in motion.joints}
        for group in self.model.groups.values():
            if group.tip and set(group.joints) == moved:
                return group.tip
        carried = [j.child for j in self.model.robot.joints_in_tree_order if j.name in moved]
        return carried[-1] if carried else self.model.robot.root

    def trail(self) -> NDArray[np.float64]:
        """Return where the tip is along the way in the planning frame, (n, 3) in m."""
        tip = self.tip()
        times = np.linspace(0.0, self.duration_s, TRAIL_POINTS)
        states = [self.positions_at(time_s) for time_s in times.tolist()]
        return np.array([LinkPoses(self.model, state)[tip].position for state in states])

    def summary(self, planning_time_s: float = 0.0) -> str:
        """Return time and length in a sentence; a planning time of 0 is not known."""
        trail = self.trail()
        length_m = float(np.linalg.norm(np.diff(trail, axis=0), axis=1).sum())
        said = f"{self.duration_s:.2f} s, {self.points} points; {self.tip()} moves {length_m:.3f} m"
        return f"{said}; planned in {planning_time_s * 1e3:.0f} ms" if planning_time_s else said

    def is_same(self, other: "PlannedPath") -> bool:
        """Return whether another one has the same motions."""
        return len(self.motions) == len(other.motions) and all(
            _equal(mine, theirs) for mine, theirs in zip(self.motions, other.motions, strict=True)
        )


def _equal(first: TimedTrajectory, second: TimedTrajectory) -> bool:
    return (
        first.joints == second.joints
        and np.array_equal(first.times_s, second.times_s)
        and np.array_equal(first.positions, second.positions)
    )


def planned_path(
    model: PlanningModel, start: JointPositions, motions: Sequence[TimedTrajectory]
) -> PlannedPath | None:
    """Return motions from a start as a path.

    Return None if none of them has a point, or one is for another robot.
    """
    moving = tuple(motion for motion in motions if len(motion.times_s))
    known = {joint.name for joint in model.robot.joints}
    if not moving or any(not known.issuperset(motion.joints) for motion in moving):
        return None
    return PlannedPath(model, start, moving)
