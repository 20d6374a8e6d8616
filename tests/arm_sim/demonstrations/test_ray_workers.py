"""A demonstration that a Ray cluster makes, without one."""

from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import pytest

from arm_gazebo.state.made_with import made_with
from arm_sim.demonstrations import DemonstrationError, ray_workers
from arm_sim.demonstrations.ray_workers import ShownThere
from arm_sim.sweep.study import StudyError


def awaited(answer: "Future[Any]", problem: str = "") -> ShownThere:
    def check() -> None:
        if problem:
            raise StudyError(problem)

    reference, head = SimpleNamespace(future=lambda: answer), SimpleNamespace(check=check)
    return ShownThere(reference, head)  # pyright: ignore[reportArgumentType]


def test_it_is_what_the_process_has_made_with_the_same_versions():
    answer: Future[Any] = Future()
    answer.set_result(("10.0.0.2", made_with(), "shown"))
    assert awaited(answer).result() == "shown"


def test_another_version_there_is_a_sentence():
    answer: Future[Any] = Future()
    answer.set_result(("10.0.0.2", {**made_with(), "numpy": "1.0"}, "shown"))
    with pytest.raises(StudyError, match=r"10\.0\.0\.2 of the Ray .* other versions: numpy 1\.0"):
        awaited(answer).result()


def test_a_process_that_is_lost_is_a_sentence():
    answer: Future[Any] = Future()
    answer.set_exception(ray_workers.RayError("The node died"))
    with pytest.raises(DemonstrationError, match="a process of the Ray cluster was lost: The "):
        awaited(answer).result()


def test_a_head_that_has_gone_ends_the_wait():
    with pytest.raises(StudyError, match="the head has gone"):
        awaited(Future(), "the head has gone").result()
