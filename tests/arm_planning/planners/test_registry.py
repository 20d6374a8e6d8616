"""Planners by the ids of requests."""

import importlib.util

import pytest

from arm_planning.errors import PlanningError
from arm_planning.planners.registry import planner_for, planner_ids
from arm_planning.planners.search import RrtConnectPlanner


@pytest.mark.parametrize(
    "planner_id", ["", "RRTConnect", "RRTConnectkConfigDefault", "geometric::RRTConnect"]
)
def test_the_default_has_several_names(planner_id):
    assert isinstance(planner_for(planner_id), RrtConnectPlanner)


def test_an_unknown_planner_is_refused_with_those_that_exist():
    with pytest.raises(PlanningError, match=r"no planner 'Dijkstra'; there is .*RRTConnect"):
        planner_for("Dijkstra")


def test_a_misspelt_planner_names_the_nearest():
    with pytest.raises(PlanningError, match="did you mean 'RRTConnect'"):
        planner_for("RRTConectkConfigDefault")


def test_without_ompl_there_is_the_own_planner_and_a_hint(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert planner_ids() == ("RRTConnect",)
    with pytest.raises(PlanningError, match=r"pip install 'arm-suite\[ompl\]'"):
        planner_for("KPIECE1")
