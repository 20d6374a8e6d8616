"""A client of a controller manager's services, ours or a real one's."""

from collections.abc import Sequence
from typing import Any

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

from arm_cli.ros.service_call import ANSWER_TIMEOUT_S, call_service
from arm_cli.ros.session import Session

SWITCH_TIMEOUT_S = 5.0

_STATE_IDS = {
    "unconfigured": State.PRIMARY_STATE_UNCONFIGURED,
    "inactive": State.PRIMARY_STATE_INACTIVE,
    "active": State.PRIMARY_STATE_ACTIVE,
}


class ControllerManagerClient:
    """Asks one manager. Every method raises UnansweredError where it does not answer."""

    def __init__(
        self, session: Session, manager: str, answer_timeout_s: float = ANSWER_TIMEOUT_S
    ) -> None:
        """Ask the manager whose node has that absolute name."""
        self._session = session
        self._manager = manager
        self._answer_timeout_s = answer_timeout_s

    def controllers(self) -> list[Any]:
        """Return a ControllerState for each loaded controller, newest first."""
        return list(self._call(ListControllers, "list_controllers").controller)

    def controller_types(self) -> list[tuple[str, str]]:
        """Return the types that can be loaded, and their base classes."""
        answer = self._call(ListControllerTypes, "list_controller_types")
        return list(zip(answer.types, answer.base_classes, strict=True))

    def hardware_components(self) -> list[Any]:
        """Return a HardwareComponentState for each component."""
        return list(self._call(ListHardwareComponents, "list_hardware_components").component)

    def hardware_interfaces(self) -> Any:
        """Return the command and the state interfaces."""
        return self._call(ListHardwareInterfaces, "list_hardware_interfaces")

    def load(self, name: str) -> bool:
        """Load a controller; return whether that worked, as all methods below."""
        return self._call(LoadController, "load_controller", name=name).ok

    def configure(self, name: str) -> bool:
        """Configure a controller."""
        return self._call(ConfigureController, "configure_controller", name=name).ok

    def cleanup(self, name: str) -> bool:
        """Take an inactive controller back to unconfigured."""
        return self._call(CleanupController, "cleanup_controller", name=name).ok

    def unload(self, name: str) -> bool:
        """Unload a controller."""
        return self._call(UnloadController, "unload_controller", name=name).ok

    def reload_libraries(self, force_kill: bool) -> bool:
        """Read the controllers' code anew."""
        service = "reload_controller_libraries"
        return self._call(ReloadControllerLibraries, service, force_kill=force_kill).ok

    def switch(
        self,
        activate: Sequence[str] = (),
        deactivate: Sequence[str] = (),
        strictness: int = SwitchController.Request.STRICT,
        asap: bool = True,
        timeout_s: float = SWITCH_TIMEOUT_S,
    ) -> Any:
        """Activate and deactivate controllers in one step; return the response."""
        whole_s = int(timeout_s)
        return self._call(
            SwitchController,
            "switch_controller",
            activate_controllers=list(activate),
            deactivate_controllers=list(deactivate),
            strictness=strictness,
            activate_asap=asap,
            timeout=Duration(sec=whole_s, nanosec=int((timeout_s - whole_s) * 1e9)),
        )

    def set_component_state(self, name: str, state: str) -> Any:
        """Bring a hardware component to a state; return the response."""
        return self._call(
            SetHardwareComponentState,
            "set_hardware_component_state",
            name=name,
            target_state=State(id=_STATE_IDS[state], label=state),
        )

    def _call(self, service_class: Any, service: str, **fields: Any) -> Any:
        name = f"{self._manager}/{service}"
        request = service_class.Request(**fields)
        return call_service(
            self._session,
            service_class,
            name,
            request,
            answer_timeout_s=self._answer_timeout_s,
        )
