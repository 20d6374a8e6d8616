"""Threads that are made while answers are held back run like all others afterwards."""

import os
import threading

import pytest
from run_python import run_python

from arm_node.workarounds import discovery
from arm_node.workarounds.discovery import first_node, prompt_discovery

pytestmark = pytest.mark.workaround("discovery")


def scheduling(thread: int) -> tuple[int, set[int]]:
    return os.sched_getscheduler(thread), os.sched_getaffinity(thread)


def test_a_thread_made_inside_cannot_preempt_its_maker():
    seen = []
    with prompt_discovery():
        thread = threading.Thread(target=lambda: seen.append(scheduling(0)))
        thread.start()
        thread.join()
        mine = scheduling(0)
    assert seen == [mine]
    assert mine[0] in (os.SCHED_RR, os.SCHED_BATCH)
    assert len(mine[1]) == 1


def test_without_privilege_batch_scheduling_does(monkeypatch):
    set_scheduler = os.sched_setscheduler

    def refuse_real_time(thread: int, policy: int, parameters: os.sched_param) -> None:
        if policy == os.SCHED_RR:
            raise PermissionError
        set_scheduler(thread, policy, parameters)

    monkeypatch.setattr(os, "sched_setscheduler", refuse_real_time)
    with prompt_discovery():
        assert os.sched_getscheduler(0) == os.SCHED_BATCH
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_every_thread_is_as_before_afterwards():
    before = scheduling(0)
    done = threading.Event()
    with prompt_discovery():
        thread = threading.Thread(target=done.wait)
        thread.start()
    assert scheduling(0) == before
    assert scheduling(thread.native_id) == before
    done.set()
    thread.join()


def test_a_process_with_another_scheduler_is_not_changed(monkeypatch):
    monkeypatch.setattr(os, "sched_getscheduler", lambda _: os.SCHED_FIFO)
    before = os.sched_getaffinity(0)
    with prompt_discovery():
        assert os.sched_getaffinity(0) == before


BUSY_THREAD = """
import hashlib, os, threading
from arm_node.workarounds import discovery
from arm_node.workarounds.discovery import first_node, prompt_discovery

def work():
    # Minutes of it, without Python's lock.
    hashlib.pbkdf2_hmac("sha256", b"", b"", 1_000_000_000)

with prompt_discovery():
    threading.Thread(target=work, daemon=True).start()
os.write(1, b"went on")
os._exit(0)
"""


def test_a_busy_thread_does_not_hold_up_its_maker():
    done = run_python("-c", BUSY_THREAD)
    assert done.stdout == "went on", done.stderr


PORT = "/dev/shm/fastrtps_port7411"


@pytest.mark.parametrize(
    ("losses", "made", "warned"),
    [([], 1, False), ([[PORT], []], 2, False), ([[PORT]] * 4, 5, False), ([[PORT]] * 9, 5, True)],
)
def test_a_process_whose_ports_are_always_lost_says_so(monkeypatch, caplog, losses, made, warned):
    losses = iter(losses)
    monkeypatch.setattr(discovery, "lost_ports", lambda: next(losses, []))
    nodes, destroyed = iter(range(9)), []
    assert first_node(lambda: next(nodes), destroyed.append) == made - 1
    assert destroyed == list(range(made - 1))
    warning = (
        f"this process hears nothing from others, because {PORT} was removed while it was opened, "
        "5 times in a row; start it again"
    )
    assert caplog.messages == [warning] * warned
