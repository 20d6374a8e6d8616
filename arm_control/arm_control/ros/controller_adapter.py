"""The ROS half of a controller: its topics, services and actions."""

from abc import ABC, abstractmethod
from typing import Any, Generic, TypeVar

from rclpy.executors import Executor
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.controller import Controller
from arm_control.errors import ControllerError

ControllerT = TypeVar("ControllerT", bound=Controller[Any])


class ControllerAdapter(ABC, Generic[ControllerT]):
    """Connects a controller's core to its node.

    Made when the controller is loaded. The methods run on a control-plane thread, never while the
    controller is active; what they create hands messages to the core from the executor's thread,
    and takes results from it on the loop thread.

    Attributes:
        controller: the core.
        node: the controller's; an executor of one thread spins it.
        loop: runs the core.
    """

    def __init__(self, controller: ControllerT, node: Node, loop: ControlLoop) -> None:
        self.controller = controller
        self.node = node
        self.loop = loop

    @property
    def executor(self) -> Executor:
        """The executor that spins the node.

        Raises:
            ControllerError: there is none yet.
        """
        if self.node.executor is None:
            raise ControllerError(
                f"no executor spins the node of controller '{self.node.get_name()}'"
            )
        return self.node.executor

    @abstractmethod
    def on_configure(self, parameters: Any) -> None:
        """Create the end points; the core has these parameters by now."""

    @abstractmethod
    def on_cleanup(self) -> None:
        """Destroy what `on_configure` created."""
