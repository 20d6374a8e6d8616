"""Containers, with stages that plan nothing."""

from itertools import count

import pytest

from arm_planning.errors import MoveItErrorCode, NoPlanError, PlanningError
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.containers import Alternatives, Fallbacks, SerialContainer
from arm_planning.tasks.solution import Solution
from arm_planning.tasks.stage import StageInterface, TaskStage
from arm_planning.tasks.task import StagedTask

STEP = 1.0


def scene(q: float) -> PlanningScene:
    return PlanningScene({"q": q})


class Made(TaskStage):
    """Generates a scene for each number."""

    interface = StageInterface.GENERATOR

    def __init__(self, name: str, *numbers: float) -> None:
        super().__init__(name)
        self.numbers = numbers

    def _solutions(self, search, start, end):
        for q in self.numbers:
            yield Solution(self.name, scene(q), scene(q), q)


class Stepped(TaskStage):
    """Goes on by 1 at some cost, or back by 1, unless that leads above a limit."""

    interface = StageInterface.PROPAGATOR

    def __init__(self, name: str, cost: float = 0.0, limit: float = 1e9) -> None:
        super().__init__(name)
        self.cost, self.limit = cost, limit

    def _solutions(self, search, start, end):
        if end is not None:
            yield Solution(self.name, scene(end.positions["q"] - STEP), end, self.cost)
            return
        q = start.positions["q"] + STEP
        if q > self.limit:
            raise NoPlanError(f"{q:g} is above {self.limit:g}")
        yield Solution(self.name, start, scene(q), self.cost)


class Joined(TaskStage):
    """Connects any two scenes."""

    interface = StageInterface.CONNECTOR

    def _solutions(self, search, start, end):
        yield Solution(self.name, start, end)


def plan(*stages: TaskStage, most: int = 100) -> list[list[tuple[str, float, float]]]:
    found = StagedTask("task", stages).plan(None, max_solutions=most)
    return [
        [(s.stage, s.start.positions["q"], s.end.positions["q"]) for s in each.steps]
        for each in found
    ]


def test_stages_before_a_generator_go_backwards_and_those_after_it_forwards():
    assert plan(Stepped("a"), Made("b", 5.0), Stepped("c")) == [
        [("a", 4.0, 5.0), ("b", 5.0, 5.0), ("c", 5.0, 6.0)]
    ]


def test_a_connector_meets_what_leads_to_the_next_generator():
    inner = SerialContainer("inner", [Stepped("back"), Made("grasp", 9.0), Stepped("on")])
    found = plan(Made("now", 0.0), Stepped("a"), Joined("connect"), inner, Stepped("end"))
    assert found == [
        [
            ("now", 0.0, 0.0),
            ("a", 0.0, 1.0),
            ("connect", 1.0, 8.0),
            ("back", 8.0, 9.0),
            ("grasp", 9.0, 9.0),
            ("on", 9.0, 10.0),
            ("end", 10.0, 11.0),
        ]
    ]


def test_all_solutions_of_all_stages_are_combined_the_cheapest_first():
    stages = Made("now", 3.0, 1.0), Joined("connect"), Made("there", 20.0, 10.0)
    assert [each[-1][1] + each[0][1] for each in plan(*stages)] == [11.0, 13.0, 21.0, 23.0]
    assert len(plan(*stages, most=3)) == 3


def test_alternatives_begin_with_the_cheapest():
    either = Alternatives("either", [Stepped("dear", 2.0), Stepped("cheap", 1.0)])
    assert [each[1][0] for each in plan(Made("now", 0.0), either)] == ["cheap", "dear"]
    assert [each[1][0] for each in plan(Made("now", 0.0), either, most=1)] == ["cheap"]


def test_fallbacks_take_the_first_stage_that_works_and_keep_why_others_do_not():
    first, second = Stepped("first", limit=1.0), Stepped("second", limit=2.0)
    fallbacks = Fallbacks("fallbacks", [first, second, Stepped("third")])
    found = plan(Made("now", 0.0, 1.0), fallbacks)
    assert sorted(each[1][0] for each in found) == ["first", "second"]
    assert first.failures == {"2 is above 1": 1}


def test_a_solution_is_looked_into_by_the_names_of_stages():
    inner = SerialContainer("inner", [Stepped("a", 2.0), Stepped("b", 3.0)])
    (found,) = StagedTask("task", [Made("now", 1.0), inner]).plan(None)
    assert found.cost == 6.0
    assert found.named("inner").cost == 5.0
    assert found.named("b").end.positions == {"q": 3.0}
    with pytest.raises(KeyError):
        found.named("c")


def test_the_stage_that_stands_in_the_way_is_named_with_its_most_frequent_reason():
    stages = Made("now", 1.0, 1.0, 2.0), Stepped("a"), Stepped("b", limit=2.0), Stepped("c")
    task = StagedTask("task", stages)
    with pytest.raises(PlanningError, match=r"stage 'b' has no solution in 2 of 3 failures: 3 is"):
        task.plan(None)
    assert task.report().splitlines() == [
        "task: 0 solved, 0 failed",
        "  now: 3 solved, 0 failed",
        "  a: 3 solved, 0 failed",
        "  b: 0 solved, 3 failed",
        "    2 x 3 is above 2",
        "    1 x 4 is above 2",
        "  c: 0 solved, 0 failed",
    ]


def test_a_second_plan_forgets_the_first():
    task = StagedTask("task", [Made("now", 1.0), Stepped("a")])
    task.plan(None)
    task.plan(None)
    assert task.report().splitlines()[-1] == "  a: 1 solved, 0 failed"


def test_an_interrupted_search_returns_what_it_has():
    asked = count()
    stages = Made("now", *map(float, range(1000))), Stepped("a")
    found = StagedTask("task", stages).plan(
        None, max_solutions=1000, interrupted=lambda: next(asked) > 20
    )
    assert 0 < len(found) < 1000
    with pytest.raises(PlanningError, match="interrupted while planning the task") as caught:
        StagedTask("task", stages).plan(None, interrupted=lambda: True)
    assert caught.value.code is MoveItErrorCode.PREEMPTED


@pytest.mark.parametrize(
    ("build", "match"),
    [
        (lambda: StagedTask("t", []), "container 't' has no stage"),
        (lambda: StagedTask("t", [Made("a"), Made("b")]), "generate; a connector belongs between"),
        (
            lambda: StagedTask("t", [Made("a"), Joined("b"), Joined("c"), Made("d")]),
            "connect; a generator belongs between",
        ),
        (
            lambda: StagedTask("t", [Made("a"), Joined("b")]),
            "stage 'b' connects; a generator belongs",
        ),
        (lambda: StagedTask("t", [Stepped("a")]).plan(None), "no stage that begins"),
        (
            lambda: Fallbacks("f", [Made("a"), Stepped("b")]),
            "'a' needs neither scene, stage 'b' one scene",
        ),
    ],
)
def test_stages_that_cannot_be_put_together_are_refused(build, match):
    with pytest.raises(PlanningError, match=match):
        build()
