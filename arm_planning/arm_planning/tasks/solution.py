"""What a stage of a task finds: a motion or a change of the scene, from one scene to another."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """One way through a stage.

    Attributes:
        stage: name of the stage.
        start: the scene before it.
        end: the scene after it.
        cost: what it costs; the solutions with the least come first.
        trajectory: the motion; None if it moves nothing.
        parts: the solutions of a container's stages, in the order in which they are executed.
        target: a pose in the planning frame for `ComputeIK`.
    """

    stage: str
    start: PlanningScene
    end: PlanningScene
    cost: float = 0.0
    trajectory: TimedTrajectory | None = None
    parts: tuple["Solution", ...] = ()
    target: RigidTransform | None = None

    @classmethod
    def joined(cls, stage: str, parts: Sequence["Solution"]) -> "Solution":
        """Return the solution that consists of others, one after the other."""
        cost = sum(part.cost for part in parts)
        return cls(stage, parts[0].start, parts[-1].end, cost, parts=tuple(parts))

    @property
    def steps(self) -> tuple["Solution", ...]:
        """The solutions without parts, in the order in which they are executed."""
        if not self.parts:
            return (self,)
        return tuple(step for part in self.parts for step in part.steps)

    def named(self, stage: str) -> "Solution":
        """Return the last solution within this one, or itself, that a stage has found.

        Raises:
            KeyError: there is none.
        """
        return {solution.stage: solution for solution in self.all()}[stage]

    def all(self) -> Iterator["Solution"]:
        """Yield this solution and all within it."""
        yield self
        for part in self.parts:
            yield from part.all()


def moved(stage: str, scene: PlanningScene, trajectory: TimedTrajectory) -> Solution:
    """Return the solution that follows a trajectory from a scene."""
    end = _positions_at(trajectory, -1)
    after = replace(scene, positions={**scene.positions, **end})
    return Solution(stage, scene, after, trajectory=trajectory)


def moved_back(stage: str, scene: PlanningScene, trajectory: TimedTrajectory) -> Solution:
    """Return the solution that ends in a scene, from a trajectory that begins there.

    It is driven backwards: the same states, so it is as free as the other way round.
    """
    back = TimedTrajectory(
        trajectory.joints,
        trajectory.duration_s - trajectory.times_s[::-1],
        trajectory.positions[::-1],
        -trajectory.velocities[::-1],
        trajectory.accelerations[::-1],
    )
    before = replace(scene, positions={**scene.positions, **_positions_at(back, 0)})
    return Solution(stage, before, scene, trajectory=back)


def _positions_at(trajectory: TimedTrajectory, index: int) -> dict[str, float]:
    return dict(zip(trajectory.joints, trajectory.positions[index].tolist(), strict=True))
