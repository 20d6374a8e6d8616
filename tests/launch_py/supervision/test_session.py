"""Notifications in systemd's protocol, and shared memory that programs create."""

import os
import socket
import subprocess
import sys

import pytest

from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.session import OBSERVE_DELAYS_S, NotifySocket, SegmentWatch

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


def run_once(loop):
    rounds = iter((False, True))
    loop.run(lambda: next(rounds))


@pytest.fixture
def looks(tmp_path):
    """Return a function that lets files appear at these times; it returns when looks were made."""

    def look_at(*appear_s):
        now_s, made_s = [0.0], []
        loop = EventLoop(lambda: now_s[0])
        SegmentWatch(loop, lambda: made_s.append(now_s[0]), str(tmp_path))

        def pass_to(end_s):
            while now_s[0] < end_s:
                now_s[0] = round(now_s[0] + 0.001, 3)
                loop.call_due_timers()

        for number, time_s in enumerate(appear_s):
            pass_to(time_s)
            (tmp_path / f"fastrtps_{number}").touch()
            run_once(loop)
        pass_to(appear_s[-1] + 1.0)
        loop.close()
        return made_s

    return look_at


def test_what_appears_is_looked_at_soon_and_again_later(looks):
    assert looks(0.0) == pytest.approx(OBSERVE_DELAYS_S, abs=0.002)


def test_what_appears_before_the_first_look_shares_it(looks):
    assert looks(0.0, 0.004, 0.01, 0.015) == pytest.approx(OBSERVE_DELAYS_S, abs=0.002)


def test_what_appears_after_the_first_look_has_looks_of_its_own(looks):
    own = [0.05 + delay_s for delay_s in OBSERVE_DELAYS_S]
    assert looks(0.0, 0.05) == pytest.approx(sorted([*OBSERVE_DELAYS_S, *own]), abs=0.002)
