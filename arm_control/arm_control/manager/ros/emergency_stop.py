"""The emergency stop over ROS: a service that stops and releases, and topics."""

from collections.abc import Sequence
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from arm_control.errors import LoopStoppedError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.ros_executor_bridge import call_on_loop
from arm_control.manager.controller_manager import ControllerManager
from arm_node.qos import LATCHED, SERVICE_QOS

NAME = "emergency_stop"
DEPTH = 10


class EmergencyStopServer:
    """Offers the service emergency_stop and the topics of the same name in a node's namespace.

    The service stops with true and releases with false. A true on the topic stops as well; a false
    has no effect there, so that no stream of messages releases a stop by accident. The latched
    topic emergency_stop/active says whether everything is stopped.
    """

    def __init__(
        self,
        node: Node,
        executor: Executor,
        loop: ControlLoop,
        managers: Sequence[ControllerManager],
    ) -> None:
        """Offer them on a node that the executor spins; the loop is running, paused or not."""
        self._executor = executor
        self._loop = loop
        self._managers = tuple(managers)
        group = MutuallyExclusiveCallbackGroup()
        self._active = node.create_publisher(Bool, f"{NAME}/active", LATCHED)
        self._published: bool | None = None
        # rclpy accepts a coroutine, but its annotations do not.
        answer: Any = self._answer
        node.create_service(SetBool, NAME, answer, qos_profile=SERVICE_QOS, callback_group=group)
        node.create_subscription(Bool, NAME, self._take, DEPTH, callback_group=group)
        loop.call(self._observe).result()

    # Loop thread

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Do nothing: a transition does not change the stop."""

    def activity_changed(self) -> None:
        """Publish whether everything is stopped, if that has changed."""
        stopped = all(manager.emergency_stopped for manager in self._managers)
        if stopped is not self._published:
            self._published = stopped
            self._active.publish(Bool(data=stopped))

    def _observe(self) -> None:
        for manager in self._managers:
            manager.add_observer(self)
        self.activity_changed()

    def _set(self, engaged: bool) -> bool:
        """Stop or release all managers; return whether that changed any of them."""
        return any([manager.set_emergency_stop(engaged) for manager in self._managers])

    # Executor's thread

    async def _answer(self, request: SetBool.Request, response: SetBool.Response) -> Any:
        engaged = request.data
        try:
            changed = await call_on_loop(self._loop, lambda: self._set(engaged), self._executor)
        except LoopStoppedError as error:
            response.message = str(error)
            return response
        response.success = True
        state = "stopped" if engaged else "released"
        response.message = state if changed else f"already {state}"
        return response

    def _take(self, message: Bool) -> None:
        if message.data:
            # Nobody waits for the result; failures are logged.
            self._loop.call(lambda: self._set(True))
