"""Readiness conditions that could never hold are refused before anything starts."""

import pytest

from launch_py import (
    ActionAvailable,
    ExecuteProcess,
    HttpOk,
    LogLine,
    Notified,
    ServiceAvailable,
    TopicPublished,
)
from launch_py.errors import LaunchFileError
from launch_py.ros import PushRosNamespace


def waiting_for(*conditions):
    return ExecuteProcess(cmd=["true"], name="p", ready=conditions)


def test_relative_names_are_resolved_in_the_namespace(expand):
    conditions = (TopicPublished("chat"), ServiceAvailable("/serve"), ActionAvailable("_a/move2"))
    plan = expand([PushRosNamespace("ns"), waiting_for(*conditions)])
    assert plan.processes[0].ready == (
        TopicPublished("/ns/chat"),
        ServiceAvailable("/serve"),
        ActionAvailable("/ns/_a/move2"),
    )


@pytest.mark.parametrize("condition", [TopicPublished, ServiceAvailable, ActionAvailable])
@pytest.mark.parametrize("name", ["a b", "", "/", "2a", "~/a", "a//b", "a__b", "ä", "a\n"])
def test_an_invalid_graph_name_is_refused(expand, condition, name):
    with pytest.raises(LaunchFileError, match="is not a valid name of a topic, service or action"):
        expand([waiting_for(condition(name))])


@pytest.mark.parametrize("url", ["localhost:8080", "", "file:///etc/hostname"])
def test_an_invalid_url_is_refused(expand, url):
    with pytest.raises(LaunchFileError, match="begins with http:// or https://"):
        expand([waiting_for(HttpOk(url))])


@pytest.mark.parametrize("timeout_s", [-1, float("nan"), "5", None, True])
@pytest.mark.parametrize(
    "condition", [Notified, lambda timeout_s: LogLine("x", timeout_s=timeout_s)]
)
def test_a_timeout_that_is_not_a_number_is_refused(condition, timeout_s):
    with pytest.raises(
        LaunchFileError, match=r"timeout_s of a (Notified|LogLine) is .*not a number of seconds"
    ):
        condition(timeout_s=timeout_s)


def test_an_invalid_pattern_is_refused():
    with pytest.raises(LaunchFileError, match=r"LogLine\('\('\) is not a regular expression"):
        LogLine("(")
