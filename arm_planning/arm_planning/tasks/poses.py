"""Stages that begin: where the robot is, where it grasps and places, and the joints for that."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import cos, pi, sin

import numpy as np

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, NoPlanError, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.costs import Cost, duration
from arm_planning.tasks.solution import Solution
from arm_planning.tasks.stage import SingleStage, StageInterface, TaskSearch, TaskStage


class Generator(SingleStage):
    """A stage that needs no scene; those that are given to it do not matter."""

    INTERFACE = StageInterface.GENERATOR


class CurrentState(Generator):
    """The planner's scene. With positions of joints it is the task constructor's fixed state."""

    def __init__(
        self, name: str = "current state", positions: Mapping[str, float] | None = None
    ) -> None:
        super().__init__(name)
        self._positions = dict(positions or {})

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        known = search.planner.scene
        unknown = next((joint for joint in self._positions if joint not in known.positions), None)
        if unknown is not None:
            raise NoPlanError(f"the robot has no joint '{unknown}'")
        scene = replace(known, positions={**known.positions, **self._positions})
        touching = search.planner.contacts(scene=scene)
        if touching:
            raise PlanningError(
                MoveItErrorCode.START_STATE_IN_COLLISION, f"there is a collision: {touching[0]}"
            )
        yield Solution(self.name, scene, scene)


class MonitoringGenerator(Generator):
    """A generator whose solutions have the scene after another stage.

    Args:
        name: see `TaskStage`.
        monitors: name of the other stage, which comes before it in the task.
    """

    def __init__(self, name: str, monitors: str) -> None:
        super().__init__(name)
        self._monitors = monitors

    def monitored(self, search: TaskSearch) -> PlanningScene:
        """Return the scene after the other stage.

        Raises:
            PlanningError: no such stage comes before this one.
        """
        if self._monitors not in search.found:
            known = ", ".join(search.found) or "none"
            raise NoPlanError(
                f"it monitors the stage '{self._monitors}', which does not come before it; {known} "
                "does"
            )
        return search.found[self._monitors].end


class GeneratePose(MonitoringGenerator):
    """One pose in the planning frame.

    Args:
        name: see `TaskStage`.
        pose: the pose.
        monitors: see `MonitoringGenerator`.
    """

    def __init__(self, name: str, pose: RigidTransform, *, monitors: str) -> None:
        super().__init__(name, monitors)
        self._pose = pose

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        scene = self.monitored(search)
        yield Solution(self.name, scene, scene, target=self._pose)


class GenerateGraspPose(MonitoringGenerator):
    """Poses of the hand around an object: its frame, moved along its z axis and turned about it.

    Args:
        name: see `TaskStage`.
        object_id: the object in the world.
        monitors: see `MonitoringGenerator`.
        angle_delta: angle between two poses, rad.
        heights_m: where along the z axis, the preferred first.
    """

    def __init__(
        self,
        name: str,
        object_id: str,
        *,
        monitors: str,
        angle_delta: float = pi / 12.0,
        heights_m: Sequence[float] = (0.0,),
    ) -> None:
        super().__init__(name, monitors)
        self._object, self._delta, self._heights_m = object_id, angle_delta, tuple(heights_m)

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        scene = self.monitored(search)
        if self._object not in scene.objects:
            known = ", ".join(scene.objects) or "none"
            raise NoPlanError(f"no object '{self._object}' is in the world; there is {known}")
        pose = scene.objects[self._object].pose
        for height_m in self._heights_m:
            for target in _turned(pose.then(RigidTransform((0.0, 0.0, height_m))), self._delta):
                yield Solution(self.name, scene, scene, target=target)


class GeneratePlacePose(MonitoringGenerator):
    """Poses of a held object where it is to be placed: turned about the z axis of the place.

    Args:
        name: see `TaskStage`.
        object_id: the object, which the robot holds.
        place: pose of the object in the planning frame.
        monitors: see `MonitoringGenerator`.
        angle_delta: angle between two poses, rad.
    """

    def __init__(
        self,
        name: str,
        object_id: str,
        place: RigidTransform,
        *,
        monitors: str,
        angle_delta: float = pi / 12.0,
    ) -> None:
        super().__init__(name, monitors)
        self._object, self._place, self._delta = object_id, place, angle_delta

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        scene = self.monitored(search)
        if self._object not in scene.attached:
            raise NoPlanError(f"the robot does not hold the object '{self._object}'")
        for target in _turned(self._place, self._delta):
            yield Solution(self.name, scene, scene, target=target)


class ComputeIK(Generator):
    """States of a group in which a frame of it is at a generator's pose, the cheapest first.

    Args:
        name: see `TaskStage`.
        poses: generates poses.
        group: the group.
        frame: a link, or an object that the robot holds; "" for the group's tip.
        offset: what is to be at the pose, in that frame.
        max_solutions: number of solutions for each pose.
        cost: see `SingleStage`; by default how far the joints are from the scene's state.
    """

    def __init__(
        self,
        name: str,
        poses: TaskStage,
        group: str,
        *,
        frame: str = "",
        offset: RigidTransform = RigidTransform(),
        max_solutions: int = 8,
        cost: Cost | None = None,
    ) -> None:
        super().__init__(name, cost or duration)
        self._poses, self._group, self._frame = poses, group, frame
        self._offset, self._most, self._by_distance = offset, max_solutions, cost is None
        self._known: InverseKinematics | None = None

    @property
    def children(self) -> tuple[TaskStage, ...]:
        """What generates the poses."""
        return (self._poses,)

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        for posed in self._poses.solve(search, None, None):
            if posed.target is None:
                raise NoPlanError(f"stage '{self._poses.name}' generates no poses")
            try:
                found = self._solved(search, posed.end, posed.target)
            except PlanningError as error:
                self.failures[str(error)] += 1
                continue
            yield from sorted(found, key=lambda each: each.cost)

    def _solved(
        self, search: TaskSearch, scene: PlanningScene, target: RigidTransform
    ) -> list[Solution]:
        planner = search.planner
        group = planner.model.group(self._group)
        frame = self._frame or group.tip
        links = LinkPoses(planner.model, scene.positions)
        # The frame moves with the tip, so it is seen from there.
        in_tip = links[group.tip].inverse().then(frame_pose(scene, links, frame))
        others = {joint: q for joint, q in scene.positions.items() if joint not in group.joints}
        begin = group.positions(scene.positions)
        states = self._kinematics(planner.model, others).solutions(
            target.then(self._offset.inverse()).then(in_tip.inverse()),
            begin,
            most=self._most,
            random_seed=search.seed,
        )
        checker = planner.checker(scene, self._group)
        found: list[Solution] = []
        for q in states:
            if touching := checker.contacts(q):
                self.failures[f"the state is in collision: {_pair(touching[0])}"] += 1
                continue
            joints = zip(group.joints, q.tolist(), strict=True)
            there = replace(scene, positions={**scene.positions, **dict(joints)})
            solution = Solution(self.name, there, there, target=target)
            if self._by_distance:
                far = float(np.abs(q - begin).sum())
                found.append(replace(solution, cost=far))
                continue
            try:
                found.append(self.priced(solution, search))
            except PlanningError as error:
                self.failures[str(error)] += 1
        return found

    def _kinematics(self, model: PlanningModel, others: JointPositions) -> InverseKinematics:
        if self._known is None or not self._known.holds_for(others):
            self._known = InverseKinematics(model, self._group, "", others)
        return self._known


def _pair(contact: object) -> str:
    """Return what touches without its depth, so that the same reason counts as one."""
    return str(contact).partition(",")[0]


def _turned(pose: RigidTransform, delta: float) -> Iterator[RigidTransform]:
    if not 0.0 < delta <= 2.0 * pi:
        raise NoPlanError(f"angle_delta is {delta:g} rad; it is positive, and a whole turn at most")
    for index in range(int(2.0 * pi / delta + 1e-9)):
        half = index * delta / 2.0
        yield pose.then(RigidTransform(rotation=(0.0, 0.0, sin(half), cos(half))))
