"""A client of what a controller manager offers about hardware components."""

from collections.abc import Callable

from controller_manager_msgs.srv import ListHardwareComponents, SetHardwareComponentState
from lifecycle_msgs.msg import State
from rclpy.node import Node

from arm_control.ros.service_caller import ServiceCaller

_SERVICES = {
    "list_hardware_components": ListHardwareComponents,
    "set_hardware_component_state": SetHardwareComponentState,
}
TIMEOUT_S = 10.0


class HardwareClient:
    """What a client asks of a manager about hardware; threads and errors of `ServiceCaller`."""

    def __init__(self, node: Node, manager: str, interrupted: Callable[[], bool]) -> None:
        """Prepare the clients.

        Args:
            node: to make them on.
            manager: absolute name of the manager's node.
            interrupted: says whether to give up waiting.
        """
        self._caller = ServiceCaller(node, manager, _SERVICES, TIMEOUT_S, interrupted)

    def wait_for_manager(self, timeout_s: float) -> None:
        """Wait until the manager offers its services; 0 for ever."""
        self._caller.wait_for("list_hardware_components", timeout_s)

    def states(self) -> dict[str, State]:
        """Return the state of each component."""
        answer = self._caller.query("list_hardware_components", ListHardwareComponents.Request())
        return {component.name: component.state for component in answer.component}

    def set_state(self, name: str, target: State) -> bool:
        """Bring a component to a state; return whether the manager says that it is there."""
        request = SetHardwareComponentState.Request(name=name, target_state=target)
        return self._caller.change(
            "set_hardware_component_state", request, lambda: self.states().get(name) == target
        )
