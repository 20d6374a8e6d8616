"""Snapshots of what a controller manager holds, as its list services show it."""

from dataclasses import dataclass

from arm_control.lifecycle import LifecycleState


@dataclass(frozen=True, slots=True)
class InterfaceStatus:
    """A command or state interface.

    Attributes:
        name: full name, 'j0/position'.
        is_available: whether its component is configured.
        is_claimed: whether a controller commands it; False for every state interface.
        data_type: 'double', or what the robot description says.
    """

    name: str
    is_available: bool
    is_claimed: bool
    data_type: str = "double"


@dataclass(frozen=True, slots=True)
class HardwareComponentStatus:
    """A hardware component and its interfaces.

    Attributes:
        name: of the component.
        type: 'system', 'actuator' or 'sensor'.
        plugin: the driver's type string.
        state: of its life cycle.
        read_write_rate_hz: how often it is really read and written.
        is_async: whether the description asks for a thread of its own.
        command_interfaces: in the driver's order.
        state_interfaces: in the driver's order.
    """

    name: str
    type: str
    plugin: str
    state: LifecycleState
    read_write_rate_hz: int
    is_async: bool
    command_interfaces: tuple[InterfaceStatus, ...]
    state_interfaces: tuple[InterfaceStatus, ...]


@dataclass(frozen=True, slots=True)
class ChainConnection:
    """References of one controller that another one commands.

    Attributes:
        name: of the controller that exports them.
        reference_interfaces: without its name.
    """

    name: str
    reference_interfaces: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ControllerStatus:
    """A loaded controller.

    Attributes:
        name: of the controller.
        type_name: its ros2_control type string.
        state: of its life cycle.
        update_rate_hz: how often it really runs.
        claimed_interfaces: command interfaces it holds; empty unless active.
        required_command_interfaces: what it asks for; empty unless inactive or active.
        required_state_interfaces: what it asks for; empty unless inactive or active.
        is_chainable: whether others may command it.
        is_chained: whether another one does.
        reference_interfaces: what it exports for that, without its name; empty unless inactive
            or active, like the two below.
        exported_state_interfaces: what it exports for others to read, without its name.
        chain_connections: the references of others that it commands.
    """

    name: str
    type_name: str
    state: LifecycleState
    update_rate_hz: int
    claimed_interfaces: tuple[str, ...]
    required_command_interfaces: tuple[str, ...]
    required_state_interfaces: tuple[str, ...]
    is_chainable: bool = False
    is_chained: bool = False
    reference_interfaces: tuple[str, ...] = ()
    exported_state_interfaces: tuple[str, ...] = ()
    chain_connections: tuple[ChainConnection, ...] = ()
