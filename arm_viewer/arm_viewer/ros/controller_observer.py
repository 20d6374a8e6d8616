"""The controllers of every controller manager, asked for once a second."""

from controller_manager_msgs.srv import ListControllers
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from arm_viewer.ros.inquiry import Inquiry
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import Controller

SERVICE = "/list_controllers"
SERVICE_TYPE = "controller_manager_msgs/srv/ListControllers"
JOINTS = "joints"
"""The parameter that says in which order a controller takes the values of its joints."""


class ControllerObserver:
    """Keeps what the managers last said, in their own order."""

    def __init__(self, node: Node) -> None:
        """Start to look for managers."""
        self._node = node
        self._managers: dict[str, _Manager] = {}

    @property
    def controllers(self) -> tuple[Controller, ...]:
        """The controllers of all managers that are there."""
        return tuple(c for manager in self._managers.values() for c in manager.controllers)

    def discover(self, topics: TopicTypes) -> None:
        """Ask every manager that is there; forget those that are gone."""
        found = {
            service.removesuffix(SERVICE)
            for service, types in self._node.get_service_names_and_types()
            if service.endswith(SERVICE) and SERVICE_TYPE in types
        }
        for name in self._managers.keys() - found:
            self._managers.pop(name).close()
        for name in sorted(found - self._managers.keys()):
            self._managers[name] = _Manager(self._node, name)
        for manager in self._managers.values():
            manager.ask()

    def collect(self, now_s: float) -> None:
        """Take notice of nothing: answers come by themselves."""


class _Manager:
    """One manager: its list of controllers, and the joints of each."""

    def __init__(self, node: Node, name: str) -> None:
        self.controllers: tuple[Controller, ...] = ()
        self._node = node
        self._name = name
        self._list = Inquiry(node, ListControllers, f"{name}{SERVICE}")
        self._parameters: dict[str, Inquiry] = {}
        self._joints: dict[str, tuple[str, ...]] = {}
        self._states: dict[str, str] = {}

    def ask(self) -> None:
        self._list.ask(ListControllers.Request(), self._take_list)

    def close(self) -> None:
        for inquiry in (self._list, *self._parameters.values()):
            inquiry.close()

    def _take_list(self, answer: ListControllers.Response) -> None:
        states = {state.name: state.state for state in answer.controller}
        for name in self._parameters.keys() - states:
            self._parameters.pop(name).close()
        for name, state in states.items():
            # With a change of state the parameters may have been read anew.
            if self._states.get(name) != state:
                self._joints.pop(name, None)
            if name not in self._joints and state in ("active", "inactive"):
                self._ask_joints(name)
        self._states = states
        self.controllers = tuple(
            Controller(
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
            self._parameters[name] = Inquiry(self._node, GetParameters, service)

        def take(answer: GetParameters.Response) -> None:
            self._joints[name] = _joints_of(answer)

        self._parameters[name].ask(GetParameters.Request(names=[JOINTS]), take)


def _joints_of(answer: GetParameters.Response) -> tuple[str, ...]:
    # A node that does not have the parameter answers with an empty list.
    return tuple(name for value in answer.values for name in value.string_array_value)
