"""A client of a controller manager, this suite's or ros2_control's."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Protocol

from builtin_interfaces.msg import Duration
from controller_manager_msgs.srv import (
    CleanupController,
    ConfigureController,
    ListControllers,
    ListControllerTypes,
    ListHardwareComponents,
    ListHardwareInterfaces,
    LoadController,
    ReloadControllerLibraries,
    SetHardwareComponentState,
    SwitchController,
    UnloadController,
)
from lifecycle_msgs.msg import State
from rcl_interfaces.srv import ListParameters, SetParameters
from rclpy.parameter import Parameter

SWITCH_TIMEOUT_S = 5.0

SERVICES: Mapping[str, Any] = MappingProxyType(
    {
        "cleanup_controller": CleanupController,
        "configure_controller": ConfigureController,
        "list_controller_types": ListControllerTypes,
        "list_controllers": ListControllers,
        "list_hardware_components": ListHardwareComponents,
        "list_hardware_interfaces": ListHardwareInterfaces,
        "list_parameters": ListParameters,
        "load_controller": LoadController,
        "reload_controller_libraries": ReloadControllerLibraries,
        "set_hardware_component_state": SetHardwareComponentState,
        "set_parameters": SetParameters,
        "switch_controller": SwitchController,
        "unload_controller": UnloadController,
    }
)
"""The type of each service by its name below the manager's."""

_STATE_IDS = {
    "unconfigured": State.PRIMARY_STATE_UNCONFIGURED,
    "inactive": State.PRIMARY_STATE_INACTIVE,
    "active": State.PRIMARY_STATE_ACTIVE,
    "finalized": State.PRIMARY_STATE_FINALIZED,
}


class ServiceTransport(Protocol):
    """Calls the services of one manager; decides how to wait, and what to do if no answer comes."""

    def query(self, service: str, request: Any) -> Any:
        """Call a service that changes nothing; return the answer."""
        ...

    def change(self, service: str, request: Any, is_done: Callable[[], bool]) -> Any:
        """Call a service that changes something; return the answer, which has the field `ok`.

        `is_done` checks whether the change was made although no answer came.
        """
        ...


def switch_request(
    activate: Sequence[str] = (),
    deactivate: Sequence[str] = (),
    *,
    strictness: int = SwitchController.Request.STRICT,
    asap: bool = True,
    timeout_s: float = SWITCH_TIMEOUT_S,
) -> SwitchController.Request:
    """Return the request to activate and deactivate controllers in one step."""
    whole_s = int(timeout_s)
    return SwitchController.Request(
        activate_controllers=list(activate),
        deactivate_controllers=list(deactivate),
        strictness=strictness,
        activate_asap=asap,
        timeout=Duration(sec=whole_s, nanosec=int((timeout_s - whole_s) * 1e9)),
    )


class ControllerManagerClient:
    """Calls one manager; the `ServiceTransport` determines threads, timeouts and errors."""

    def __init__(self, caller: ServiceTransport) -> None:
        self._caller = caller

    def controllers(self) -> list[Any]:
        """Return a ControllerState for each loaded controller, newest first."""
        return list(self._query("list_controllers").controller)

    def states(self) -> dict[str, str]:
        """Return the state of each loaded controller by its name, newest first."""
        return {controller.name: controller.state for controller in self.controllers()}

    def loadable(self) -> list[str]:
        """Return the controllers that the manager's parameters describe, as `NAME.type`."""
        names = sorted(self._query("list_parameters").result.names)
        return [name.removesuffix(".type") for name in names if name.endswith(".type")]

    def controller_types(self) -> list[tuple[str, str]]:
        """Return the types that can be loaded, and their base classes."""
        answer = self._query("list_controller_types")
        return list(zip(answer.types, answer.base_classes, strict=True))

    def hardware_components(self) -> list[Any]:
        """Return a HardwareComponentState for each component."""
        return list(self._query("list_hardware_components").component)

    def component_states(self) -> dict[str, State]:
        """Return the state of each hardware component by its name."""
        return {component.name: component.state for component in self.hardware_components()}

    def hardware_interfaces(self) -> Any:
        """Return the command and the state interfaces."""
        return self._query("list_hardware_interfaces")

    def set_parameters(self, parameters: Mapping[str, str | Sequence[str]]) -> str:
        """Set parameters of the manager's node; return why it refused one, or nothing."""
        answer = self._query(
            "set_parameters",
            parameters=[
                Parameter(
                    name, value=value if isinstance(value, str) else list(value)
                ).to_parameter_msg()
                for name, value in parameters.items()
            ],
        )
        return "; ".join(result.reason for result in answer.results if not result.successful)

    def load(self, name: str) -> bool:
        """Load a controller; return whether it succeeded, like the methods below."""
        return self._change("load_controller", lambda: name in self.states(), name=name).ok

    def configure(self, name: str) -> bool:
        """Configure a controller."""
        is_done = self._is_in_state(name, "inactive")
        return self._change("configure_controller", is_done, name=name).ok

    def cleanup(self, name: str) -> bool:
        """Return an inactive controller to unconfigured."""
        is_done = self._is_in_state(name, "unconfigured")
        return self._change("cleanup_controller", is_done, name=name).ok

    def unload(self, name: str) -> bool:
        """Unload a controller."""
        return self._change("unload_controller", lambda: name not in self.states(), name=name).ok

    def reload_libraries(self, force_kill: bool) -> bool:
        """Reload the controllers' code."""
        service = "reload_controller_libraries"
        return self._change(service, lambda: False, force_kill=force_kill).ok

    def switch(
        self,
        activate: Sequence[str] = (),
        deactivate: Sequence[str] = (),
        *,
        strictness: int = SwitchController.Request.STRICT,
        asap: bool = True,
        timeout_s: float = SWITCH_TIMEOUT_S,
    ) -> SwitchController.Response:
        """Activate and deactivate controllers in one step; return the response."""

        def is_done() -> bool:
            active = {name for name, state in self.states().items() if state == "active"}
            return active.issuperset(activate) and active.isdisjoint(deactivate)

        request = switch_request(
            activate, deactivate, strictness=strictness, asap=asap, timeout_s=timeout_s
        )
        return self._caller.change("switch_controller", request, is_done)

    def set_component_state(self, name: str, label: str) -> SetHardwareComponentState.Response:
        """Bring a hardware component to the state with this label; return the response."""
        target = State(id=_STATE_IDS[label], label=label)
        return self._change(
            "set_hardware_component_state",
            lambda: self.component_states().get(name) == target,
            name=name,
            target_state=target,
        )

    def _is_in_state(self, name: str, state: str) -> Callable[[], bool]:
        return lambda: self.states().get(name) == state

    def _query(self, service: str, **fields: Any) -> Any:
        return self._caller.query(service, SERVICES[service].Request(**fields))

    def _change(self, service: str, is_done: Callable[[], bool], **fields: Any) -> Any:
        return self._caller.change(service, SERVICES[service].Request(**fields), is_done)
