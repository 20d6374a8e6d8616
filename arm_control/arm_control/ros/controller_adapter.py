"""The ROS half of a controller: its topics, services and actions."""

from abc import ABC, abstractmethod
from typing import Any, Generic, TypeVar

from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription

from arm_control.control_loop import ControlLoop
from arm_control.controller import Controller
from arm_control.errors import ControllerError
from arm_control.ros.executor_bridge import run_on_executor

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
        """Destroy what `on_configure` created, with `destroy`; may be called again without."""

    def destroy(self, *end_points: Publisher | Subscription | Service) -> None:
        """Destroy end points of the node; not on the executor's thread.

        Done by the executor: it stumbles over one that goes while it gathers what to wait for.
        """

        def destroy_all() -> None:
            for end_point in end_points:
                if isinstance(end_point, Publisher):
                    self.node.destroy_publisher(end_point)
                elif isinstance(end_point, Subscription):
                    self.node.destroy_subscription(end_point)
                else:
                    self.node.destroy_service(end_point)

        executor = self.node.executor
        if executor is None:
            destroy_all()
        elif end_points:
            run_on_executor(executor, destroy_all)
