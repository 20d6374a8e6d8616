"""The ROS half of the GPIO controller: ~/commands and ~/gpio_states."""

import logging

from control_msgs.msg import DynamicInterfaceGroupValues, InterfaceValue

from arm_control.controllers.gpio_command.controller import (
    GpioCommandController,
    GpioCommandParameters,
)
from arm_control.controllers.ros_adapter import ControllerAdapter, ReadingPublisher


class GpioCommandAdapter(ControllerAdapter[GpioCommandController]):
    """Connects the controller to its two topics."""

    def on_configure(self, parameters: GpioCommandParameters) -> None:
        """Create the end points; without command interfaces there is nothing to subscribe to."""
        publisher = self.publisher(DynamicInterfaceGroupValues, "~/gpio_states")
        shown = self.controller.shown
        message = DynamicInterfaceGroupValues(
            interface_groups=list(shown),
            interface_values=[
                InterfaceValue(interface_names=list(names), values=[0.0] * len(names))
                for names in shown.values()
            ],
        )
        self.controller.sink = ReadingPublisher(
            publisher, message, ("interface_values[*].values",), outbox=self.loop.outbox
        )
        if any(parameters.commands.values()):
            self.subscribe(DynamicInterfaceGroupValues, "~/commands", self._take)

    def _take(self, message: DynamicInterfaceGroupValues) -> None:
        self.warn_dropped("command", self._offer(message), logging.ERROR)

    def _offer(self, message: DynamicInterfaceGroupValues) -> str:
        """Pass a message on; return why it is refused, or an empty string."""
        groups, of_groups = message.interface_groups, message.interface_values
        if len(groups) != len(of_groups):
            return f"it has {len(groups)} interface_groups and {len(of_groups)} interface_values"
        names: list[str] = []
        values: list[float] = []
        for gpio, given in zip(groups, of_groups, strict=True):
            if len(given.interface_names) != len(given.values):
                return f"For gpio {gpio} interfaces_names do not match values"
            names += [f"{gpio}/{name}" for name in given.interface_names]
            values += given.values
        return self.controller.offer(names, values)
