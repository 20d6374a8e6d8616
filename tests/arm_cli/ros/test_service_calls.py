"""Verbs that call services: their requests, and their output if a node does not answer."""

import argparse
from contextlib import contextmanager
from types import SimpleNamespace

import pytest
from builtin_interfaces.msg import Time
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState

from arm_cli import lifecycle, service
from arm_cli.errors import UnansweredError
from arm_cli.ros import graph, service_call
from arm_cli.ros.graph import NodeName


def parsed(verb, *words):
    parser = argparse.ArgumentParser()
    verb.add_arguments(parser)
    return parser.parse_args(words)


class Stop(Exception):
    """Ends a verb that calls repeatedly."""


class Session:
    """A fake node whose clock advances by a second with every call."""

    srv_name = "/x"

    def __init__(self) -> None:
        self.node = self
        self.sent: list[Time] = []
        self.known_to: list[str] = []

    def full_name(self, name):
        return name

    def create_client(self, *_):
        return self

    def service_is_ready(self):
        return True

    def get_clock(self):
        return self

    def now(self):
        return SimpleNamespace(to_msg=lambda: Time(sec=7 + len(self.sent)))

    def be_known_to_server(self, service):
        self.known_to.append(service)

    def call_async(self, request):
        assert self.known_to == [self.srv_name]
        self.sent.append(request.time)

    def answer(self, *_):
        return "an answer"

    def spin_for(self, _):
        if len(self.sent) == 2:
            raise Stop


def test_now_in_a_request_is_the_time_of_each_call(monkeypatch):
    session = Session()

    @contextmanager
    def connect():
        yield session

    monkeypatch.setattr(service, "connect", connect)
    there = SimpleNamespace(wait_for_server=lambda *_: None)
    monkeypatch.setattr(graph, "Graph", lambda _session: there)
    words = ["/x", "control_msgs/srv/QueryTrajectoryState", "time: now", "-r", "9"]
    with pytest.raises(Stop):
        service.call.run(parsed(service.call, *words))
    assert session.sent == [Time(sec=7), Time(sec=8)]


@pytest.fixture
def two_nodes(monkeypatch):
    """A node that does not answer, and one that does."""

    @contextmanager
    def connect():
        yield None

    def answer(_session, _class, name, _request):
        if name.startswith("/stuck"):
            raise UnansweredError(f"no answer from {name}")
        return GetState.Response(current_state=State(id=3, label="active"))

    nodes = [NodeName("/", "stuck"), NodeName("/", "well")]
    monkeypatch.setattr(lifecycle, "connect", connect)
    monkeypatch.setattr(lifecycle, "managed_node", lambda _graph, name: NodeName("/", name))
    monkeypatch.setattr(lifecycle, "managed_nodes", lambda _graph, _hidden: nodes)
    monkeypatch.setattr(graph, "Graph", lambda session: session)
    monkeypatch.setattr(service_call, "call_service", answer)


@pytest.mark.usefixtures("two_nodes")
def test_a_silent_node_does_not_hide_the_other_nodes_states(capsys):
    lifecycle.get.run(parsed(lifecycle.get))
    printed = capsys.readouterr()
    assert printed.out == "/well: active [3]\n"
    assert printed.err == "arm lifecycle get: no answer from /stuck/get_state\n"


@pytest.mark.usefixtures("two_nodes")
def test_a_named_node_must_answer():
    with pytest.raises(UnansweredError, match="no answer from /stuck/get_state"):
        lifecycle.get.run(parsed(lifecycle.get, "stuck"))
