from types import SimpleNamespace

import pytest
from rclpy.task import Future

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.execution import ControllerKind, TrajectoryController
from arm_planning.ros import controller_list
from arm_planning.ros.controller_list import ControllerList

SERVICE = "/left/controller_manager/list_controllers"
ARM = TrajectoryController("arm", "follow", ControllerKind.FOLLOW_JOINT_TRAJECTORY, ("j",))


def node(*, has_server: bool) -> SimpleNamespace:
    """A node whose controller manager never answers."""
    client = SimpleNamespace(
        service_name=SERVICE,
        wait_for_service=lambda _timeout_s: has_server,
        call_async=lambda _request: Future(),
    )
    return SimpleNamespace(create_client=lambda *_, **__: client)


@pytest.mark.parametrize(
    ("has_server", "reason"),
    [
        (False, f"{SERVICE} has no server: does the robot, or its simulation, run?"),
        (True, f"{SERVICE} did not answer within 0.01 s"),
    ],
)
def test_a_silent_controller_manager_is_the_reason_that_nothing_moves(
    monkeypatch, has_server, reason
):
    monkeypatch.setattr(controller_list, "TIMEOUT_S", 0.01)
    with pytest.raises(PlanningError) as refused:
        ControllerList(node(has_server=has_server), ()).available()
    assert str(refused.value) == f"nobody says which controllers can move the robot: {reason}"
    assert refused.value.code is MoveItErrorCode.CONTROL_FAILED


def test_configured_controllers_need_no_manager():
    assert ControllerList(node(has_server=False), [ARM]).available() == [ARM]
