"""Answers to goals wait for the note of their request."""

import asyncio
import threading
from typing import Any

import pytest
from rclpy.action.client import ActionClient

from arm_planning.ros.noted_action_client import NotedActionClient

TIMEOUT_S = 60.0


@pytest.mark.parametrize(
    "request_of", ["send_goal_async", "_cancel_goal_async", "_get_result_async"]
)
def test_an_answer_waits_until_its_request_is_noted(monkeypatch, request_of):
    sent, may_note, answering = threading.Event(), threading.Event(), threading.Event()
    order: list[str] = []

    def request(_client: Any, _about: Any) -> None:
        sent.set()
        assert may_note.wait(TIMEOUT_S)
        order.append("noted")

    async def execute(_client: Any, _taken: Any) -> None:
        order.append("answered")

    def answer() -> None:
        answering.set()
        asyncio.run(client.execute({}))

    monkeypatch.setattr(ActionClient, "__init__", lambda _client: None)
    monkeypatch.setattr(ActionClient, request_of, request)
    monkeypatch.setattr(ActionClient, "execute", execute)
    client = NotedActionClient()
    threads = [threading.Thread(target=getattr(client, request_of), args=(None,))]
    threads.append(threading.Thread(target=answer))
    threads[0].start()
    assert sent.wait(TIMEOUT_S)
    threads[1].start()
    assert answering.wait(TIMEOUT_S)
    threads[1].join(0.05)
    may_note.set()
    for thread in threads:
        thread.join(TIMEOUT_S)
    assert order == ["noted", "answered"]
