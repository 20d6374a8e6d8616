"""Services of move_group answer whatever happens."""

import re
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from moveit_msgs.srv import (
    ApplyPlanningScene,
    GetGroupUrdf,
    GetMotionPlan,
    GetMotionSequence,
    GetPositionIK,
)

import arm_planning
from arm_planning.ros.answering import BusyLimit, offer_service

FAILURE = 99999


class FakeNode:
    """Keeps the callbacks of its services."""

    def __init__(self) -> None:
        self.services: dict[str, Callable[[Any, Any], Any]] = {}

    def create_service(self, _kind: type, name: str, answer: Any, **_options: Any) -> None:
        self.services[name] = answer


def breaks(_request: Any, _response: Any) -> Any:
    raise KeyError("link7")


def answer_of(kind: Any, serve: Callable[[Any, Any], Any], limit: BusyLimit | None = None) -> Any:
    node = FakeNode()
    offer_service(node, kind, "the_service", serve, limit=limit)
    return node.services["the_service"](kind.Request(), kind.Response())


@pytest.mark.parametrize(
    ("kind", "holder"),
    [
        (GetPositionIK, ""),
        (GetGroupUrdf, ""),
        (GetMotionPlan, "motion_plan_response"),
        (GetMotionSequence, "response"),
    ],
)
def test_a_fault_is_answered_with_failure_and_its_reason(kind, holder):
    answer = answer_of(kind, breaks)
    code = (getattr(answer, holder) if holder else answer).error_code
    assert code.val == FAILURE
    assert code.message == "the_service has a fault, please report it: KeyError: 'link7'"


def test_an_answer_without_a_code_says_after_a_fault_that_nothing_succeeded():
    assert answer_of(ApplyPlanningScene, breaks).success is False


def test_a_request_beyond_the_limit_is_refused_until_another_has_ended():
    limit, refused = BusyLimit(1), []

    def serve(_request: Any, response: Any) -> Any:
        thread = threading.Thread(
            target=lambda: refused.append(answer_of(GetPositionIK, breaks, limit))
        )
        thread.start()
        thread.join()
        return response

    for _ in range(2):
        assert answer_of(GetPositionIK, serve, limit).error_code.val == 0
    assert {each.error_code.message for each in refused} == {
        "the_service: 1 other requests are being served; ask again later"
    }


def test_services_and_actions_are_made_in_one_place_each():
    folder = Path(arm_planning.__file__).parent
    made = {
        (path.name, word)
        for path in folder.rglob("*.py")
        for word in re.findall(r"create_service\(|\bActionServer\(", path.read_text())
    }
    assert made == {("answering.py", "create_service("), ("goals.py", "ActionServer(")}
