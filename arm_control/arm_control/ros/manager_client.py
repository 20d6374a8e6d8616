"""A client of a controller manager's services, ours or a real one's."""

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from arm_node.process import NodeProcess
from builtin_interfaces.msg import Duration
from controller_manager_msgs.srv import (
    ConfigureController,
    ListControllers,
    LoadController,
    SwitchController,
    UnloadController,
)
from rcl_interfaces.srv import SetParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import ArmControlError

logger = logging.getLogger(__name__)

POLL_S = 0.02
REPORT_INTERVAL_S = 10.0
ATTEMPTS = 3
STRICT = SwitchController.Request.STRICT


class ManagerUnreachableError(ArmControlError):
    """The controller manager is not there, or does not answer."""


class InterruptedCallError(ArmControlError):
    """The process was asked to end while it waited."""


class ManagerClient:
    """Calls the manager and waits for its answers.

    The node must be served by a spinning executor; call the methods from another thread.

    Every method raises `ManagerUnreachableError`, or `InterruptedCallError` when the process is
    asked to end.
    """

    def __init__(self, node: Node, process: NodeProcess, manager: str, timeout_s: float) -> None:
        """Prepare the clients.

        Args:
            node: to make them on.
            process: says when to give up waiting.
            manager: absolute name of the manager's node.
            timeout_s: how long to wait for an answer before asking again.
        """
        self._node = node
        self._process = process
        self._manager = manager
        self._timeout_s = timeout_s
        self._clients: dict[str, Client] = {}

    def wait_for_manager(self, timeout_s: float) -> None:
        """Wait until the manager offers its services; 0 for ever."""
        client = self._client(ListControllers, "list_controllers")
        waited_s = 0.0
        while not client.service_is_ready():
            if timeout_s and waited_s >= timeout_s:
                raise ManagerUnreachableError(
                    f"no service {self._manager}/list_controllers after {timeout_s:g} s; "
                    "is a controller manager running under that name, in this ROS domain?"
                )
            self._pause()
            # Counted, not measured: a test's clock is not wanted here, and POLL_S is exact enough.
            before_s, waited_s = waited_s, waited_s + POLL_S
            if waited_s // REPORT_INTERVAL_S > before_s // REPORT_INTERVAL_S:
                logger.info("waiting for service %s/list_controllers", self._manager)
