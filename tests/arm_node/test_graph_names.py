"""A process tells this user's other processes the names that its node has discovered."""

import json
import os
import socket
import threading
from contextlib import contextmanager, suppress

import pytest

from arm_node import graph_names
from arm_node.graph_names import GraphNames, ask_for_names, telling_names
from arm_node.ros_domain import DOMAINS

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


class FakeNode:
    """A node that has discovered a talker with an action."""

    def get_topic_names_and_types(self):
        return [("/chatter", ["String"]), ("/turn/_action/feedback", ["Turn_FeedbackMessage"])]

    def get_service_names_and_types(self):
        return [("/talker/get_parameters", ["GetParameters"])]

    def get_node_names_and_namespaces(self):
        return [("talker", "/"), ("twin", "/left"), ("twin", "/left"), ("_hidden", "/")]


@pytest.fixture
def domain(monkeypatch):
    """A domain that no process uses: the tests of this module make no participant."""
    domain = str(DOMAINS[-1] + 1 + os.getpid() % 100)
    for name in (RANGE, "ROS_STATIC_PEERS", "FASTRTPS_DEFAULT_PROFILES_FILE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("ROS_DOMAIN_ID", domain)
    monkeypatch.setattr(graph_names, "LISTEN_AFTER_S", 0.0)
    return domain


def answer(environ) -> GraphNames | None:
    """Ask until the process listens; it may take a moment to start its thread."""
    for _ in range(100):
        known = ask_for_names(environ)
        if known is not None:
            return known
        threading.Event().wait(0.01)
    return None


@contextmanager
def impostor(serve):
    """Another process's socket in the domain; `serve` gets each connection."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as server:
        server.bind(f"\0{graph_names._socket_name(os.environ)}")
        server.listen()

        def accept():
            # The caller may have gone, or there was none until the end.
            with suppress(OSError), server.accept()[0] as connection:
                serve(connection)

        thread = threading.Thread(target=accept, daemon=True)
        thread.start()
        yield
        server.shutdown(socket.SHUT_RDWR)
        thread.join()


def test_names_are_told_until_the_end(domain):
    with telling_names(FakeNode()):
        assert answer({"ROS_DOMAIN_ID": domain}) == GraphNames(
            topics=["/chatter", "/turn/_action/feedback"],
            services=["/talker/get_parameters"],
            nodes=["/_hidden", "/left/twin", "/talker"],
        )
    assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None


def test_actions_are_known_by_their_feedback(domain):
    with telling_names(FakeNode()):
        known = answer({"ROS_DOMAIN_ID": domain})
    assert known is not None
    assert known.actions == ["/turn"]


def test_a_process_that_ends_before_it_listens_does_not_wait(domain, monkeypatch):
    monkeypatch.setattr(graph_names, "LISTEN_AFTER_S", 3600.0)
    with telling_names(FakeNode()):
        assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None


def test_a_process_that_cannot_listen_goes_on_and_says_so(domain, monkeypatch, caplog):
    caplog.set_level("INFO")
    monkeypatch.setattr(graph_names, "_socket_name", lambda _: "too long" * 20)
    with telling_names(FakeNode()):
        assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None
    (message,) = caplog.messages
    assert message.startswith("Tab discovers the names of the graph itself: ")


def test_another_domain_has_other_names(domain):
    with telling_names(FakeNode()):
        assert answer({"ROS_DOMAIN_ID": domain}) is not None
        assert ask_for_names({"ROS_DOMAIN_ID": str(int(domain) + 1)}) is None
        assert ask_for_names({}) is None


@pytest.mark.parametrize(
    ("theirs", "mine", "told"),
    [
        ({RANGE: "LOCALHOST"}, {}, True),
        ({RANGE: "LOCALHOST"}, {RANGE: "LOCALHOST"}, True),
        ({RANGE: "LOCALHOST"}, {RANGE: "SUBNET"}, False),
        ({}, {RANGE: "SUBNET"}, True),
        ({}, {RANGE: "LOCALHOST"}, False),
        ({"ROS_STATIC_PEERS": "192.0.2.1"}, {}, True),
        ({}, {"ROS_STATIC_PEERS": "192.0.2.1"}, False),
        ({"ROS_STATIC_PEERS": "192.0.2.1"}, {"ROS_STATIC_PEERS": "192.0.2.1"}, True),
    ],
)
def test_a_caller_with_a_range_of_its_own_wants_the_names_in_it(
    domain, monkeypatch, theirs, mine, told
):
    for name, value in theirs.items():
        monkeypatch.setenv(name, value)
    with telling_names(FakeNode()):
        assert answer({"ROS_DOMAIN_ID": domain}) is not None
        assert (ask_for_names({"ROS_DOMAIN_ID": domain, **mine}) is not None) is told


def test_a_process_that_its_profile_limits_to_this_host_has_that_range(
    domain, monkeypatch, tmp_path
):
    monkeypatch.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", str(tmp_path / "profile_localhost.xml"))
    monkeypatch.setenv(RANGE, "SYSTEM_DEFAULT")
    with telling_names(FakeNode()):
        assert answer({"ROS_DOMAIN_ID": domain, RANGE: "LOCALHOST"}) is not None


def test_another_user_is_told_nothing(domain, monkeypatch):
    with telling_names(FakeNode()):
        assert answer({"ROS_DOMAIN_ID": domain}) is not None
        monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
        prefix = graph_names._socket_prefix({"ROS_DOMAIN_ID": domain})
        names = graph_names._socket_names(graph_names.SOCKETS)
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
            client.connect(f"\0{next(name for name in names if name.startswith(prefix))}")
            assert client.recv(1) == b""


def test_another_user_is_not_believed(domain, monkeypatch):
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    said = json.dumps({"topics": ["/lie"], "services": [], "nodes": []}).encode()
    with impostor(lambda connection: connection.sendall(said)):
        assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None


@pytest.mark.parametrize("said", [b"", b"nonsense", b"[]", b'{"topics": []}', b"\xff"])
def test_a_wrong_answer_is_no_answer(domain, said):
    with impostor(lambda connection: connection.sendall(said)):
        assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None


def test_a_stopped_process_is_not_waited_for(domain):
    asked = threading.Event()
    with impostor(lambda _: asked.wait(30.0)):
        assert ask_for_names({"ROS_DOMAIN_ID": domain}) is None
        asked.set()


def test_the_next_process_is_asked_if_one_does_not_answer(domain):
    asked = threading.Event()
    with telling_names(FakeNode()), impostor(lambda _: asked.wait(30.0)):
        known = answer({"ROS_DOMAIN_ID": domain})
        asked.set()
    assert known is not None


def test_without_the_list_of_sockets_nobody_is_asked(domain, tmp_path):
    assert ask_for_names({"ROS_DOMAIN_ID": domain}, str(tmp_path / "none")) is None
