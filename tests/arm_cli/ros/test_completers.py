"""What Tab offers, from a graph that others join while it looks."""

import argparse
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from arm_cli.ros import completers, connection, graph, parameters
from arm_node.graph_names import GraphNames


class FakeNode:
    """A node that discovers one other node after a while."""

    def __init__(self, now_s, found_s: float) -> None:
        self._is_found = lambda: now_s() >= found_s

    def get_name(self) -> str:
        return "_arm_cli"

    def get_topic_names_and_types(self):
        return [("/chatter", ["std_msgs/msg/String"])] if self._is_found() else []

    def get_publishers_info_by_topic(self, _topic):
        return [SimpleNamespace(node_namespace="/", node_name="talker")] if self._is_found() else []

    def get_subscriptions_info_by_topic(self, _topic):
        return []

    def get_service_names_and_types(self):
        return []

    def get_node_names_and_namespaces(self):
        own = [("_arm_cli", "/")]
        return [*own, ("talker", "/")] if self._is_found() else own


class FakeSession:
    """A session whose waiting takes no time."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.started_s = 0.0
        self.node = FakeNode(lambda: self.now_s, found_s=0.3)

    def wait_until(self, condition) -> None:
        while not condition():
            self.now_s += 0.02


@pytest.fixture
def session(monkeypatch):
    session = FakeSession()

    @contextmanager
    def connect():
        yield session

    monkeypatch.setattr(connection, "connect", connect)
    monkeypatch.setattr(completers, "ask_for_names", lambda _environ: None)
    monkeypatch.setattr(graph.time, "monotonic", lambda: session.now_s)
    return session


def test_tab_waits_for_the_first_answer_of_the_others(session):
    assert completers.topics() == ["/chatter"]
    assert session.now_s < 0.5


def test_tab_offers_the_nodes_that_it_found(session):
    assert completers.nodes() == ["/talker"]


def test_tab_asks_for_parameters_before_it_knows_the_name_of_their_node(session, monkeypatch):
    calls = []

    def call_service(_session, _class, name, _request, server_timeout_s, answer_timeout_s):
        calls.append((name, server_timeout_s, answer_timeout_s))
        return SimpleNamespace(result=SimpleNamespace(names=["size", "flag"]))

    monkeypatch.setattr(parameters, "call_service", call_service)
    for typed in ("/arm/driver", "arm/driver"):
        typed_so_far = argparse.Namespace(node_name=typed)
        assert completers.parameters(typed_so_far) == ["flag", "size"]
    assert calls == [("/arm/driver/list_parameters", 1.0, 1.0)] * 2
    assert completers.parameters(argparse.Namespace(node_name="driver")) == ["flag", "size"]
    assert calls[-1][0] == "/driver/list_parameters"
    assert session.now_s == 0.0


def test_tab_needs_no_node_beside_a_robot(monkeypatch):
    told = GraphNames(
        topics=["/chatter", "/turn/_action/feedback"],
        services=["/turn/_action/send_goal", "/talker/get_parameters"],
        nodes=["/_arm_cli_7", "/talker"],
    )
    monkeypatch.setattr(completers, "ask_for_names", lambda _environ: told)
    monkeypatch.setattr(connection, "connect", None)
    assert completers.topics() == ["/chatter"]
    assert completers.services() == ["/talker/get_parameters"]
    assert completers.nodes() == ["/talker"]
    assert completers.actions() == ["/turn"]
    assert completers.parameters(argparse.Namespace(node_name="walker")) == []
