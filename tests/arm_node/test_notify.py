"""The supervisor is notified of readiness through NOTIFY_SOCKET."""

import socket

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


def test_what_is_sent_before_anybody_listens_is_dropped(tmp_path):
    environment = {"NOTIFY_SOCKET": str(tmp_path / "notify")}
    notify("READY=1", environment)
    notify("READY=1", {})
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as supervisor:
        supervisor.bind(environment["NOTIFY_SOCKET"])
        supervisor.settimeout(10.0)
        notify("STOPPING=1", environment)
        assert supervisor.recv(100) == b"STOPPING=1"
