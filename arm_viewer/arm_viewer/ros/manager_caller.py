"""Changes the states of controllers for the page."""

from collections.abc import Callable

from controller_manager_msgs.srv import ConfigureController, SwitchController
from rclpy.node import Node

from arm_viewer.requests import Configure, SwitchControllers
from arm_viewer.ros.inquiry import Inquiry
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import Controller


class ManagerCaller:
    """Has clients for each manager ready, so that a request need not wait for the discovery.

    Attributes:
        refusal: why the last change was refused; empty where it was not.
    """

    def __init__(self, node: Node, controllers: Callable[[], tuple[Controller, ...]]) -> None:
        """Serve the managers of the controllers of that list."""
        self.refusal = ""
        self._node = node
        self._controllers = controllers
        self._managers: dict[str, _Manager] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Make clients for new managers; end those of managers that are gone."""
        found = {controller.manager for controller in self._controllers()}
        for name in self._managers.keys() - found:
            self._managers.pop(name).close()
        for name in found - self._managers.keys():
            self._managers[name] = _Manager(self._node, name)

    def collect(self, now_s: float) -> None:
        """Take notice of nothing: answers come by themselves."""

    def serve(self, request: SwitchControllers | Configure) -> None:
        """Ask the manager; say in `refusal` what comes of it."""
        manager = self._managers.get(request.manager)
        if manager is None or not self._ask(manager, request):
            self.refusal = f"{request.manager} does not answer yet; try again"

    def _ask(self, manager: "_Manager", request: SwitchControllers | Configure) -> bool:
        if isinstance(request, Configure):
            question = ConfigureController.Request(name=request.controller)
            # The service has no words for a reason.
            reason = f"{request.controller} cannot be configured; {request.manager}'s log says why"
            return manager.configure.ask(question, lambda answer: self._note(answer.ok, reason))
        question = SwitchController.Request(
            activate_controllers=list(request.activate),
            deactivate_controllers=list(request.deactivate),
            strictness=SwitchController.Request.STRICT,
            activate_asap=True,
        )
        return manager.switch.ask(question, lambda answer: self._note(answer.ok, answer.message))

    def _note(self, is_done: bool, reason: str) -> None:
        self.refusal = "" if is_done else reason or "the manager refused"


class _Manager:
    """The clients of one manager."""

    def __init__(self, node: Node, name: str) -> None:
        self.switch = Inquiry(node, SwitchController, f"{name}/switch_controller")
        self.configure = Inquiry(node, ConfigureController, f"{name}/configure_controller")

    def close(self) -> None:
        self.switch.close()
        self.configure.close()
