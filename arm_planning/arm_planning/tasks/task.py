"""A task: stages one after the other, planned as a whole, with the reasons if there is no way."""

from collections.abc import Callable, Iterator

from arm_planning.errors import MoveItErrorCode, NoPlanError, PlanningError
from arm_planning.planner import Planner
from arm_planning.planners.problem import Deadline, never
from arm_planning.tasks.containers import SerialContainer
from arm_planning.tasks.solution import Solution
from arm_planning.tasks.stage import OutOfTimeError, StageInterface, TaskSearch, TaskStage

REASONS = 3
"""Reasons of a stage that a report tells, the most frequent first."""


class StagedTask(SerialContainer):
    """Stages one after the other, the first of which begins: `CurrentState`, as a rule.

    A task is planned before it is executed. Its solutions consist of motions that are proved free.
    """

    def plan(
        self,
        planner: Planner,
        *,
        max_solutions: int = 1,
        allowed_time_s: float = 60.0,
        seed: int = 0,
        interrupted: Callable[[], bool] = never,
    ) -> tuple[Solution, ...]:
        """Return solutions, the cheapest first.

        Args:
            planner: plans the motions, in its scene.
            max_solutions: number of solutions after which the search ends.
            allowed_time_s: when the search ends; with what is found by then, if there is any.
            seed: the same task, scene and seed give the same solutions.
            interrupted: tells when planning is to end early.

        Raises:
            PlanningError: there is no solution; the message names the stage that has none, and its
                most frequent reason.
        """
        if self.interface is not StageInterface.GENERATOR:
            raise NoPlanError(f"task '{self.name}' has no stage that begins, such as CurrentState")
        self.reset()
        search = TaskSearch(planner, seed, Deadline.after(allowed_time_s, interrupted))
        found: list[Solution] = []
        ended: PlanningError | None = None
        try:
            for solution in self.solve(search, None, None):
                found.append(solution)
                if len(found) >= max_solutions:
                    break
        except OutOfTimeError as error:
            ended = error
        if not found:
            code = MoveItErrorCode.PLANNING_FAILED if ended is None else ended.code
            late = "" if ended is None else f"; {ended}"
            raise PlanningError(code, f"task '{self.name}': {self._obstacle()}{late}")
        return tuple(sorted(found, key=lambda each: each.cost))

    def report(self) -> str:
        """Return a line for each stage: its solutions, its failures and their reasons."""
        return "\n".join(_lines(self, 0))

    def _obstacle(self) -> str:
        """Return the sentence about the stage that stands in the way."""
        steps = [stage for stage in _all(self) if stage.failures]
        unsolved = [stage for stage in steps if not stage.solved]
        if not steps:
            return "no stage has failed, but its solutions do not fit together"
        stage = (unsolved or steps)[-1]
        reason, count = stage.failures.most_common(1)[0]
        total = stage.failures.total()
        times = "" if total == 1 else f" in {count} of {total} failures"
        return f"stage '{stage.name}' has no solution{times}: {reason}"


def _all(stage: TaskStage) -> Iterator[TaskStage]:
    yield stage
    for child in stage.children:
        yield from _all(child)


def _lines(stage: TaskStage, depth: int) -> Iterator[str]:
    failed = stage.failures.total()
    yield f"{'  ' * depth}{stage.name}: {stage.solved} solved, {failed} failed"
    for reason, count in stage.failures.most_common(REASONS):
        yield f"{'  ' * (depth + 1)}{count} x {reason}"
    if len(stage.failures) > REASONS:
        yield f"{'  ' * (depth + 1)}and {len(stage.failures) - REASONS} other reasons"
    for child in stage.children:
        yield from _lines(child, depth + 1)
