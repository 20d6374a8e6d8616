"""Planners by the ids of requests."""

import importlib.util

import pytest

from arm_planning.errors import PlanningError
from arm_planning.planners.registry import (
    checked_parameter,
    planner_for,
    planner_ids,
    planner_parameters,
)
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


def test_a_range_limits_the_moves_of_the_own_planner():
    assert planner_for("RRTConnectkConfigDefault", {"range": 0.5}) == RrtConnectPlanner(0.5)
    assert planner_for("", {"range": 0.0}) == planner_for("")


def test_the_parameters_of_a_planner_are_told():
    assert planner_parameters("RRTConnectkConfigDefault") == {"range": 0.0}


@pytest.mark.parametrize(
    ("planner_id", "name", "text", "sentence"),
    [
        ("", "rnage", "1", "the planner RRTConnect has no parameter 'rnage'; did you mean 'range'"),
        ("", "range", "far", "range is 'far'; it is a number from 0"),
        ("", "range", "nan", "range is 'nan'"),
        ("", "range", "inf", "range is 'inf'"),
        ("", "range", "-1", "range is '-1'"),
        ("Dijkstra", "range", "1", "no planner 'Dijkstra'"),
    ],
)
def test_a_parameter_that_cannot_be_set_is_refused(planner_id, name, text, sentence):
    with pytest.raises(PlanningError, match=sentence):
        checked_parameter(planner_id, name, text)
