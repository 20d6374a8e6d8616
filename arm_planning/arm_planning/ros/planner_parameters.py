"""The parameters of planners that get_planner_params and set_planner_params are about."""

import logging
import threading
from collections.abc import Mapping
from typing import Any

from moveit_msgs.msg import PlannerParams
from moveit_msgs.srv import GetPlannerParams, SetPlannerParams
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import InvalidRequestError, PlanningError
from arm_planning.planner import OMPL, planner_of
from arm_planning.planners.registry import checked_parameter, planner_name, planner_parameters
from arm_planning.request import PlanRequest
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.answering import offer_service

LOGGER = logging.getLogger("move_group")


class PlannerParameters:
    """What is set of each planner, for all groups or for one. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._set: dict[tuple[str, str], dict[str, float]] = {}

    def of(self, planner_id: str, group: str) -> dict[str, float]:
        """Return what is set of a planner for a group: what is the group's own goes before."""
        name = planner_name(planner_id)
        with self._lock:
            return {**self._set.get((name, ""), {}), **self._set.get((name, group), {})}

    def change(
        self, planner_id: str, group: str, values: Mapping[str, str], *, replaces: bool
    ) -> None:
        """Set parameters of a planner, named as in a request, for a group, or for all with "".

        With `replaces`, those that are not given have their defaults again.

        Raises:
            PlanningError: a planner or parameter does not exist, or a value is none for it;
                nothing is set.
        """
        checked = {name: checked_parameter(planner_id, name, text) for name, text in values.items()}
        planner_parameters(planner_id)
        key = planner_name(planner_id), group
        with self._lock:
            before = {} if replaces else self._set.get(key, {})
            self._set[key] = {**before, **checked}


class PlannerParameterServices:
    """Serves get_planner_params and set_planner_params; their answers have no error code."""

    def __init__(self, node: Node, parameters: PlannerParameters, model: PlanningModel) -> None:
        self._parameters, self._model = parameters, model
        group = ReentrantCallbackGroup()
        offer_service(node, GetPlannerParams, "get_planner_params", self._get, group=group)
        offer_service(node, SetPlannerParams, "set_planner_params", self._set, group=group)

    def _get(self, request: Any, answer: GetPlannerParams.Response) -> GetPlannerParams.Response:
        planner = self._planner(request)
        values = {**planner_parameters(planner), **self._parameters.of(planner, request.group)}
        answer.params = PlannerParams(
            keys=list(values), values=[f"{value:g}" for value in values.values()]
        )
        return answer

    def _set(self, request: Any, answer: SetPlannerParams.Response) -> SetPlannerParams.Response:
        keys, values = list(request.params.keys), list(request.params.values)
        try:
            planner = self._planner(request)
            if len(keys) != len(values):
                raise InvalidRequestError(f"there are {len(keys)} keys and {len(values)} values")
            given = dict(zip(keys, values, strict=True))
            self._parameters.change(planner, request.group, given, replaces=request.replace)
        except PlanningError as error:
            LOGGER.error("set_planner_params: %s; nothing is set", error)
        return answer

    def _planner(self, request: Any) -> str:
        """Return the id of the planner without the group that RViz puts around it."""
        if request.pipeline_id not in ("", OMPL):
            raise InvalidRequestError(
                f"the pipeline '{request.pipeline_id}' has no planner with parameters; '{OMPL}' has"
            )
        if request.group:
            self._model.group(request.group)
        return planner_of(PlanRequest(request.group, (), planner=request.planner_config))
