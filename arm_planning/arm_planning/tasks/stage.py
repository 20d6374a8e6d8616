"""What all stages have in common: an interface, a cost, and the reasons of what they refuse."""

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum

from arm_planning.errors import PlanningError
from arm_planning.planner import Planner
from arm_planning.planners.problem import NO_DEADLINE, Deadline
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.costs import Cost, duration
from arm_planning.tasks.solution import Solution


class StageInterface(Enum):
    """What a stage needs to be given."""

    GENERATOR = "neither scene"
    PROPAGATOR = "one scene, before or after it"
    CONNECTOR = "both scenes"


class OutOfTimeError(PlanningError):
    """The time of the task is over, or it was interrupted: no stage goes on."""


@dataclass(frozen=True, slots=True)
class TaskSearch:
    """A search for solutions of a task.

    Attributes:
        planner: plans the motions.
        seed: the same task, scene and seed give the same solutions.
        deadline: when it ends.
        found: the solutions on the way to here, by stage, for stages that monitor others.
    """

    planner: Planner
    seed: int = 0
    deadline: Deadline = NO_DEADLINE
    found: Mapping[str, Solution] = field(default_factory=dict)

    def after(self, solution: Solution) -> "TaskSearch":
        """Return the search with one more solution on its way."""
        new = {each.stage: each for each in solution.all()}
        return replace(self, found={**self.found, **new})

    def check(self) -> None:
        """End the search when its time is over.

        Raises:
            OutOfTimeError: it is.
        """
        try:
            self.deadline.check("planning the task")
        except PlanningError as error:
            raise OutOfTimeError(error.code, str(error)) from error


class TaskStage(ABC):
    """One step of a task. For one task, and one thread at a time.

    Attributes:
        name: what reports call it, and what other stages monitor it by.
        solved: number of solutions in the latest plan.
        failures: how often it failed in the latest plan, by the reason.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.solved = 0
        self.failures: Counter[str] = Counter()

    @property
    @abstractmethod
    def interface(self) -> StageInterface:
        """What it needs to be given."""

    @property
    def children(self) -> tuple["TaskStage", ...]:
        """The stages within it."""
        return ()

    def reset(self) -> None:
        """Forget the latest plan."""
        self.solved = 0
        self.failures.clear()
        for child in self.children:
            child.reset()

    def solve(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        """Yield solutions between the scenes that are given; see `StageInterface`.

        Raises:
            OutOfTimeError: the search is over.
        """
        search.check()
        try:
            for solution in self._solutions(search, start, end):
                self.solved += 1
                yield solution
                search.check()
        except OutOfTimeError:
            raise
        except PlanningError as error:
            self.failures[str(error)] += 1

    @abstractmethod
    def _solutions(
        self, search: TaskSearch, start: PlanningScene | None, end: PlanningScene | None
    ) -> Iterator[Solution]:
        """Yield solutions; a PlanningError is the reason why there are no more."""


class SingleStage(TaskStage):
    """A stage without others in it, whose solutions have a cost of its own.

    Args:
        name: see `TaskStage`.
        cost: of its solutions; by default how long they take.

    Attributes:
        INTERFACE: what stages of its class need to be given; by default one scene.
    """

    INTERFACE = StageInterface.PROPAGATOR

    def __init__(self, name: str, cost: Cost = duration) -> None:
        super().__init__(name)
        self.cost = cost

    @property
    def interface(self) -> StageInterface:
        """That of its class."""
        return self.INTERFACE

    def priced(self, solution: Solution, search: TaskSearch) -> Solution:
        """Return a solution with its cost.

        Raises:
            PlanningError: the cost refuses it.
        """
        return replace(solution, cost=self.cost(solution, search.planner))
