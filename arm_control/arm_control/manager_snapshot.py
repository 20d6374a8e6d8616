"""What a controller manager holds, for readers on any thread."""

from arm_control.controller_manager import ControllerManager
from arm_control.lifecycle import LifecycleState, Transition


class ManagerSnapshot:
    """Controllers, components and interfaces as they are since the last change.

    It observes the manager (`ManagerObserver`, loop thread), and is up to date before whoever
    asked for a change has the answer. Each attribute is replaced as a whole, so any thread may
    read it at any time, even while the control loop is stuck in somebody's code.

    Attributes:
        controllers: every loaded controller and the record of its updates, the newest first.
        components: every hardware component and the records of its reads and writes.
        interfaces: the command and the state interfaces, each sorted by name.
    """

    def __init__(self, manager: ControllerManager) -> None:
        """Take the first look; loop thread."""
        self._manager = manager
        self.activity_changed()

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Do nothing: `activity_changed` follows."""

    def activity_changed(self) -> None:
        """Look again; loop thread."""
        self.controllers = self._manager.controller_runs()
        self.components = self._manager.component_runs()
        self.interfaces = self._manager.list_hardware_interfaces()
