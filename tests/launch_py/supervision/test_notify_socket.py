"""Notifications in systemd's protocol."""

import os
import socket
import subprocess
import sys

import pytest

from launch_py.supervision.session import NotifySocket

SEND = (
    "import os, socket; s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM); "
    "s.sendto(b'READY=1\\nSTATUS=all = well', os.environ['NOTIFY_SOCKET'].replace('@', '\\0', 1))"
)


@pytest.fixture
def received():
    return []


@pytest.fixture
def notify(received):
    notify = NotifySocket(lambda pid, fields: received.append((pid, fields)))
    yield notify
    notify.close()


def test_a_message_has_its_sender(notify, received):
    environment = {**os.environ, "NOTIFY_SOCKET": notify.address}
    with subprocess.Popen([sys.executable, "-c", SEND], env=environment) as child:
        assert child.wait() == 0
    notify.receive()
    assert received == [(child.pid, {"READY": "1", "STATUS": "all = well"})]


def test_nothing_to_receive_is_not_an_error(notify, received):
    notify.receive()
    assert received == []


def test_malformed_messages_are_not_an_error(notify, received):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.sendto(b"\xff\xfe\n\n=", notify.address.replace("@", "\0", 1))
    notify.receive()
    assert received[0][0] == os.getpid()
