"""The base classes of controllers, and the types that say which interfaces they need."""

import logging
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from arm_control.controllers.loaned_interfaces import LoanedInterfaces
from arm_control.errors import ControllerError
from arm_control.parameters import ParameterSpec, build_parameters, specs_of
from arm_control.run_inputs import InputGate, run_input
from arm_control.state.attributes import load_attributes, save_attributes
from arm_control.state.encoding import encode
from arm_description.urdf.description import Description, RobotDescription, text_of
from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_description.urdf.robot import Robot
from arm_node.frozen import frozen


class InterfaceKind(Enum):
    """How to interpret `InterfaceConfiguration.names`."""

    NONE = "none"
    ALL = "all"
    INDIVIDUAL = "individual"
    INDIVIDUAL_BEST_EFFORT = "individual_best_effort"
    REGEX = "regex"


@frozen
class InterfaceConfiguration:
    """The interfaces a controller wants, by full name ('j0/position') or by rule."""

    kind: InterfaceKind
    names: tuple[str, ...] = ()

    @classmethod
    def none(cls) -> "InterfaceConfiguration":
        """Request no interfaces."""
        return cls(InterfaceKind.NONE)

    @classmethod
    def all(cls) -> "InterfaceConfiguration":
        """Request all interfaces."""
        return cls(InterfaceKind.ALL)

    @classmethod
    def individual(cls, names: Iterable[str]) -> "InterfaceConfiguration":
        """Request exactly these, in this order; a missing one prevents activation."""
        return cls(InterfaceKind.INDIVIDUAL, tuple(names))

    @classmethod
    def individual_best_effort(cls, names: Iterable[str]) -> "InterfaceConfiguration":
        """Request those of these that exist, in this order."""
        return cls(InterfaceKind.INDIVIDUAL_BEST_EFFORT, tuple(names))

    @classmethod
    def regex(cls, patterns: Iterable[str]) -> "InterfaceConfiguration":
        """Request all whose full name matches one of the patterns."""
        return cls(InterfaceKind.REGEX, tuple(patterns))

    @property
    def is_by_name(self) -> bool:
        """Whether it names interfaces individually."""
        return self.kind in (InterfaceKind.INDIVIDUAL, InterfaceKind.INDIVIDUAL_BEST_EFFORT)

    def resolve(self, existing: Sequence[str]) -> tuple[str, ...]:
        """Return the requested full names; with INDIVIDUAL, some may not exist.

        Args:
            existing: all interfaces, in the order of the manager's array.
        """
        match self.kind:
            case InterfaceKind.NONE:
                return ()
            case InterfaceKind.ALL:
                return tuple(existing)
            case InterfaceKind.INDIVIDUAL:
                return self.names
            case InterfaceKind.INDIVIDUAL_BEST_EFFORT:
                known = frozenset(existing)
                return tuple(name for name in self.names if name in known)
            case InterfaceKind.REGEX:
                patterns = [re.compile(pattern) for pattern in self.names]
                return tuple(name for name in existing if any(p.fullmatch(name) for p in patterns))


class ReturnType(Enum):
    """Outcome of one update."""

    OK = "ok"
    ERROR = "error"
    """The manager deactivates the controller; log the reason before returning this."""


@frozen
class NoParameters:
    """The parameters of a controller that has none."""


@frozen
class ControllerContext:
    """What a controller knows about its environment when it is created.

    Attributes:
        name: the controller's name, such as 'position_controller'.
        update_rate_hz: how often `update` is called.
        robot_description: the URDF; empty if there is none.
        document: the parsed description; None if it has not been parsed yet.
    """

    name: str
    update_rate_hz: int
    robot_description: str = ""
    document: RobotDescription | None = None

    @classmethod
    def of(
        cls, name: str, update_rate_hz: int, robot_description: Description
    ) -> "ControllerContext":
        """Return the context of a controller whose manager has parsed the description already."""
        document = robot_description if isinstance(robot_description, RobotDescription) else None
        return cls(name, update_rate_hz, text_of(robot_description), document)

    def read_robot(self) -> Robot | None:
        """Return the robot of the description; None if there is no description.

        Raises:
            arm_description.errors.DescriptionError: the description cannot be used.
        """
        if not self.robot_description:
            return None
        return parse_urdf(self.document or self.robot_description, remark=ignore_remark)


ParametersT = TypeVar("ParametersT")

NOT_ACTIVE = "the controller is not active"
CHAINED = "another controller commands this one"
_NOTHING = LoanedInterfaces((), np.empty(0), ())
_SETTINGS = (
    "context",
    "name",
    "logger",
    "commands",
    "states",
    "sink",
    "configured_with",
    "input_gate",
    "halted_by",
    "_parameters",
)
"""Attributes of every controller that are not state."""


class Controller(ABC, Generic[ParametersT]):
    """Base class of all controllers; independent of ROS and hardware.

    The constructor and the class methods about parameters run on a control-plane thread, everything
    else on the loop thread. A life-cycle method refuses the transition by raising: a
    `ControllerError` carries a sentence for the user; any other exception counts as a bug and is
    logged with its traceback.

    Attributes:
        parameters_type: frozen dataclass of the controller's parameters, see
            `arm_control.parameters`.
        adapter: the ROS half as 'module:Class', imported only if there is a node; empty for a
            controller without topics.
        configured_with: the latest parameters that it was given; None before that.
        input_gate: notes the inputs while a run is recorded, see `arm_control.run_inputs`.
        sink: receives what the ROS half publishes, on the loop thread; None publishes nothing.
        halted_by: why the manager keeps the active controller from running, such as "emergency
            stop" or "hardware component 'arm' is inactive"; empty while it runs. `on_deactivate`
            has been called by then, and `on_activate` is called before the next update.
        transient: names of attributes that are not part of the state: what follows from the
            parameters, queues of requests, connections.
    """

    parameters_type: ClassVar[type[Any]] = NoParameters
    adapter: ClassVar[str] = ""
    configured_with: Any = None
    input_gate: InputGate | None = None
    sink: Any = None
    halted_by: str = ""
    transient: ClassVar[tuple[str, ...]] = ()

    def __init__(self, context: ControllerContext) -> None:
        """Set up what needs no parameters; raise `ControllerError` if it cannot be loaded."""
        self.context = context
        self.name = context.name
        self.logger = logging.getLogger(context.name)
        self.commands = _NOTHING
        self.states = _NOTHING
        self._parameters: ParametersT | None = None

    @property
    def parameters(self) -> ParametersT:
        """The current parameters, from `on_configure` or `update_parameters`.

        Raises:
            ControllerError: the controller is not configured.
        """
        if self._parameters is None:
            raise ControllerError(f"controller '{self.name}' is not configured")
        return self._parameters

    @property
    def idle_reason(self) -> str:
        """Why commands have no effect now; empty while it runs. Any thread."""
        if self.halted_by:
            return self.halted_by
        is_lent = self.commands is not _NOTHING or self.states is not _NOTHING
        return "" if is_lent else NOT_ACTIVE

    @classmethod
    def parameter_specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return the controller's parameters.

        Args:
            given: values from parameter files and arguments, by full name; the names of some
                parameters may depend on them, see `parameter_groups`.
        """
        return specs_of(cls.parameters_type, given=given)

    @classmethod
    def build_parameters(cls, values: Mapping[str, Any]) -> ParametersT:
        """Return the object that `on_configure` takes, from the values of all `parameter_specs`.

        Raises:
            ParameterError: a value cannot be used.
        """
        return build_parameters(cls.parameters_type, values)

    @abstractmethod
    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Return the command interfaces to claim; called after `on_configure`."""

    @abstractmethod
    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Return the state interfaces to read; called after `on_configure`."""

    def on_configure(self, parameters: ParametersT) -> None:
        """Apply the parameters; `self.parameters` returns them from now on."""
        self._parameters = parameters

    def update_parameters(self, parameters: ParametersT) -> None:
        """Apply parameters that a client has changed since `on_configure`, between two updates.

        Read-only ones are unchanged. By default `self.parameters` returns the new values from now
        on, and nothing else changes. Raise `ControllerError` or `ParameterError` to refuse the
        change.
        """
        self._parameters = parameters

    @run_input
    def change_parameters(self, parameters: ParametersT) -> None:
        """Call `update_parameters`; the manager's node calls this."""
        self.update_parameters(parameters)
        self.configured_with = parameters

    def take_command(self, values: Sequence[float]) -> None:
        """Take a command from a program without ROS for the next update; any thread.

        Override it in a controller that takes commands: they mean the same as those of its topic.

        Args:
            values: the numbers of the command, in the order that the controller documents.

        Raises:
            ControllerError: the command cannot be used.
        """
        raise ControllerError(f"controller '{self.name}' takes no commands")

    def on_activate(self) -> None:
        """Prepare for the first update; `commands` and `states` may be used from now on."""

    @abstractmethod
    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Compute one cycle: read `states`, write `commands`. Must not block.

        Args:
            time_s: the manager's time (simulation time in a simulation).
            period_s: time since this controller's last update; nominal for the first one.
        """

    def on_deactivate(self) -> None:
        """Write safe commands; the interfaces are released afterwards."""

    def on_cleanup(self) -> None:
        """Forget the parameters."""
        self._parameters = None

    def on_shutdown(self) -> None:
        """Release everything; no method is called afterwards."""

    def save_state(self) -> Any:
        """Return what the next updates depend on, apart from interfaces and parameters.

        It consists of plain values, see `arm_control.state.encoding`, and may share arrays with
        the controller. By default it is every attribute that is not `transient`. If one of them is
        not plain, no snapshot can be taken, and the user is told its name.
        """
        left_out = {name for base in type(self).__mro__ for name in vars(base).get("transient", ())}
        return save_attributes(self, left_out | {*_SETTINGS})

    def load_state(self, state: Any) -> None:
        """Continue from a state that this controller, or one with its parameters, has saved.

        The manager has already brought it to the life-cycle state of that moment.
        """
        load_attributes(self, state)

    def fingerprint(self) -> bytes:
        """Return bytes that differ if the state does; a recording reads them in every cycle.

        Override it where encoding the whole state would take too long.
        """
        return encode(self.save_state())

    def on_reset(self) -> None:
        """Start over, because the world was reset while the controller is active.

        The states have their initial values, and each command is the value that keeps its joint in
        place. By default this deactivates and activates the controller, which keeps its interfaces.
        """
        self.on_deactivate()
        self.on_activate()

    def assign_interfaces(self, commands: LoanedInterfaces, states: LoanedInterfaces) -> None:
        """Store the loaned interfaces; called by the manager before `on_activate`."""
        self.commands = commands
        self.states = states

    def release_interfaces(self) -> None:
        """Drop the loaned interfaces; called by the manager after `on_deactivate`."""
        self.commands = _NOTHING
        self.states = _NOTHING


class ChainableController(Controller[ParametersT]):
    """A controller that exports references and states to other controllers.

    Their full names start with the controller's name: 'pid/j0/position'. While another controller
    commands the references (chained mode), `update_references` is not called.

    Attributes:
        references: set-points, shape (number of `reference_names`,); NaN at activation. They keep
            their last values when chained mode ends.
        exported_states: states for others to read, shape (number of `exported_state_names`,).
        is_chained: whether another controller commands the references.
    """

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.references = np.empty(0)
        self.exported_states = np.empty(0)
        self.is_chained = False

    @property
    def idle_reason(self) -> str:
        """Why commands have no effect now, other than those of the controller that commands it."""
        return super().idle_reason or (CHAINED if self.is_chained else "")

    def reference_names(self) -> tuple[str, ...]:
        """Return the references without the controller's name; called after `on_configure`."""
        return ()

    def exported_state_names(self) -> tuple[str, ...]:
        """Return the exported states, like `reference_names`; called after `on_configure`."""
        return ()

    @abstractmethod
    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Write `references` from topics; see `Controller.update`."""

    @abstractmethod
    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Follow `references`: write `commands` and `exported_states`; see `Controller.update`."""

    def on_set_chained_mode(self, is_chained: bool) -> None:
        """React to a change of `is_chained`: the references have another source from now on."""

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Compute one cycle."""
        if not self.is_chained:
            outcome = self.update_references(time_s, period_s)
            if outcome is not ReturnType.OK:
                return outcome
        return self.update_commands(time_s, period_s)

    def export(self) -> None:
        """Create the exported arrays; called by the manager after `on_configure`."""
        self.references = np.full(len(self.reference_names()), np.nan)
        self.exported_states = np.full(len(self.exported_state_names()), np.nan)
