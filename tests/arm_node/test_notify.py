"""The supervisor hears of readiness through NOTIFY_SOCKET."""

import socket

import pytest

from arm_node.notify import notify


def test_a_message_reaches_the_socket(tmp_path):
    path = str(tmp_path / "notify")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as supervisor:
        supervisor.bind(path)
        supervisor.settimeout(10.0)
        notify("READY=1", {"NOTIFY_SOCKET": path})
        assert supervisor.recv(100) == b"READY=1"


def test_an_abstract_address_works():
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as supervisor:
        supervisor.bind("")
        supervisor.settimeout(10.0)
        name = supervisor.getsockname()
        notify("STATUS=1.00 x", {"NOTIFY_SOCKET": "@" + name[1:].decode()})
        assert supervisor.recv(100) == b"STATUS=1.00 x"


@pytest.mark.parametrize("environment", [{}, {"NOTIFY_SOCKET": "/no/such/socket"}])
def test_nobody_listening_is_no_failure(environment):
    notify("READY=1", environment)
