"""Threads that are made while answers are held back run like all others afterwards."""

import os
import threading

from arm_node.discovery import answers_held_back


def scheduling(thread: int) -> tuple[int, set[int]]:
    return os.sched_getscheduler(thread), os.sched_getaffinity(thread)


def test_a_thread_made_inside_cannot_preempt_its_maker():
    seen = []
    with answers_held_back():
        thread = threading.Thread(target=lambda: seen.append(scheduling(0)))
        thread.start()
        thread.join()
        mine = scheduling(0)
    assert seen == [mine]
    assert mine[0] in (os.SCHED_FIFO, os.SCHED_BATCH)
    assert len(mine[1]) == 1


def test_without_privilege_batch_scheduling_does(monkeypatch):
    set_scheduler = os.sched_setscheduler

    def refuse_fifo(thread: int, policy: int, parameters: os.sched_param) -> None:
        if policy == os.SCHED_FIFO:
            raise PermissionError
        set_scheduler(thread, policy, parameters)

    monkeypatch.setattr(os, "sched_setscheduler", refuse_fifo)
    with answers_held_back():
        assert os.sched_getscheduler(0) == os.SCHED_BATCH
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_every_thread_is_as_before_afterwards():
    before = scheduling(0)
    done = threading.Event()
    with answers_held_back():
        thread = threading.Thread(target=done.wait)
        thread.start()
    assert scheduling(0) == before
    assert scheduling(thread.native_id) == before
    done.set()
    thread.join()


def test_a_process_with_a_scheduler_of_its_own_is_left_alone(monkeypatch):
    monkeypatch.setattr(os, "sched_getscheduler", lambda _: os.SCHED_FIFO)
    before = os.sched_getaffinity(0)
    with answers_held_back():
        assert os.sched_getaffinity(0) == before
