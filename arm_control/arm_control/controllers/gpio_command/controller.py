"""The core of gpio_controllers/GpioCommandController."""

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arm_control.controllers.controller import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.controllers.sensor_broadcasters.readings import ReadingSink
from arm_control.errors import ControllerError
from arm_control.parameters import parameter, parameter_groups
from arm_control.run_inputs import run_input
from arm_description.urdf.description import as_description

MAX_WAITING = 1000
"""Commands between two cycles; of a faster stream the oldest are lost."""


@dataclass(frozen=True, slots=True)
class _CommandInterfaces:
    """The command interfaces of a GPIO."""

    interfaces: tuple[str, ...] = parameter((), "Command interfaces of this GPIO", read_only=True)


@dataclass(frozen=True, slots=True)
class _StateInterfaces:
    """The state interfaces of a GPIO."""

    interfaces: tuple[str, ...] = parameter(
        (),
        "State interfaces of this GPIO; if no GPIO has any, all those of the description",
        read_only=True,
    )


@dataclass(frozen=True, slots=True)
class GpioCommandParameters:
    """All parameters.

    Attributes:
        commands: interfaces by GPIO, in its order.
        states: likewise.
    """

    gpios: tuple[str, ...] = parameter((), "Names of the GPIOs", read_only=True)
    commands: Mapping[str, tuple[str, ...]] = parameter_groups(
        _CommandInterfaces, by="gpios", prefix="command_interfaces", only="interfaces"
    )
    states: Mapping[str, tuple[str, ...]] = parameter_groups(
        _StateInterfaces, by="gpios", prefix="state_interfaces", only="interfaces"
    )


class GpioCommandController(Controller[GpioCommandParameters]):
    """Writes commands to the interfaces of GPIOs, and publishes states in every cycle.

    A command names the interfaces that it sets; the others keep their values, also when the
    controller is deactivated. `offer` takes commands from any thread, and none of them is lost.

    Attributes:
        shown: the published states: GPIOs and the names of their interfaces.
        sink: receives the states; None publishes nothing. Set it before activation.
    """

    parameters_type = GpioCommandParameters
    adapter = "arm_control.controllers.gpio_command.ros:GpioCommandAdapter"
    transient = ("shown", "_command_names", "_waiting")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.shown: Mapping[str, tuple[str, ...]] = {}
        self.sink: ReadingSink | None = None
        self._command_names: tuple[str, ...] = ()
        self._waiting: deque[dict[int, float]] = deque(maxlen=MAX_WAITING)

    def on_configure(self, parameters: GpioCommandParameters) -> None:
        """Take the GPIOs and their interfaces.

        Raises:
            ControllerError: there is no GPIO or no interface, or one of them is named twice.
        """
        super().on_configure(parameters)
        if not parameters.gpios:
            raise ControllerError("'gpios' parameter was empty")
        self.shown = parameters.states
        if not any(parameters.states.values()):
            self.shown = self._described_states(parameters.gpios)
        self._command_names = _full_names(parameters.commands)
        named = (parameters.gpios, self._command_names, _full_names(self.shown))
        for names in named:
            twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
            if twice:
                raise ControllerError(f"{', '.join(twice)}: named twice")
        if not self._command_names and not _full_names(self.shown):
            raise ControllerError("No command or state interfaces are configured")

    @run_input
    def offer(self, names: Sequence[str], values: Sequence[float]) -> str:
        """Set these interfaces, by full names such as 'lamp/on', in the next cycle; any thread.

        Returns:
            Why it was refused, as a whole; empty if it was accepted.
        """
        if len(names) != len(values):
            return f"it has {len(names)} interfaces and {len(values)} values"
        unknown = [name for name in names if name not in self._command_names]
        if unknown:
            known = ", ".join(self._command_names) or "none"
            return f"no command interface {', '.join(unknown)}; the controller has {known}"
        if not all(map(math.isfinite, values)):
            return "a value is not a finite number"
        places = map(self._command_names.index, names)
        self._waiting.append(dict(zip(places, map(float, values), strict=True)))
        return ""

    def take_command(self, values: Sequence[float]) -> None:
        """Take a value for each command interface, in the order of the parameters; see `offer`.

        Raises:
            ControllerError: the command is refused.
        """
        reason = self.offer(self._command_names, values)
        if reason:
            raise ControllerError(f"a command was dropped: {reason}")

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the command interfaces of the parameters."""
        return InterfaceConfiguration.individual(self._command_names)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read what is published."""
        return InterfaceConfiguration.individual(_full_names(self.shown))

    def on_activate(self) -> None:
        """Drop commands from before the activation."""
        self._waiting.clear()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Publish the states, then write the commands since the last cycle."""
        if self.sink is not None and self.sink.wanted():
            self.sink.publish(time_s, self.states.read())
        if self._waiting:
            values = self.commands.read().copy()
            while self._waiting:
                for place, value in self._waiting.popleft().items():
                    values[place] = value
            self.commands.write(values)
        return ReturnType.OK

    def _described_states(self, gpios: Sequence[str]) -> Mapping[str, tuple[str, ...]]:
        """Return the state interfaces that the description gives these GPIOs."""
        context = self.context
        described: dict[str, tuple[str, ...]] = {}
        if context.robot_description:
            robot = as_description(context.document or context.robot_description).root
            for gpio in robot.find("ros2_control/gpio"):
                states = gpio.find("state_interface")
                described[gpio.get("name")] = tuple(state.get("name") for state in states)
        return {gpio: described.get(gpio, ()) for gpio in gpios}


def _full_names(interfaces: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    return tuple(f"{gpio}/{name}" for gpio, names in interfaces.items() for name in names)
