"""List the controllers of every manager once a second, and switch them on request."""

from collections.abc import Callable

from controller_manager_msgs.srv import ConfigureController, ListControllers
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from arm_node.controller_manager import SERVICES, switch_request
from arm_viewer.requests import Configure, SwitchControllers
from arm_viewer.ros.observer import Observer, TopicTypes, keep_in_step, served
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.snapshot import ListedController

SERVICE = "/list_controllers"
SERVICE_TYPE = "controller_manager_msgs/srv/ListControllers"
JOINTS = "joints"
"""The parameter with the order in which a controller takes the values of its joints."""


class ControllerObserver(Observer):
    """Keeps the managers' latest lists of controllers, in their order."""

    def __init__(self, node: Node, is_watched: Callable[[], bool]) -> None:
        """Start without managers; ask again only while somebody watches."""
        self._node = node
        self._is_watched = is_watched
        self._managers: dict[str, _ListedManager] = {}

    @property
    def controllers(self) -> tuple[ListedController, ...]:
        """The controllers of all present managers."""
        return tuple(c for manager in self._managers.values() for c in manager.controllers)

    def discover(self, topics: TopicTypes) -> None:
        """Query every present manager; forget managers that have disappeared."""
        found = served(self._node, SERVICE, SERVICE_TYPE)
        keep_in_step(self._managers, sorted(found), lambda name: _ListedManager(self._node, name))
        for manager in self._managers.values():
            if self._is_watched() or not manager.controllers:
                manager.ask()


class _ListedManager:
    """One manager: its list of controllers, and the joints of each."""

    def __init__(self, node: Node, name: str) -> None:
        self.controllers: tuple[ListedController, ...] = ()
        self._node = node
        self._name = name
        self._list = _service_caller(node, name, "list_controllers")
        self._parameters: dict[str, ServiceCaller] = {}
        self._joints: dict[str, tuple[str, ...]] = {}
        self._states: dict[str, str] = {}

    def ask(self) -> None:
        self._list.ask(ListControllers.Request(), self._take_list)

    def close(self) -> None:
        for service_caller in (self._list, *self._parameters.values()):
            service_caller.close()

    def _take_list(self, answer: ListControllers.Response) -> None:
        states = {state.name: state.state for state in answer.controller}
        for name in self._parameters.keys() - states:
            self._parameters.pop(name).close()
        for name, state in states.items():
            # A controller may reread its parameters when its state changes.
            if self._states.get(name) != state:
                self._joints.pop(name, None)
            if name not in self._joints and state in ("active", "inactive"):
                self._ask_joints(name)
        self._states = states
        self.controllers = tuple(
            ListedController(
                manager=self._name,
                name=state.name,
                type=state.type,
                state=state.state,
                claimed=tuple(state.claimed_interfaces),
                joints=self._joints.get(state.name, ()),
            )
            for state in answer.controller
        )

    def _ask_joints(self, name: str) -> None:
        if name not in self._parameters:
            service = f"{self._name.rpartition('/')[0]}/{name}/get_parameters"
            self._parameters[name] = ServiceCaller(self._node, GetParameters, service)

        def take(answer: GetParameters.Response) -> None:
            self._joints[name] = _joints_of(answer)

        self._parameters[name].ask(GetParameters.Request(names=[JOINTS]), take)


def _joints_of(answer: GetParameters.Response) -> tuple[str, ...]:
    # A node that does not have the parameter answers with an empty list.
    return tuple(name for value in answer.values for name in value.string_array_value)


class ManagerCaller(Observer):
    """Keeps clients for each manager ready, so that a request does not wait for discovery.

    Attributes:
        refusal: why the last change was refused; empty if it succeeded.
    """

    def __init__(self, node: Node, controllers: Callable[[], tuple[ListedController, ...]]) -> None:
        """Serve the managers of the controllers that `controllers` returns."""
        self.refusal = ""
        self._node = node
        self._controllers = controllers
        self._managers: dict[str, _ManagerClients] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Create clients for new managers; destroy those of managers that have disappeared."""
        found = {controller.manager for controller in self._controllers()}
        keep_in_step(self._managers, found, lambda name: _ManagerClients(self._node, name))

    def serve(self, request: SwitchControllers | Configure) -> None:
        """Call the manager, and store its refusal in `refusal`."""
        manager = self._managers.get(request.manager)
        if manager is None or not self._ask(manager, request):
            self.refusal = f"{request.manager} does not answer yet; try again"

    def _ask(self, manager: "_ManagerClients", request: SwitchControllers | Configure) -> bool:
        if isinstance(request, Configure):
            question = ConfigureController.Request(name=request.controller)
            # The service has no field for a reason.
            reason = f"{request.controller} cannot be configured; {request.manager}'s log says why"
            return manager.configure.ask(question, lambda answer: self._note(answer.ok, reason))
        question = switch_request(request.activate, request.deactivate)
        return manager.switch.ask(question, lambda answer: self._note(answer.ok, answer.message))

    def _note(self, is_done: bool, reason: str) -> None:
        self.refusal = "" if is_done else reason or "the manager refused"


class _ManagerClients:
    """The clients of one manager."""

    def __init__(self, node: Node, name: str) -> None:
        self.switch = _service_caller(node, name, "switch_controller")
        self.configure = _service_caller(node, name, "configure_controller")

    def close(self) -> None:
        self.switch.close()
        self.configure.close()


def _service_caller(node: Node, manager: str, service: str) -> ServiceCaller:
    return ServiceCaller(node, SERVICES[service], f"{manager}/{service}")
