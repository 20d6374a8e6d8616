"""The stage that changes the scene: attaches and detaches objects, and lets pairs touch."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from arm_planning.scene.attached_changes import AttachedChange, change_attached
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.object_changes import ObjectChange, Operation
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.solution import Solution
from arm_planning.tasks.stage import SingleStage, TaskSearch


class ModifyPlanningScene(SingleStage):
    """Changes the scene; backwards, it takes its changes back.

    Args:
        name: see `TaskStage`.
        attach: objects of the world that the robot takes.
        detach: objects that it leaves in the world.
        link: the link that they are attached to.
        allow: pairs of links and objects that may touch from now on.
        forbid: pairs that may not any more.
    """

    def __init__(
        self,
        name: str,
        *,
        attach: Sequence[str] = (),
        detach: Sequence[str] = (),
        link: str = "",
        allow: Sequence[tuple[str, str]] = (),
        forbid: Sequence[tuple[str, str]] = (),
    ) -> None:
        super().__init__(name)
        self._attach, self._detach, self._link = tuple(attach), tuple(detach), link
        self._allow, self._forbid = tuple(allow), tuple(forbid)

    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        if start is not None:
            yield Solution(self.name, start, self._changed(search, start, is_back=False))
        elif end is not None:
            yield Solution(self.name, self._changed(search, end, is_back=True), end)

    def _changed(self, search: TaskSearch, scene: PlanningScene, *, is_back: bool) -> PlanningScene:
        links = LinkPoses(search.planner.model, scene.positions)
        attach, detach = (self._detach, self._attach) if is_back else (self._attach, self._detach)
        allow, forbid = (self._forbid, self._allow) if is_back else (self._allow, self._forbid)
        for names, operation in ((attach, Operation.ADD), (detach, Operation.REMOVE)):
            for name in names:
                change = AttachedChange(ObjectChange(operation, name), self._link)
                scene = change_attached(scene, links, change)
        pairs = {
            (min(pair), max(pair)): may_touch
            for touching, may_touch in ((allow, True), (forbid, False))
            for pair in touching
        }
        allowed = replace(scene.allowed, pairs={**scene.allowed.pairs, **pairs})
        return replace(scene, allowed=allowed)
