"""The ROS half of the GPIO controller: ~/commands and ~/gpio_states."""

import logging
from collections.abc import Mapping

import numpy as np
from control_msgs.msg import DynamicInterfaceGroupValues, InterfaceValue
from numpy.typing import NDArray
from rclpy.publisher import Publisher

from arm_control.controllers.gpio_command.controller import (
    GpioCommandController,
    GpioCommandParameters,
)
from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.loop.outbox import Outbox
from arm_node.workarounds.message_template import MessageTemplate, raw_sender


class GpioCommandAdapter(ControllerAdapter[GpioCommandController]):
    """Connects the controller to its two topics."""

    def on_configure(self, parameters: GpioCommandParameters) -> None:
        """Create the end points; without command interfaces there is nothing to subscribe to."""
        publisher = self.publisher(DynamicInterfaceGroupValues, "~/gpio_states")
        self.controller.sink = _GpioStatePublisher(
            publisher, self.controller.shown, self.loop.outbox
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


class _GpioStatePublisher:
    """Writes the states into one serialised message; see `GpioStateSink`."""

    def __init__(
        self, publisher: Publisher, shown: Mapping[str, tuple[str, ...]], outbox: Outbox
    ) -> None:
        self._publisher = publisher
        self._send = raw_sender(publisher)
        self._outbox = outbox
        values = [
            InterfaceValue(interface_names=list(names), values=[0.0] * len(names))
            for names in shown.values()
        ]
        self._template = MessageTemplate(
            DynamicInterfaceGroupValues(interface_groups=list(shown), interface_values=values)
        )
        self._where = self._template.indices("interface_values[*].values")

    def wanted(self) -> bool:
        """Return whether there is a subscriber now."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, time_s: float, states: NDArray[np.float64]) -> None:
        """Publish the states."""
        self._template.set_stamps(round(time_s * 1e9))
        self._template.float64[self._where] = states
        self._outbox.put(self._send, self._template.to_bytes())
