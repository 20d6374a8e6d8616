"""A controller that fails on demand, by its parameter `fault`."""

import threading
from dataclasses import dataclass

from arm_control import Controller, InterfaceConfiguration, ReturnType, parameter

SLOW_START_S = 1.2
"""More than the manager waits by default until a switch has begun."""

BLOCKED_S = 0.15
"""Fifteen periods: far too long, and short enough for everybody else to get a word in."""


@dataclass(frozen=True, slots=True)
class FaultyParameters:
    """The command, and the kind of failure."""

    joints: tuple[str, ...] = parameter((), "Joints whose position it commands")
    fault: str = parameter(
        "none", "What it does", one_of=("none", "raise", "error", "block", "start slowly")
    )


class FaultyController(Controller[FaultyParameters]):
    """Commands 0 until it fails."""

    parameters_type = FaultyParameters

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(
            f"{joint}/position" for joint in self.parameters.joints
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def on_activate(self) -> None:
        if self.parameters.fault == "start slowly":
            threading.Event().wait(SLOW_START_S)

    def update(self, time_s: float, period_s: float) -> ReturnType:
        match self.parameters.fault:
            case "raise":
                raise RuntimeError("out of order")
            case "error":
                return ReturnType.ERROR
            case "block":
                threading.Event().wait(BLOCKED_S)
        self.commands.write(0.0)
        return ReturnType.OK
