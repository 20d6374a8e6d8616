"""Activates and deactivates controllers for the page."""

from collections.abc import Callable

from controller_manager_msgs.srv import SwitchController
from rclpy.node import Node

from arm_viewer.requests import SwitchControllers
from arm_viewer.ros.inquiry import Inquiry
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import Controller


class ControllerSwitch:
    """Has a client for each manager ready, so that a request need not wait for the discovery.

    Attributes:
        refusal: why the last switch was refused; empty where it was not.
    """

    def __init__(self, node: Node, controllers: Callable[[], tuple[Controller, ...]]) -> None:
        """Serve the managers of the controllers of that list."""
        self.refusal = ""
        self._node = node
        self._controllers = controllers
        self._managers: dict[str, Inquiry] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Make clients for new managers; end those of managers that are gone."""
        found = {controller.manager for controller in self._controllers()}
        for name in self._managers.keys() - found:
            self._managers.pop(name).close()
        for name in found - self._managers.keys():
            self._managers[name] = Inquiry(
                self._node, SwitchController, f"{name}/switch_controller"
            )

    def collect(self, now_s: float) -> None:
        """Take notice of nothing: answers come by themselves."""

    def serve(self, request: SwitchControllers) -> None:
        """Ask the manager; say in `refusal` what comes of it."""
        manager = self._managers.get(request.manager)
        question = SwitchController.Request(
            activate_controllers=list(request.activate),
            deactivate_controllers=list(request.deactivate),
            strictness=SwitchController.Request.STRICT,
            activate_asap=True,
        )
        if manager is None or not manager.ask(question, self._take):
            self.refusal = f"{request.manager} does not answer yet; try again"

    def _take(self, answer: SwitchController.Response) -> None:
        self.refusal = "" if answer.ok else answer.message or "the switch was refused"
