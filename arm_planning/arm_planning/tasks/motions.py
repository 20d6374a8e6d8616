"""Stages that move the robot: to a goal, by a distance, or from one scene to another."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import cos, sin

import numpy as np

from arm_node.rigid_transform import RigidTransform, Vector, rotated
from arm_planning.errors import NoPlanError
from arm_planning.planner import Planner
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.costs import Cost, duration
from arm_planning.tasks.solution import Solution, moved, moved_back
from arm_planning.tasks.solvers import CartesianPathSolver, Goal, PipelinePlanner, Solver
from arm_planning.tasks.stage import SingleStage, StageInterface, TaskSearch
from arm_planning.trajectory import TimedTrajectory

SAME_POSITION, SAME_PLACE_M = 1e-4, 1e-4
"""Differences that a stage may leave between the scenes that it connects, rad and m."""
DEFAULT_SOLVER, STRAIGHT = PipelinePlanner(), CartesianPathSolver()


class MoveTo(SingleStage):
    """Moves a group to a goal; backwards, from there.

    Args:
        name: see `TaskStage`.
        group: the group.
        goal: the name of a state, positions of joints, where others stay, or a pose of the
            group's tip in the planning frame.
        solver: plans the motion.
        cost: see `SingleStage`.
    """

    def __init__(
        self,
        name: str,
        group: str,
        goal: str | Mapping[str, float] | RigidTransform,
        solver: Solver = DEFAULT_SOLVER,
        cost: Cost = duration,
    ) -> None:
        super().__init__(name, cost)
        self._group, self._goal, self._solver = group, goal, solver

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        scene, make = _way(start, end)
        goal = self._complete(search.planner, scene)
        found = self._solver.plan(search, self._group, scene, goal)
        yield self.priced(make(self.name, scene, found), search)

    def _complete(self, planner: Planner, scene: PlanningScene) -> Goal:
        if isinstance(self._goal, RigidTransform):
            return self._goal
        group = planner.model.group(self._group)
        given = (
            planner.model.state(self._group, self._goal)
            if isinstance(self._goal, str)
            else self._goal
        )
        return {joint: given.get(joint, scene.positions[joint]) for joint in group.joints}


@dataclass(frozen=True, slots=True)
class Twist:
    """A straight motion and a turn.

    Attributes:
        frame: a link, an object or a frame of the scene; "" for the planning frame.
        linear: the motion along its axes, in m.
        angular: the turn as a rotation vector about its axes, in rad.
    """

    frame: str = ""
    linear: Vector = (0.0, 0.0, 0.0)
    angular: Vector = (0.0, 0.0, 0.0)


class MoveRelative(SingleStage):
    """Moves a link straight by a distance, or joints by offsets; backwards, it ends there.

    Args:
        name: see `TaskStage`.
        group: the group.
        by: the motion of the link, or the offsets of joints in rad or m.
        link: the link; "" for the group's tip.
        min_distance_m: how far it must come, if the way is blocked; None for the whole way. For
            a turn, the same share of it counts.
        solver: moves the link, or plans the motion of joints.
        cost: see `SingleStage`.
    """

    def __init__(
        self,
        name: str,
        group: str,
        by: Twist | Mapping[str, float],
        *,
        link: str = "",
        min_distance_m: float | None = None,
        solver: CartesianPathSolver = STRAIGHT,
        cost: Cost = duration,
    ) -> None:
        super().__init__(name, cost)
        self._group, self._by, self._link = group, by, link
        self._min_m, self._solver = min_distance_m, solver

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        scene, make = _way(start, end)
        sign = 1.0 if end is None else -1.0
        if isinstance(self._by, Twist):
            found = self._along(search.planner, scene, self._by, sign)
        else:
            found = self._offset(search, scene, self._by, sign)
        yield self.priced(make(self.name, scene, found), search)

    def _offset(
        self, search: TaskSearch, scene: PlanningScene, by: Mapping[str, float], sign: float
    ) -> TimedTrajectory:
        joints = search.planner.model.group(self._group).joints
        unknown = next((joint for joint in by if joint not in joints), None)
        if unknown is not None:
            raise NoPlanError(f"group '{self._group}' has no joint '{unknown}'")
        goal = {joint: scene.positions[joint] + sign * by.get(joint, 0.0) for joint in joints}
        return PipelinePlanner(timing=self._solver.timing).plan(search, self._group, scene, goal)

    def _along(
        self, planner: Planner, scene: PlanningScene, by: Twist, sign: float
    ) -> TimedTrajectory:
        link = self._link or planner.model.group(self._group).tip
        links = LinkPoses(planner.model, scene.positions)
        turned = frame_pose(scene, links, by.frame).rotation
        along = rotated(turned, by.linear)
        about = rotated(turned, by.angular)
        pose = planner.link_pose(link, scene)
        x, y, z = (p + sign * step for p, step in zip(pose.position, along, strict=True))
        turn = RigidTransform(rotation=_quaternion(about, sign)).then(
            RigidTransform(rotation=pose.rotation)
        )
        found = planner.cartesian_path(
            self._group,
            [RigidTransform((x, y, z), turn.rotation)],
            max_step_m=self._solver.step_m,
            link=link,
            timing=self._solver.timing,
            scene=scene,
        )
        length = float(np.linalg.norm(by.linear))
        needed = 1.0 if self._min_m is None else min(self._min_m / length, 1.0) if length else 0.0
        if found.fraction < needed or len(found.trajectory.positions) < 2:
            least = "" if self._min_m is None else f"; it is to come {self._min_m * 1e3:g} mm far"
            raise NoPlanError(f"{found.stopped}{least}")
        return found.trajectory


class Connect(SingleStage):
    """Moves a group from one scene to another, in which only its joints are elsewhere.

    Args:
        name: see `TaskStage`.
        group: the group.
        solver: plans the motion.
        cost: see `SingleStage`.
    """

    INTERFACE = StageInterface.CONNECTOR

    def __init__(
        self, name: str, group: str, solver: Solver = DEFAULT_SOLVER, cost: Cost = duration
    ) -> None:
        super().__init__(name, cost)
        self._group, self._solver = group, solver

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        assert start is not None
        assert end is not None
        group = search.planner.model.group(self._group)
        if difference := _difference(start, end, group.joints):
            raise NoPlanError(difference)
        goal = {joint: end.positions[joint] for joint in group.joints}
        found = self._solver.plan(search, self._group, start, goal)
        yield self.priced(moved(self.name, start, found), search)


def _way(start: PlanningScene | None, end: PlanningScene | None):  # noqa: ANN202
    """Return the scene to plan from, and what makes a solution of a motion."""
    if start is not None:
        return start, moved
    assert end is not None
    return end, moved_back


def _difference(start: PlanningScene, end: PlanningScene, joints: tuple[str, ...]) -> str:
    """Return what differs between two scenes, apart from some joints; "" if nothing does."""
    for joint, position in start.positions.items():
        there = end.positions[joint]
        if joint not in joints and abs(position - there) > SAME_POSITION:
            return (
                f"joint '{joint}' is at {position:.4g} before and at {there:.4g} after it, and "
                "its group does not move it"
            )
    if start.attached.keys() != end.attached.keys():
        before, after = (", ".join(scene.attached) or "nothing" for scene in (start, end))
        return f"the robot holds {before} before and {after} after it"
    if start.objects.keys() != end.objects.keys():
        name = sorted(start.objects.keys() ^ end.objects.keys())[0]
        return f"object '{name}' is in the world only on one side of it"
    for name, each in start.objects.items():
        off = np.linalg.norm(np.subtract(each.pose.position, end.objects[name].pose.position))
        if off > SAME_PLACE_M:
            return f"object '{name}' is {off * 1e3:.1f} mm elsewhere after it"
    return ""


def _quaternion(vector: Vector, sign: float) -> tuple[float, float, float, float]:
    angle = float(np.linalg.norm(vector))
    share = sign * sin(angle / 2.0) / angle if angle else 0.0
    x, y, z = vector
    return (x * share, y * share, z * share, cos(angle / 2.0))
