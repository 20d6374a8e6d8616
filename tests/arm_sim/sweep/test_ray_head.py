"""Addresses where no Ray cluster is, and a head that goes."""

import socket
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from arm_sim.sweep import ray_head
from arm_sim.sweep.ray_head import PATIENCE_S, HeadWatch, check_address
from arm_sim.sweep.study import StudyError


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


def address_of(server: socket.socket) -> str:
    return f"127.0.0.1:{server.getsockname()[1]}"


def answering_as_grpc(server: socket.socket) -> threading.Thread:
    """Answer one connection with empty settings, as a gRPC server does."""

    def answer() -> None:
        connection, _ = server.accept()
        with connection:
            connection.recv(100)
            connection.sendall(bytes((0, 0, 0, 4, 0, 0, 0, 0, 0)))

    thread = threading.Thread(target=answer)
    thread.start()
    return thread


@pytest.mark.parametrize(
    "address", ["", "nowhere", "host:", ":1", "host:port", "host:70000", "ray://host:10001"]
)
def test_what_is_not_an_address_is_a_sentence(address):
    with pytest.raises(StudyError, match=f"'{address}' is not the address of a Ray cluster"):
        check_address(address)


def test_where_nothing_listens_there_is_no_cluster(listener):
    address = address_of(listener)
    listener.close()
    with pytest.raises(StudyError, match=f"no Ray cluster listens at {address}: Connection refus"):
        check_address(address)


def test_a_host_that_does_not_exist_has_no_cluster():
    with pytest.raises(StudyError, match=r"no Ray cluster listens at nowhere\.invalid:6379: "):
        check_address("nowhere.invalid:6379")


def test_what_listens_and_says_nothing_is_no_cluster(listener, monkeypatch):
    monkeypatch.setattr(ray_head, "CONNECT_S", 0.1)
    with pytest.raises(StudyError, match=r"no Ray cluster answers at .* within 0.1 s"):
        check_address(address_of(listener))


def test_a_web_server_is_no_cluster():
    with HTTPServer(("127.0.0.1", 0), BaseHTTPRequestHandler) as server:
        thread = threading.Thread(target=server.handle_request)
        thread.start()
        with pytest.raises(StudyError, match="is not the head of a Ray cluster"):
            check_address(address_of(server.socket))
        thread.join()


def test_a_server_of_grpc_may_be_a_head(listener):
    thread = answering_as_grpc(listener)
    assert check_address(address_of(listener)) is None
    thread.join()


def test_a_head_has_gone_when_it_has_been_silent_for_a_while(listener):
    now_s = [0.0]
    watch = HeadWatch(address_of(listener), clock=lambda: now_s[0])
    thread = answering_as_grpc(listener)
    now_s[0] = 10.0
    assert watch.answers()
    thread.join()
    listener.close()
    # It does not look again so soon.
    assert watch.answers()
    assert not watch.answers(looks_now=True)
    now_s[0] = 9.0 + PATIENCE_S
    watch.check()
    now_s[0] = 10.0 + PATIENCE_S
    with pytest.raises(StudyError, match="has not answered for 20 s; the same command goes on"):
        watch.check()
