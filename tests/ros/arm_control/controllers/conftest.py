"""Clients of actions, one of which dies."""

import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.serialization import serialize_message
from unique_identifier_msgs.msg import UUID

DYING_CLIENT = Path(__file__).with_name("dying_client.py")


class SentGoal:
    """A goal from the sight of its client.

    Attributes:
        accepted: whether the server took it.
        feedback: what came of it so far.
    """

    def __init__(self, caller: "ActionCaller", handle: Any, ended: Any, feedback: Any) -> None:
        self.accepted = handle.accepted
        self.feedback = feedback
        self._caller = caller
        self._handle = handle
        self._ended = ended

    def wait(self) -> Any:
        """Wait for the end; return the answer with its `status` and `result`."""
        return self._caller.result_of(self._ended, "the goal")

    def wait_until_running(self) -> None:
        """Wait for the first feedback; the goal is accepted before the controller has it."""
        self.feedback.wait_for(1)

    def wait_until_asked_for(self) -> None:
        """Wait until the server has the request for this goal's result.

        It reads requests in their order, and answers one for the result of an unknown goal at once.
        """
        unknown = ClientGoalHandle(self._caller.action, UUID(uuid=[7] * 16), None)
        self._caller.await_on_executor(unknown.get_result_async)

    def ended(self) -> bool:
        """Return whether there is a result."""
        return self._ended.done()

    def cancel(self) -> int:
        """Ask for the end; return how many goals are being cancelled."""
        return len(self._caller.await_on_executor(self._handle.cancel_goal_async).goals_canceling)


class ActionCaller:
    """Sends goals to one action.

    rclpy's action client notes a request only after it has sent it: from another thread than the
    executor's, an answer that is quick enough is thrown away. So all of it happens there.
    """

    def __init__(self, client: Any, action_type: type, name: str) -> None:
        self._type = action_type
        self._client = client
        self._name = name
        self.result_of = client.result_of
        self.action = client.run(lambda: ActionClient(client.node, action_type, name), name)
        self._servers: set[bytes] = set()

    def wait_for_server(self) -> None:
        """Wait until there is a server, another one than the last time."""
        known = self._servers

        def found() -> bool:
            self._servers = self._find_servers()
            ready = self.action.server_is_ready()
            return ready and len(self._servers) == 1 and self._servers != known

        self._client.wait_until(found, f"a new server of {self._name}")
        self._client.be_known_to_server(f"{self._name}/_action/send_goal")

    def send(self, **fields: object) -> SentGoal:
        """Send a goal with these fields; return it once it is accepted or rejected."""
        if not self._servers:
            self.wait_for_server()
        feedback = self._client.collector()

        async def carry_out() -> tuple[Any, Any]:
            handle = await self.action.send_goal_async(
                self._type.Goal(**fields), lambda message: feedback(message.feedback)
            )
            return handle, handle.get_result_async() if handle.accepted else None

        return SentGoal(self, *self.await_on_executor(carry_out), feedback)

    def send_and_forget(self, **fields: object) -> None:
        """Send a goal and wait for nothing; to be called on the executor's thread."""
        self.action.send_goal_async(self._type.Goal(**fields))

    def await_on_executor(self, function: Callable[[], Any]) -> Any:
        """Return what the awaitable results in that a function returns, on the executor."""

        async def carry_out() -> Any:
            return await function()

        return self._client.run(carry_out, self._name)

    def close(self) -> None:
        """Destroy it, and wait for that."""
        self._client.run(self.action.destroy, self._name)

    def _find_servers(self) -> set[bytes]:
        status = f"{self._name}/_action/status"
        found = self._client.node.get_publishers_info_by_topic(status)
        return {bytes(info.endpoint_gid) for info in found}


@pytest.fixture
def action_caller(client: Any) -> Iterator[Callable[[type, str], ActionCaller]]:
    """Return a function that makes a client of an action, from its type and name."""
    callers: list[ActionCaller] = []

    def make(action_type: type, name: str) -> ActionCaller:
        callers.append(ActionCaller(client, action_type, name))
        return callers[-1]

    yield make
    for caller in callers:
        caller.close()


@pytest.fixture
def send_and_die(run: Any) -> Callable[[type, str, object], None]:
    """Return a function that sends a goal, waits for its acceptance, and dies with the client."""

    def send(action_type: type, name: str, goal: Any) -> None:
        client = run(DYING_CLIENT, action_type.__name__, name, serialize_message(goal).hex())
        client.wait_for_line("accepted")
        client.stop(signal.SIGKILL)

    return send
