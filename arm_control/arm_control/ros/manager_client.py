"""A client of a controller manager's services, ours or a real one's."""

from collections.abc import Callable, Mapping, Sequence

from builtin_interfaces.msg import Duration
from controller_manager_msgs.srv import (
    ConfigureController,
    ListControllers,
    LoadController,
    SwitchController,
    UnloadController,
)
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.ros.service_caller import ServiceCaller

_SERVICES = {
    "configure_controller": ConfigureController,
    "list_controllers": ListControllers,
    "load_controller": LoadController,
    "set_parameters": SetParameters,
    "switch_controller": SwitchController,
    "unload_controller": UnloadController,
}


class ManagerClient:
    """What a client asks of a manager about controllers; threads and errors of `ServiceCaller`."""

    def __init__(
        self,
        node: Node,
        manager: str,
        timeout_s: float,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Prepare the clients.

        Args:
            node: to make them on.
            manager: absolute name of the manager's node.
            timeout_s: how long to wait for an answer before asking again.
            interrupted: says whether to give up waiting.
        """
        self._caller = ServiceCaller(node, manager, _SERVICES, timeout_s, interrupted)

    def wait_for_manager(self, timeout_s: float) -> None:
        """Wait until the manager offers its services; 0 for ever."""
        self._caller.wait_for("list_controllers", timeout_s)

    def states(self) -> Mapping[str, str]:
        """Return the state of each loaded controller."""
        answer = self._caller.query("list_controllers", ListControllers.Request())
        return {controller.name: controller.state for controller in answer.controller}

    def set_parameters(self, parameters: Mapping[str, str | Sequence[str]]) -> str:
        """Set parameters of the manager's node; return why it refused one, or nothing."""
        request = SetParameters.Request(
            parameters=[
                Parameter(
                    name, value=value if isinstance(value, str) else list(value)
                ).to_parameter_msg()
                for name, value in parameters.items()
            ]
        )
        answer = self._caller.query("set_parameters", request)
        return "; ".join(result.reason for result in answer.results if not result.successful)

    def load(self, name: str) -> bool:
        """Load a controller; return whether it is."""
        request = LoadController.Request(name=name)
        return self._caller.change("load_controller", request, lambda: name in self.states())

    def configure(self, name: str) -> bool:
        """Configure a controller; return whether it is."""
        request = ConfigureController.Request(name=name)
        return self._caller.change(
            "configure_controller", request, lambda: self.states().get(name) == "inactive"
        )

    def unload(self, name: str) -> bool:
        """Unload a controller; return whether it is gone."""
        request = UnloadController.Request(name=name)
        return self._caller.change("unload_controller", request, lambda: name not in self.states())

    def activate(self, names: Sequence[str], timeout_s: float, *, asap: bool = True) -> bool:
        """Activate all of these in one strict switch; return whether they are."""

        def are_active() -> bool:
            states = self.states()
            return all(states.get(name) == "active" for name in names)

        request = SwitchController.Request(activate_controllers=list(names), activate_asap=asap)
        return self._switch(request, timeout_s, are_active)

    def deactivate(self, names: Sequence[str], timeout_s: float) -> bool:
        """Deactivate all of these in one strict switch; return whether they are."""

        def are_not_active() -> bool:
            states = self.states()
            return all(states.get(name) != "active" for name in names)

        request = SwitchController.Request(deactivate_controllers=list(names))
        return self._switch(request, timeout_s, are_not_active)

    def _switch(
        self, request: SwitchController.Request, timeout_s: float, is_done: Callable[[], bool]
    ) -> bool:
        request.strictness = SwitchController.Request.STRICT
        seconds = int(timeout_s)
        request.timeout = Duration(sec=seconds, nanosec=int((timeout_s - seconds) * 1e9))
        return self._caller.change("switch_controller", request, is_done)
