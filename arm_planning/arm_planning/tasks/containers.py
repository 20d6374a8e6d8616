"""Stages that consist of others: one after the other, any of them, or the first that works."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from arm_planning.errors import NoPlanError
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.solution import Solution
from arm_planning.tasks.stage import OutOfTimeError, StageInterface, TaskSearch, TaskStage

GENERATOR, PROPAGATOR, CONNECTOR = (
    StageInterface.GENERATOR,
    StageInterface.PROPAGATOR,
    StageInterface.CONNECTOR,
)
Scene = PlanningScene | None


class Container(TaskStage):
    """A stage that consists of others.

    Args:
        name: see `TaskStage`.
        stages: the others.

    Raises:
        PlanningError: they cannot be put together.
    """

    def __init__(self, name: str, stages: Sequence[TaskStage]) -> None:
        super().__init__(name)
        self._stages = tuple(stages)
        if not self._stages:
            raise NoPlanError(f"container '{name}' has no stage")

    @property
    def children(self) -> tuple[TaskStage, ...]:
        """The stages within it."""
        return self._stages


class SerialContainer(Container):
    """Stages one after the other.

    Solving begins at a generator, goes backwards over the stages before it and forwards over those
    after it. A connector stands between two such chains.
    """

    def __init__(self, name: str, stages: Sequence[TaskStage]) -> None:
        super().__init__(name, stages)
        self._check()

    @property
    def interface(self) -> StageInterface:
        """Those of its stages together."""
        kinds = {stage.interface for stage in self.children}
        return GENERATOR if GENERATOR in kinds else CONNECTOR if CONNECTOR in kinds else PROPAGATOR

    def _check(self) -> None:
        """Refuse stages between which nothing connects, or a connector that connects nothing."""
        kinds = [stage.interface for stage in self.children]
        marks = [kind for kind in kinds if kind is not PROPAGATOR]
        for first, second in pairwise(marks):
            if first is second:
                what = "generate" if first is GENERATOR else "connect"
                need = "a connector" if first is GENERATOR else "a generator"
                raise NoPlanError(
                    f"container '{self.name}': two stages in a row {what}; {need} belongs between"
                )
        if CONNECTOR in (marks[:1] + marks[-1:]) and len(kinds) > 1:
            name = self.children[kinds.index(CONNECTOR)].name
            raise NoPlanError(
                f"container '{self.name}': stage '{name}' connects; a generator belongs before "
                "and after it"
            )

    def _solutions(self, search: TaskSearch, start: Scene, end: Scene) -> Iterator[Solution]:
        if len(self.children) == 1:
            for only in self.children[0].solve(search, start, end):
                yield Solution.joined(self.name, [only])
            return
        if start is not None:
            ways = self._forwards(search, 0, start)
        elif end is not None:
            ways = self._backwards(search, len(self.children) - 1, 0, end)
        else:
            ways = self._from_generator(search, 0, None)
        for parts, _ in ways:
            yield Solution.joined(self.name, parts)

    def _from_generator(
        self, search: TaskSearch, first: int, start: Scene
    ) -> Iterator[tuple[list[Solution], TaskSearch]]:
        """Yield ways over the next generator; with a start, the first stage connects to it."""
        kinds = [stage.interface for stage in self.children]
        generator = kinds.index(GENERATOR, first)
        begin = first if start is None else first + 1
        for made in self.children[generator].solve(search, None, None):
            after = search.after(made)
            for before, known in self._backwards(after, generator - 1, begin, made.start):
                chain = [*before, made]
                for link in self._links(known, first, start, chain[0].start):
                    known = known.after(link[0]) if link else known
                    for rest, last in self._forwards(known, generator + 1, made.end):
                        yield [*link, *chain, *rest], last

    def _links(
        self, search: TaskSearch, index: int, start: Scene, end: PlanningScene
    ) -> Iterator[list[Solution]]:
        if start is None:
            yield []
            return
        for solution in self.children[index].solve(search, start, end):
            yield [solution]

    def _backwards(
        self, search: TaskSearch, index: int, first: int, end: PlanningScene
    ) -> Iterator[tuple[list[Solution], TaskSearch]]:
        """Yield ways over the stages first to index that end in a scene."""
        if index < first:
            yield [], search
            return
        for solution in self.children[index].solve(search, None, end):
            following = search.after(solution)
            for before, last in self._backwards(following, index - 1, first, solution.start):
                yield [*before, solution], last

    def _forwards(
        self, search: TaskSearch, index: int, start: PlanningScene
    ) -> Iterator[tuple[list[Solution], TaskSearch]]:
        """Yield ways over all stages from one on that begin in a scene."""
        if index == len(self.children):
            yield [], search
        elif self.children[index].interface is CONNECTOR:
            yield from self._from_generator(search, index, start)
        else:
            for solution in self.children[index].solve(search, start, None):
                following = search.after(solution)
                for rest, last in self._forwards(following, index + 1, solution.end):
                    yield [solution, *rest], last


class ParallelContainer(Container):
    """Stages that do the same in different ways, so all have the same interface."""

    def __init__(self, name: str, stages: Sequence[TaskStage]) -> None:
        super().__init__(name, stages)
        for stage in self.children:
            if stage.interface is not self.interface:
                raise NoPlanError(
                    f"container '{name}': stage '{self.children[0].name}' needs "
                    f"{self.interface.value}, stage '{stage.name}' {stage.interface.value}"
                )

    @property
    def interface(self) -> StageInterface:
        """That of each of its stages."""
        return self.children[0].interface


class Alternatives(ParallelContainer):
    """All solutions of all stages, the cheapest first."""

    def _solutions(self, search: TaskSearch, start: Scene, end: Scene) -> Iterator[Solution]:
        found: list[Solution] = []
        try:
            for stage in self.children:
                found.extend(stage.solve(search, start, end))
        except OutOfTimeError:
            if not found:
                raise
        for solution in sorted(found, key=lambda each: each.cost):
            yield Solution.joined(self.name, [solution])


class Fallbacks(ParallelContainer):
    """The solutions of the first stage that has one."""

    def _solutions(self, search: TaskSearch, start: Scene, end: Scene) -> Iterator[Solution]:
        for stage in self.children:
            is_solved = False
            for solution in stage.solve(search, start, end):
                is_solved = True
                yield Solution.joined(self.name, [solution])
            if is_solved:
                return
