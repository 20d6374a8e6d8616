"""What is set of planners, and the services about it."""

from collections.abc import Callable
from typing import Any

import pytest
from moveit_msgs.msg import PlannerParams
from moveit_msgs.srv import GetPlannerParams, SetPlannerParams
from planar_robot import planar_model

from arm_planning.ros.planner_parameters import PlannerParameters, PlannerParameterServices

RRT_CONNECT = "RRTConnectkConfigDefault"


class Services:
    """The services, called as rclpy does."""

    def __init__(self) -> None:
        self.parameters = PlannerParameters()
        self._answers: dict[str, Callable[[Any, Any], Any]] = {}
        PlannerParameterServices(self, self.parameters, planar_model())

    def create_service(self, _kind: type, name: str, answer: Any, **_options: Any) -> None:
        self._answers[name] = answer

    def set(self, *, replace: bool = False, **fields: Any) -> None:
        values = fields.pop("values", {})
        params = PlannerParams(keys=list(values), values=list(values.values()))
        request = SetPlannerParams.Request(params=params, replace=replace, **fields)
        self._answers["set_planner_params"](request, SetPlannerParams.Response())

    def get(self, **fields: Any) -> dict[str, str]:
        request = GetPlannerParams.Request(**fields)
        params = self._answers["get_planner_params"](request, GetPlannerParams.Response()).params
        return dict(zip(params.keys, params.values, strict=True))


@pytest.fixture
def services() -> Services:
    return Services()


def test_what_is_set_is_told_and_acts(services):
    assert services.get(pipeline_id="ompl", planner_config=RRT_CONNECT) == {"range": "0"}
    services.set(planner_config=RRT_CONNECT, values={"range": "0.5"})
    assert services.get(planner_config="RRTConnect", group="arm") == {"range": "0.5"}
    assert services.parameters.of("", "arm") == {"range": 0.5}


def test_what_is_set_for_a_group_goes_before(services):
    services.set(planner_config=RRT_CONNECT, values={"range": "0.5"})
    services.set(planner_config=f"arm[{RRT_CONNECT}]", group="arm", values={"range": "0.2"})
    assert services.parameters.of("RRTConnect", "arm") == {"range": 0.2}
    assert services.parameters.of("RRTConnect", "hand") == {"range": 0.5}


def test_replacing_gives_the_others_their_defaults_again(services):
    services.set(values={"range": "0.5"})
    services.set(values={}, replace=True)
    assert services.parameters.of("", "") == {}


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"values": {"range": "0.7", "size": "1"}}, "has no parameter 'size'"),
        ({"values": {"range": "wide"}}, "range is 'wide'"),
        ({"values": {"range": "0.7"}, "group": "leg"}, "no group 'leg'; the robot has arm"),
        ({"values": {"range": "0.7"}, "pipeline_id": "stomp"}, "the pipeline 'stomp' has no"),
        ({"planner_config": "Dijkstra"}, "no planner 'Dijkstra'"),
    ],
)
def test_what_cannot_be_set_is_logged_and_nothing_is_set(services, caplog, fields, sentence):
    services.set(**fields)
    assert sentence in caplog.text
    assert services.parameters.of("", "arm") == {}
